#!/usr/bin/env python3
"""Fits the coefficients of common/matching/localisation/reach_confidence.cpp to what bench_places wrote.

Usage: bench_places 25 1 answers1.csv; bench_places 25 2 answers2.csv; fit_places.py answers*.csv
       fit_places.py --as-built answers.csv...  tells how often answers are right where so much is said
                                                of them, with the coefficients that stand in the source

A logistic model of whether the best place in reach is right, by Newton's method, damped a little towards 0, in
logarithms of what places leave unexplained, u(s) = log(1 - s + kSlack), where s is a place's support:
kBias + kSupport * u + kKnown * known + kSupportKnown * u * known
      + kRival * max(0, u(max(rival, kUnseen * support)) - u) + kOverlap * overlap.
Wrong answers in hotels are left out: a room like the right one, in reach of the prediction, looks right to any
scan, and would only teach the model to doubt everything.
"""
import csv
import math
import pathlib
import sys

sys.dont_write_bytecode = True  # no folder of byte code beside the sources
from fit_confidence import DAMPING, constants, sigmoid, solve

SOURCE = pathlib.Path(__file__).parents[3] / "common/matching/localisation/reach_confidence.cpp"
NAMES = ["kBias", "kSupport", "kKnown", "kSupportKnown", "kRival", "kOverlap"]
K = constants(SOURCE)
UP_TO = [0.1, 0.3, 0.5, 0.7, 0.9, 0.97, 0.99, 0.999, 1.01]


def read(files):
    """[(features, right)] of all answers that count."""
    answers = []
    for name in files:
        with open(name) as file:
            answers += [(features(row), row["right"] == "1") for row in csv.DictReader(file) if counts(row)]
    return answers


def counts(row):
    return row["right"] == "1" or not row["family"].startswith("hotel")


def log_unexplained(support):
    return math.log(1.0 - min(max(support, 0.0), 1.0) + K["kSlack"])


def features(row):
    support, rival, known, overlap = (float(row[name]) for name in ("support", "rival", "known", "overlap"))
    here = log_unexplained(support)
    there = log_unexplained(max(rival, K["kUnseen"] * support))
    return [1.0, here, known, here * known, max(0.0, there - here), overlap]


def said(w, x):
    return sigmoid(sum(a * b for a, b in zip(w, x)))


def newton_step(w, answers):
    n = len(w)
    gradient = [-DAMPING * v for v in w]
    hessian = [[DAMPING * (i == j) for j in range(n)] for i in range(n)]
    for x, right in answers:
        p = said(w, x)
        for i in range(n):
            gradient[i] += (right - p) * x[i]
            for j in range(n):
                hessian[i][j] += p * (1 - p) * x[i] * x[j]
    return solve(hessian, gradient)


def loss(w, answers):
    likelihoods = (said(w, x) if right else 1.0 - said(w, x) for x, right in answers)
    return sum(-math.log(max(1e-300, p)) for p in likelihoods) + 0.5 * DAMPING * sum(v * v for v in w)


def fit(answers):
    """The coefficients of most likelihood. A step that makes it worse is halved."""
    w = [0.0] * len(NAMES)
    for _ in range(100):
        step = newton_step(w, answers)
        for _ in range(20):
            tried = [a + b for a, b in zip(w, step)]
            if loss(tried, answers) <= loss(w, answers):
                break
            step = [b / 2 for b in step]
        w = tried
        if max(abs(b) for b in step) < 1e-6:
            break
    return w


def print_reliability(w, answers):
    pairs = sorted((said(w, x), right) for x, right in answers)
    print("probability said | answers | said in the mean | right")
    low = 0.0
    for up_to in UP_TO:
        of_bin = [(p, right) for p, right in pairs if low <= p < up_to]
        if of_bin:
            mean_said, mean_right = (sum(values) / len(of_bin) for values in zip(*of_bin))
            print(f"{low:g} to {min(up_to, 1.0):g} | {len(of_bin)} | {mean_said:.3f} | {mean_right:.3f}")
        low = up_to
    print(f"loss for each answer {loss(w, answers) / len(answers):.4f}")


def main():
    as_built = sys.argv[1:2] == ["--as-built"]
    answers = read(sys.argv[2 if as_built else 1:])
    if not answers:
        sys.exit(__doc__)
    w = [K[name] for name in NAMES] if as_built else fit(answers)
    print(", ".join(f"{name} = {value:.2f}" for name, value in zip(NAMES, w)))
    print_reliability(w, answers)


if __name__ == "__main__":
    main()
