#!/usr/bin/env python3
"""Prints the numbers of what common/geometry/elementary_tables.h holds: polynomials of least relative error by
Remez' exchange, and the parts of pi/2 and ln 2. Needs python3-mpmath. Nothing runs it but a person
who wants to know where the numbers come from."""

import mpmath as mp

mp.mp.prec = 400


def best_polynomial(f, weight, high, terms):
    """Coefficients of the polynomial in z on [0, high] whose weighted error is least."""
    points = [high * (1 - mp.cos(mp.pi * k / terms)) / 2 for k in range(terms + 1)]
    for _ in range(12):
        rows = [[z**i for i in range(terms)] + [(-1) ** k / weight(z)] for k, z in enumerate(points)]
        *coefficients, level = mp.lu_solve(mp.matrix(rows), mp.matrix([f(z) for z in points]))
        error = lambda z: (mp.polyval(coefficients[::-1], z) - f(z)) * weight(z)
        points = extrema(error, high, terms + 1)
    return coefficients, abs(level)


def extrema(error, high, wanted):
    """Where an error is largest between its changes of sign."""
    n = 40 * wanted
    grid = [high * (1 - mp.cos(mp.pi * k / n)) / 2 for k in range(n + 1)]
    runs = []
    for z in grid:
        e = error(z)
        if runs and (e > 0) == (runs[-1][1] > 0):
            if abs(e) > abs(runs[-1][1]):
                runs[-1] = (z, e)
        else:
            runs.append((z, e))
    assert len(runs) >= wanted, len(runs)
    return [z for z, _ in runs[:wanted]]


def rounded(x, bits=53):
    x = mp.mpf(x)
    if x == 0:
        return x
    scale = mp.mpf(2) ** (bits - 1 - mp.floor(mp.log(abs(x), 2)))
    return mp.nint(x * scale) / scale


def hexadecimal(x):
    return float(rounded(x)).hex().replace("0x0.0p", "0x0p").replace("0x1.0000000000000p", "0x1p")


def wrapped(items, per_row):
    return ",\n".join("    " + ", ".join(items[i : i + per_row]) for i in range(0, len(items), per_row))


def table(name, values):
    print(f"inline constexpr double {name}[] = {{\n{wrapped([hexadecimal(v) for v in values], 3)}}};")


def polynomial(name, f, weight, high, terms):
    coefficients, level = best_polynomial(f, weight, mp.mpf(high), terms)
    print(f"// Off by at most 2^{float(mp.log(level, 2)):.1f} (relative).")
    table(name, coefficients)


def parts(name, value, bits):
    """A sum of numbers of so many bits, highest first."""
    values = []
    for b in bits:
        values.append(rounded(value - mp.fsum(values), b))
    table(name, values)


def series(f, terms):
    """An even function's value, by its series where the closed form loses digits."""
    return lambda z: mp.fsum(f(i) * z**i for i in range(terms))


def main():
    quarter = (mp.pi / 4) ** 2 * 1.0001
    sine = series(lambda i: (-1) ** (i + 1) / mp.factorial(2 * i + 3), 30)
    cosine = series(lambda i: (-1) ** i / mp.factorial(2 * i + 4), 30)
    print("// sin(r) = r + r^3 P(r^2), cos(r) = 1 - r^2/2 + r^4 P(r^2), |r| <= pi/4.")
    polynomial("kSine", sine, lambda z: mp.mpf(1e-9) + z, quarter, 6)
    polynomial("kCosine", cosine, lambda z: mp.mpf(1e-9) + z * z, quarter, 6)
    print("// pi/2, the first three exact times a whole number below 2^20.")
    parts("kHalfPi", mp.pi / 2, [33, 33, 33, 53])
    print("// pi/2 in two parts; twice it is pi in two parts.")
    parts("kHalfPiTwo", mp.pi / 2, [53, 53])

    print("// atan(u) = u + u^3 P(u^2), |u| <= 1/64.")
    near = (mp.mpf(1) / 64) ** 2 * mp.mpf("1.0001")
    arc_tangent = series(lambda i: mp.mpf((-1) ** (i + 1)) / (2 * i + 3), 60)
    polynomial("kArcTangent", arc_tangent, lambda z: mp.mpf(1e-9) + z, near, 3)
    print("// atan(k/32) in two parts.")
    table("kArcTangentsHigh", [rounded(mp.atan(mp.mpf(k) / 32)) for k in range(33)])
    table("kArcTangentsLow", [mp.atan(mp.mpf(k) / 32) - rounded(mp.atan(mp.mpf(k) / 32)) for k in range(33)])

    print("// exp(r) = 1 + r + r^2 P(r), |r| <= ln2/64; the Taylor series is as good.")
    table("kExponential", [1 / mp.factorial(i + 2) for i in range(5)])
    print("// 2^(k/32) in two parts.")
    table("kPowersHigh", [rounded(mp.mpf(2) ** (mp.mpf(k) / 32)) for k in range(32)])
    table("kPowersLow", [mp.mpf(2) ** (mp.mpf(k) / 32) - rounded(mp.mpf(2) ** (mp.mpf(k) / 32)) for k in range(32)])
    print("// ln 2 and ln 2 / 32, the first part exact times a whole number below 2^20.")
    parts("kLn2", mp.ln(2), [33, 53])
    parts("kLn2By32", mp.ln(2) / 32, [33, 53])

    print("// log(1 + f) = f - s (f - s^2 P(s^2)), s = f / (2 + f), |s| <= 3 - 2 sqrt 2.")
    high = (3 - 2 * mp.sqrt(2)) ** 2 * mp.mpf("1.0001")
    polynomial("kLogarithm", series(lambda i: mp.mpf(2) / (2 * i + 3), 60), lambda z: mp.mpf(1e-6) + z / 2, high, 7)

    mp.mp.prec = 1500
    bits = int(mp.floor(2 / mp.pi * mp.mpf(2) ** (64 * 20)))
    print("// 2/pi in binary, 64 digits each, after 64 digits before the point.")
    values = ["0x0"] + [f"0x{(bits >> (64 * (19 - k))) & (2**64 - 1):016x}" for k in range(20)]
    print(f"inline constexpr std::uint64_t kTwoByPi[] = {{\n{wrapped(values, 3)}}};")


if __name__ == "__main__":
    main()
