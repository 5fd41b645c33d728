#!/usr/bin/env python3
"""Second route to the ideal rigid RSUP: Lagrange's equation of its one freedom, everything in closed form of the crank angle.

M(psi) psi'' + M'(psi) psi'^2 / 2 + V'(psi) = torque. It shares no equation with rsup.c. Extrapolation in 30-digit arithmetic
(mpmath). Reads rsup_ideal.csv beside it and prints the largest differences; under a minute.
"""
import csv
from pathlib import Path

from mpmath import atan2, cos, mp, mpf, pi, sin, sqrt

mp.dps = 30
R, L, RHO, G = mpf("0.2"), mpf("0.4"), 7850, mpf("9.81")


def cylinder(d, length):
    m = RHO * pi * mpf(d) ** 2 / 4 * length
    return m, m * mpf(d) ** 2 / 8, m * (length**2 / 12 + mpf(d) ** 2 / 16)


M1, _, IT1 = cylinder("0.028", R)
M2, IA2, IT2 = cylinder("0.010", L)
I1 = IT1 + M1 * R**2 / 4
IY = mpf("2e-5")
TR = mpf("1.1") + M2 / 4 + IT2 / L**2


def acceleration(t, p, w):
    c, s = cos(p), sin(p)
    # slider: x^2 = L^2 - |S_yz - E_yz|^2; azimuth of the coupler about the slide: rate al
    x = sqrt(mpf("0.11") - c / 25)
    x1 = s / 50 / x
    x2 = (c / 50 - x1**2) / x
    rho = mpf("0.05") + c / 25
    top = mpf("0.04") + c / 50
    al = top / rho
    al1 = s / rho * (al / 25 - mpf(1) / 50)
    mass = I1 + IY * al**2 + TR * x1**2 + (M2 / 4 + IT2 / L**2) * R**2 + IA2 * (x * al / L) ** 2
    dmass = 2 * x1 * x2 * TR + 2 * al * al1 * (IY + IA2 * x**2 / L**2) + 2 * IA2 * x * x1 * al**2 / L**2
    torque = 10 * min(t / 2, mpf(1)) - 10 * w / 9
    return (torque - dmass * w**2 / 2 - (M1 + M2) * G * R / 2 * c) / mass


def step(t, y, h, columns=9):
    table = []
    f0 = (y[1], acceleration(t, *y))
    for j in range(1, columns + 1):
        n = 2 * j
        s = h / n
        u, v = y, tuple(a + s * f for a, f in zip(y, f0))
        for m in range(1, n):
            f = (v[1], acceleration(t + m * s, *v))
            u, v = v, tuple(a + 2 * s * b for a, b in zip(u, f))
        row = [v]
        for k, prev in enumerate(table, 1):
            q = (mpf(j) / (j - k)) ** 2 - 1
            row.append(tuple(a + (a - b) / q for a, b in zip(row[-1], prev)))
        table = row
    return table[-1]


def main():
    rows = list(csv.DictReader(open(Path(__file__).resolve().parent / "rsup_ideal.csv")))
    worst = {}
    y, t = (pi / 2, mpf(0)), mpf(0)
    turns = 0
    for r in rows:
        end = mpf(r["t"])
        n = int((end - t) * 200 + mpf("0.5"))
        h = (end - t) / n if n else 0
        for _ in range(n):
            y = step(t, y, h)
            t += h
        p, w = y
        x = sqrt(mpf("0.11") - cos(p) / 25)
        x1 = sin(p) / 50 / x
        al = (mpf("0.04") + cos(p) / 50) / (mpf("0.05") + cos(p) / 25)
        # x_22 is normal to the coupler's direction in the plane across the slide
        psi22 = atan2(R * sin(p), R * cos(p) + mpf("0.1")) - pi / 2
        a = acceleration(t, p, w)
        x2 = (cos(p) / 50 - x1**2) / x
        here = {
            "q.psi11": p, "v.psi11": w, "q.z21": x, "v.z21": x1 * w, "v.psi22": al * w,
            "a.psi11": a, "a.z21": x2 * w**2 + x1 * a, "R.fx": -mpf("1.1") * (x2 * w**2 + x1 * a),
        }
        turns = (mpf(r["q.psi22"]) - psi22) / (2 * pi)
        worst["q.psi22"] = max(worst.get("q.psi22", 0), abs(turns - round(turns)) * 2 * pi)
        for k, v in here.items():
            worst[k] = max(worst.get(k, 0), abs(v - mpf(r[k])))
    for k, v in worst.items():
        print(f"{k}: {mp.nstr(v, 3)}")


if __name__ == "__main__":
    main()
