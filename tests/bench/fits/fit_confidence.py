#!/usr/bin/env python3
"""Fits the coefficients of common/matching/localisation/confidence.cpp to what bench_confidence wrote.

Usage: bench_confidence 40 0 1 5 scans.csv; fit_confidence.py scans.csv...
       fit_confidence.py --as-built scans.csv   prints the probability of each mode, a scan in a line,
                                                with the coefficients that stand in confidence.cpp

Two logistic models by maximum likelihood, each damped a little towards 0, in logarithms of what places
leave unexplained, u = log(1 - support + kNearSlack) or kEvenSlack:
- which of the listed places is right, where one is, by rays close together: in proportion to
  exp(-kPlacePower * u);
- whether a listed place is right at all, rather than none, by rays spread evenly:
  kFoundBias - kFoundSupport * u + kFoundRival * (u of the best other place - u), where the best other place
  may be one that is not listed: it has at most the share "unseen" of the support.
Scans are split by seed to show how the fit carries over to buildings that it has not seen.
"""
import csv
import math
import pathlib
import re
import sys
from collections import defaultdict

SOURCE = pathlib.Path(__file__).parents[3] / "common/matching/localisation/confidence.cpp"


def constants(source=SOURCE):
    """Name -> value of the constants in a source, their only home."""
    return {name: float(value) for name, value in re.findall(r"\b(k\w+) = (-?[\d.]+)", source.read_text())}


NEAR_SLACK = constants()["kNearSlack"]
EVEN_SLACK = constants()["kEvenSlack"]
DAMPING = 1e-3


def read(files):
    """(kind, seed, query) -> [(support, right, even support, unseen)], best first."""
    scans = defaultdict(list)
    for name in files:
        with open(name) as file:
            for row in csv.DictReader(file):
                key = row["kind"], int(row["seed"]), int(row["query"])
                scans[key].append((float(row["support"]), row["right"] == "1", float(row["even_support"]),
                                   float(row["unseen"])))
    return {key: sorted(modes, reverse=True) for key, modes in scans.items()}


def sigmoid(x):
    return 1.0 / (1.0 + math.exp(-max(-700.0, min(700.0, x))))


def log_unexplained(support, slack):
    return math.log(1.0 - support + slack)


def features(modes):
    _, _, support, unseen = modes[0]
    rival = max([unseen * support] + [other for _, _, other, _ in modes[1:]])
    here = log_unexplained(support, EVEN_SLACK)
    return [1.0, -here, max(0.0, log_unexplained(rival, EVEN_SLACK) - here)]


def shares(modes, power):
    least = log_unexplained(modes[0][0], NEAR_SLACK)
    weights = [math.exp(-power * (log_unexplained(support, NEAR_SLACK) - least)) for support, *_ in modes]
    return [w / sum(weights) for w in weights]


def solve(matrix, vector):
    n = len(vector)
    rows = [list(matrix[i]) + [vector[i]] for i in range(n)]
    for i in range(n):
        pivot = max(range(i, n), key=lambda r: abs(rows[r][i]))
        rows[i], rows[pivot] = rows[pivot], rows[i]
        for r in range(n):
            if r != i:
                f = rows[r][i] / rows[i][i]
                rows[r] = [a - f * b for a, b in zip(rows[r], rows[i])]
    return [rows[i][n] / rows[i][i] for i in range(n)]


def fit_found(scans):
    """Newton's method for: is one of the listed places right?"""
    w = [0.0, 0.0, 0.0]
    for _ in range(100):
        gradient = [-DAMPING * v for v in w]
        hessian = [[DAMPING * (i == j) for j in range(3)] for i in range(3)]
        for modes in scans.values():
            x = features(modes)
            right = any(r for _, r, *_ in modes)
            p = sigmoid(sum(a * b for a, b in zip(w, x)))
            for i in range(3):
                gradient[i] += (right - p) * x[i]
                for j in range(3):
                    hessian[i][j] += p * (1 - p) * x[i] * x[j]
        step = solve(hessian, gradient)
        w = [a + max(-20.0, min(20.0, b)) for a, b in zip(w, step)]
        if max(abs(b) for b in step) < 1e-6:
            break
    return w


def fit_power(scans):
    """The power of most likelihood, by golden section."""
    listed = [modes for modes in scans.values() if any(r for _, r, *_ in modes)]

    def loss(power):
        return sum(-math.log(max(1e-300, p)) for modes in listed
                   for p, (_, r, *_) in zip(shares(modes, power), modes) if r)

    low, high = 1.0, 100.0
    for _ in range(60):
        a, b = low + 0.382 * (high - low), low + 0.618 * (high - low)
        if loss(a) < loss(b):
            high = b
        else:
            low = a
    return (low + high) / 2.0


def report(scans, power, w, limit=0.996):
    kinds = defaultdict(lambda: [0, 0, 0, 0.0])
    for (kind, _, _), modes in scans.items():
        found = sigmoid(sum(a * b for a, b in zip(w, features(modes))))
        p = found * shares(modes, power)[0]
        entry = kinds[kind]
        entry[0] += 1
        if modes[0][1]:
            entry[1] += p >= limit
        else:
            entry[2] += p >= limit
            entry[3] = max(entry[3], p)
    for kind, (n, right, wrong, worst) in sorted(kinds.items()):
        print(f"  {kind:16s} {n:4d} scans: sure and right {right:4d}, sure and wrong {wrong}, "
              f"most said of a wrong one {worst:.4f}")


def print_as_built(scans):
    k = constants()
    w = k["kFoundBias"], k["kFoundSupport"], k["kFoundRival"]
    for _, modes in sorted(scans.items()):
        found = sigmoid(sum(a * b for a, b in zip(w, features(modes))))
        print(*(found * share for share in shares(modes, k["kPlacePower"])))


def main():
    if sys.argv[1:2] == ["--as-built"]:
        print_as_built(read(sys.argv[2:]))
        return
    scans = read(sys.argv[1:])

    def run(name, train, test):
        power, w = fit_power(train), fit_found(train)
        print(f"{name}: kPlacePower {power:.1f}, kFoundBias {w[0]:.1f}, kFoundSupport {w[1]:.1f}, "
              f"kFoundRival {w[2]:.1f}")
        report(test, power, w)

    even = {k: v for k, v in scans.items() if k[1] % 2 == 0}
    odd = {k: v for k, v in scans.items() if k[1] % 2 == 1}
    if even and odd:
        run("fitted on even seeds, tried on odd ones", even, odd)
        run("fitted on odd seeds, tried on even ones", odd, even)
    run("fitted on all", scans, scans)


if __name__ == "__main__":
    main()
