#!/usr/bin/env python3
"""RSRRR with all friction coefficients scaled by one factor: does the run reach 5 s, or when does
det(I - d(mu N)/d t_f) pass zero, so that the friction loop loses its solution?

Up to a time t0 the run is that of rsrrr.py. From there the time is rescaled, dt/ds = det: with g = 0 the
friction loop, J its Jacobian and dg/dt its rate at fixed torques along the motion,
    d(psi, w)/ds = det (w, a),   dt/ds = det,   d t_f/ds = -adj(J) dg/dt,
which is regular at det = 0. Found: the motion is attracted to points where det = 0 and adj(J) dg/dt = 0
at once (det ~ exp(-lambda s); folded nodes: the creeping motion on the slow branch meets the fold). The time of
passage is t + det/lambda for s to infinity. In unscaled time the rates grow like 1/det there, so an
explicit integrator grinds to a halt just before.

Writes rsrrr_jamming.csv and prints the convergence of the times. About two minutes.
"""
from pathlib import Path

import numba as nb
import numpy as np
from scipy.integrate import solve_ivp

import rsrrr as r


@nb.njit(cache=True)
def loop(t, psi, w, tf, mode, scale):
    """Residual of the friction loop, its Jacobian, crank acceleration, speeds, axial forces."""
    q = r.closure(psi)
    v = r.speeds(q, w)
    X, R, ek, ep = r.newton_euler(t, q, v)
    W = np.zeros((5, 4, 5))
    for c in range(5):
        W[c] = r.wrench(X, R, c)
    chi = np.zeros(4)
    for k in range(4):
        chi[k] = r.characteristic(v[k], mode[k])
    J = np.eye(4)
    axial = np.zeros(4)
    g = r.residual(tf, chi, W, mode, scale, J, axial)
    a = X[0, 0]
    for k in range(4):
        a += X[0, 1 + k] * tf[k]
    return g, J, a, v, axial


@nb.njit(cache=True)
def adjugate(J):
    adj = np.zeros((4, 4))
    for i in range(4):
        for j in range(4):
            m = np.zeros((3, 3))
            for p in range(3):
                for s in range(3):
                    m[p, s] = J[p if p < i else p + 1, s if s < j else s + 1]
            adj[j, i] = (-1.0) ** (i + j) * np.linalg.det(m)
    return adj


@nb.njit(cache=True)
def flow(z, mode, scale, eps):
    """z = (psi, w, t, t_f): its derivative by s; det."""
    psi, w, t, tf = z[0], z[1], z[2], z[3:7].copy()
    g, J, a, v, ax = loop(t, psi, w, tf, mode, scale)
    d = np.zeros(4)
    for i in range(3):  # sixth-order central difference along the motion
        e = eps * (i + 1)
        c = (0.75, -0.15, 1.0 / 60.0)[i]
        gp = loop(t + e, psi + e * w + 0.5 * a * e * e, w + e * a, tf, mode, scale)[0]
        gm = loop(t - e, psi - e * w + 0.5 * a * e * e, w - e * a, tf, mode, scale)[0]
        d += c * (gp - gm) / eps
    det = np.linalg.det(J)
    o = np.zeros(7)
    o[0], o[1], o[2] = det * w, det * a, det
    o[3:] = -(adjugate(J) @ d)
    return o, det


def jam(scale, t0, eps, rtol):
    none = np.zeros(1000), np.zeros(1000, np.int64)
    R = r.run_a(scale, np.array([0.0, t0]), 1e-14, 1e-3, 9.0, *none)
    assert R[9] == 0
    y, tf = R[3], R[4].copy()
    g, det0 = r.signs1(t0, y, scale, tf, np.zeros(8))
    mode = np.where(g >= 0, 1.0, -1.0)

    def level(d):
        def fun(s, z):
            return flow(z, mode, scale, eps)[1] - d

        return fun

    last = level(1e-9)
    last.terminal = True
    s = solve_ivp(
        lambda s, z: flow(z, mode, scale, eps)[0], (0, 1000), np.array([y[0], y[1], t0, *tf]),
        method="LSODA", rtol=rtol, atol=rtol * 1e-2, events=[last, level(1e-7)],
    )
    z = s.y[:, -1]
    assert s.status == 1 and len(s.t_events[1])
    lam = np.log(100.0) / (s.t[-1] - s.t_events[1][-1])
    g, J, a, v, ax = loop(z[2], z[0], z[1], z[3:7].copy(), mode, scale)
    # no branch of |.| was left on the way
    assert np.all(v * mode[:4] > 0) and np.all(ax[1:] * mode[5:] > 0)
    return z[2] + flow(z, mode, scale, eps)[1] / lam, z, lam


def main():
    rows = []
    for scale in (1.5, 1.85):
        R, ev_t, ev_k = r.solve_a(scale, 1e-13)
        assert R[9] == 0
        print(f"scale {scale}: reaches 5 s, psi11(5) = {R[1][-1, 0]:.13g}, speed {R[1][-1, 1]:.12g}")
        rows.append([scale, 5.0, *R[1][-1, :2], np.nan])
    for scale, starts in ((1.9, (0.4, 0.5)), (2.0, (0.4, 0.45)), (3.0, (0.15, 0.2)), (5.0, (0.06, 0.1)), (10.0, (0.05, 0.08))):
        found = []
        for t0 in starts:
            for eps, rtol in ((3e-5, 1e-10), (3e-5, 1e-11), (1e-5, 1e-11)):
                found.append(jam(scale, t0, eps if scale < 4 else eps / 3, rtol))
        ts = np.array([f[0] for f in found])
        t, z, lam = found[-2]
        print(f"scale {scale}: det = 0 at t = {t:.10f} (spread {np.ptp(ts):.1e}), psi11 {z[0]:.10f}, speed {z[1]:.8e}, lambda {lam:.4f}", flush=True)
        rows.append([scale, t, z[0], z[1], np.ptp(ts)])
    with open(Path(__file__).resolve().parent / "rsrrr_jamming.csv", "w", newline="\n") as f:
        f.write("scale,t,q.psi11,v.psi11,spread.t\n")
        for a in rows:
            f.write(",".join(["" if np.isnan(x) else f"{x:.10g}" for x in a]) + "\n")


if __name__ == "__main__":
    main()
