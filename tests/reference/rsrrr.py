#!/usr/bin/env python3
"""Independent reference solution of the RSRRR mechanism (with and without joint friction).

Formulation (deliberately unlike the program under test):
  * Newton's and Euler's equations of each of the four links in the GLOBAL frame, with every joint
    reaction as an unknown: 27 equations (4 links x 6, 3 for the loop) in 27 unknowns
    (4 joint accelerations, 4 x (3 forces + 2 moments), 3 components of f_S). No recursion, no trace form.
  * Accelerations of points from derivatives of the columns of the Jacobians.
  * Reactions are affine in the four friction torques: five right-hand sides of one factorisation;
    then Newton's method (analytic Jacobian) on the four torques alone, to rounding.
  * Main integration (A): the mechanism has one degree of freedom and the other three angles follow from
    the crank angle in closed form, so the state is (psi11, its speed, work): no drift exists.
    Gragg-Bulirsch-Stoer extrapolation (order 12) with step control. With friction: every reversal of a
    joint speed and every change of sign of an axial force is located and the integration restarted there,
    with the branch of |.| frozen between events, so that every piece is smooth.
  * Check (B): all four angles and speeds as state (9 with the work), accelerations from the same 27
    equations, explicit Runge-Kutta DOP853 (scipy), scipy's own event location, projection on the loop
    at each output time and event.
  * Check (C): implicit Radau IIA (scipy), reduced state, the friction law with plain |.|, no events.
  * Check (D), ideal run only: Lagrange's equation of the one-degree-of-freedom system,
    M(psi) psi'' + M'(psi) psi'^2/2 + V'(psi) = torque, with M and V from 60-digit differences of the
    closed-form positions and orientations, as Fourier series, integrated with 40-digit arithmetic.
    It shares no equation with A, B, C except the geometry.

Usage:  rsrrr.py            writes rsrrr_ideal.csv, rsrrr_friction.csv, rsrrr_friction_events.csv and prints the comparisons
Needs numpy, scipy, numba, mpmath. Deterministic; a few minutes.
"""
import sys
import time
from pathlib import Path

import numba as nb
import numpy as np

PI = np.pi
T_END, DT_OUT, T_KINK = 5.0, 0.05, 2.0

# ------------------------------------------------------------------------------------------ data
RHO, DIA, G = 7850.0, 0.028, 9.81
# joints and links in the order (1,1), (2,1), (2,2), (2,3)
LEN = np.array([0.2, 0.2, 0.1, 0.3])
AXIS = np.array([0, 2, 0, 0])  # link's own axis along x, z, x, x of its frame
MASS = RHO * PI * DIA**2 / 4 * LEN
I_AX = MASS * DIA**2 / 8
I_TR = MASS * (LEN**2 / 12 + DIA**2 / 16)
BASE2 = np.array([0.0, -0.30, 0.25])
T_DR, T_RAMP, PSID0 = 10.0, 2.0, 9.0
# journals: spacing, diameters, coefficients
SPACING = 0.03
D_A = np.array([0.01, 0.028, 0.01, 0.01])
D_B = D_A.copy()
D_C = np.array([0.015, 0.028, 0.015, 0.015])
MU_A = np.array([0.2, 0.2, 0.2, 0.2])
MU_B = MU_A.copy()
MU_C = np.array([0.0, 0.2, 0.2, 0.2])
# annulus: (dC^3 - dA^3)/(dC^2 - dA^2), finite form
ANN = (D_C**2 + D_C * D_A + D_A**2) / (D_C + D_A)
PSID_K, K_EXP = 0.01, 3.0

JOINTS = ["J11", "J21", "J22", "J23"]
COORDS = ["psi11", "psi21", "psi22", "psi23"]


# ------------------------------------------------------------------------------- numba: mechanics
@nb.njit(cache=True)
def cross(a, b):
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


@nb.njit(cache=True)
def skew(a):
    return np.array([[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]])


@nb.njit(cache=True)
def frames(q):
    """R[i]: orientation of link i (columns = axes in the global frame), O[i]: its origin; S seen from
    chain 1 and chain 2."""
    R = np.zeros((4, 3, 3))
    O = np.zeros((4, 3))
    c, s = np.cos(q[0]), np.sin(q[0])
    R[0] = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    c, s = np.cos(q[1]), np.sin(q[1])
    R[1] = np.array([[s, c, 0.0], [0.0, 0.0, 1.0], [c, -s, 0.0]])
    O[1] = BASE2
    c, s = np.cos(q[2]), np.sin(q[2])
    R[2] = R[1] @ np.array([[c, -s, 0.0], [0.0, 0.0, 1.0], [-s, -c, 0.0]])
    O[2] = O[1] + R[1] @ np.array([0.0, 0.0, LEN[1]])
    c, s = np.cos(q[3]), np.sin(q[3])
    R[3] = R[2] @ np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    O[3] = O[2] + R[2] @ np.array([LEN[2], 0.0, 0.0])
    S1 = O[0] + R[0] @ np.array([LEN[0], 0.0, 0.0])
    S2 = O[3] + R[3] @ np.array([LEN[3], 0.0, 0.0])
    return R, O, S1, S2


@nb.njit(cache=True)
def closure(psi):
    """The dependent angles in closed form (psi23 > 0, psi21 near pi). O22 is fixed in space, the links
    (2,2), (2,3) move in the vertical plane through x21: an elbow whose end is S."""
    dx = LEN[0] * np.cos(psi)
    dy = LEN[0] * np.sin(psi) - (BASE2[1] + LEN[1])
    dz = -BASE2[2]
    rho = np.sqrt(dx * dx + dz * dz)
    c3 = (rho * rho + dy * dy - LEN[2] ** 2 - LEN[3] ** 2) / (2.0 * LEN[2] * LEN[3])
    p3 = np.arccos(c3)
    p2 = np.arctan2(-dy, rho) - np.arctan2(LEN[3] * np.sin(p3), LEN[2] + LEN[3] * c3)
    q = np.array([psi, PI + np.arctan(dx / dz), p2, p3])
    # one Newton step removes the rounding of arccos
    R, O, S1, S2 = frames(q)
    J = np.zeros((3, 3))
    for k in range(3):
        J[:, k] = cross(R[k + 1][:, 2].copy(), S2 - O[k + 1])
    q[1:] += np.linalg.solve(J, S1 - S2)
    return q


@nb.njit(cache=True)
def speeds(q, w):
    """All joint speeds from the crank's."""
    R, O, S1, S2 = frames(q)
    J = np.zeros((3, 3))
    for k in range(3):
        J[:, k] = cross(R[k + 1][:, 2].copy(), S2 - O[k + 1])
    v = np.zeros(4)
    v[0] = w
    v[1:] = np.linalg.solve(J, w * cross(R[0][:, 2].copy(), S1 - O[0]))
    return v


@nb.njit(cache=True)
def drive(t, w):
    return T_DR * min(t / T_RAMP, 1.0) - T_DR * w / PSID0


@nb.njit(cache=True)
def newton_euler(t, q, v):
    """X (27 x 5): unknowns for zero friction torques (column 0) and their derivatives by the four
    friction torques (columns 1..4). Rows: 0..3 accelerations; joint j: 4+5j.. forces (global), then
    moments about x and y of link j; 24..26 f_S on link (1,1). Also R and kinetic, potential energy."""
    R, O, S1, S2 = frames(q)
    Cm = np.zeros((4, 3))
    for i in range(4):
        Cm[i] = O[i] + R[i][:, AXIS[i]] * (0.5 * LEN[i])
    # first joint of the chain of each link: link i moves with joints j0..i
    z = np.zeros((4, 3))
    om = np.zeros((4, 3))
    dz = np.zeros((4, 3))
    dO = np.zeros((4, 3))
    for j in range(4):
        z[j] = R[j][:, 2]
    for i in range(4):
        j0 = 0 if i == 0 else 1
        for j in range(j0, i + 1):
            om[i] += z[j] * v[j]
            dO[i] += cross(z[j], O[i] - O[j]) * v[j]
    for j in range(4):
        dz[j] = cross(om[j], z[j])
    A = np.zeros((27, 27))
    B = np.zeros((27, 5))
    ekin = 0.0
    epot = 0.0
    for i in range(4):
        j0 = 0 if i == 0 else 1
        # inertia in the global frame
        e = R[i][:, AXIS[i]].copy()
        In = np.zeros((3, 3))
        for a in range(3):
            In[a, a] = I_TR[i]
            for b in range(3):
                In[a, b] += (I_AX[i] - I_TR[i]) * e[a] * e[b]
        vC = np.zeros(3)
        for j in range(j0, i + 1):
            vC += cross(z[j], Cm[i] - O[j]) * v[j]
        bC = np.zeros(3)  # acceleration of C for zero joint accelerations
        bw = np.zeros(3)
        f, n = 6 * i, 6 * i + 3
        for j in range(j0, i + 1):
            jc = cross(z[j], Cm[i] - O[j])
            bC += (cross(dz[j], Cm[i] - O[j]) + cross(z[j], vC - dO[j])) * v[j]
            bw += dz[j] * v[j]
            Iz = In @ z[j]
            for a in range(3):
                A[f + a, j] = -MASS[i] * jc[a]
                A[n + a, j] = -Iz[a]
        h = In @ om[i]
        gyro = In @ bw + cross(om[i], h)
        for a in range(3):
            B[f + a, 0] = MASS[i] * bC[a]
            B[n + a, 0] = gyro[a]
        B[f + 1, 0] += MASS[i] * G  # weight -m g e_y moved to the right-hand side
        ekin += 0.5 * MASS[i] * (vC @ vC) + 0.5 * (om[i] @ h)
        epot += MASS[i] * G * Cm[i][1]
        # joint i acts on link i with +, joint i+1 (same chain) with -
        for s in range(2):
            j = i + s
            if s == 1 and (i == 0 or i == 3):
                break
            sg = 1.0 if s == 0 else -1.0
            K = skew(O[j] - Cm[i])
            for a in range(3):
                A[f + a, 4 + 5 * j + a] = sg
                for b in range(3):
                    A[n + a, 4 + 5 * j + b] = sg * K[a, b]
                A[n + a, 4 + 5 * j + 3] = sg * R[j][a, 0]
                A[n + a, 4 + 5 * j + 4] = sg * R[j][a, 1]
                # known moment about z_j: drive - friction torque j
                if j == 0:
                    B[n + a, 0] -= sg * z[j][a] * drive(t, v[0])
                B[n + a, 1 + j] += sg * z[j][a]
        if i == 0 or i == 3:
            sg = 1.0 if i == 0 else -1.0
            K = skew((S1 if i == 0 else S2) - Cm[i])
            for a in range(3):
                A[f + a, 24 + a] = sg
                for b in range(3):
                    A[n + a, 24 + b] = sg * K[a, b]
    # loop: acceleration of S on link (1,1) = acceleration of S on link (2,3)
    for c in range(2):
        S = S1 if c == 0 else S2
        sg = 1.0 if c == 0 else -1.0
        ja, jb = (0, 1) if c == 0 else (1, 4)
        vS = np.zeros(3)
        for j in range(ja, jb):
            vS += cross(z[j], S - O[j]) * v[j]
        for j in range(ja, jb):
            js = cross(z[j], S - O[j])
            bs = (cross(dz[j], S - O[j]) + cross(z[j], vS - dO[j])) * v[j]
            for a in range(3):
                A[24 + a, j] += sg * js[a]
                B[24 + a, 0] -= sg * bs[a]
    return np.linalg.solve(A, B), R, ekin, epot


@nb.njit(cache=True)
def wrench(X, R, col):
    """Reactions (4 x 5: fx fy fz nx ny in the successor's frame) of column col."""
    w = np.zeros((4, 5))
    for j in range(4):
        for a in range(3):
            for b in range(3):
                w[j, a] += R[j][b, a] * X[4 + 5 * j + b, col]
        w[j, 3] = X[4 + 5 * j + 3, col]
        w[j, 4] = X[4 + 5 * j + 4, col]
    return w


@nb.njit(cache=True)
def characteristic(v, mode):
    """Signed (1 - exp(-k|v|/v_k)); mode = +1/-1: branch frozen (continued beyond v = 0), 0: plain."""
    s = mode
    if s == 0.0:
        s = 1.0 if v >= 0.0 else -1.0
    x = -K_EXP * s * v / PSID_K
    if x > 2.0:  # only ever reached in trial steps beyond an event, which are rejected
        return s * (1.0 - np.exp(2.0) * (x - 1.0))
    return -s * np.expm1(x)


@nb.njit(cache=True)
def residual(tf, chi, W, mode, scale, J, axial):
    """r = tf - chi * capacity(reactions(tf)); J = d r/d tf = I - d(mu N)/d tf; axial forces."""
    r = np.zeros(4)
    for k in range(4):
        w = np.zeros(5)
        for a in range(5):
            w[a] = W[0, k, a]
            for l in range(4):
                w[a] += W[1 + l, k, a] * tf[l]
        ax, ay = 0.5 * w[0] - w[4] / SPACING, 0.5 * w[1] + w[3] / SPACING
        bx, by = 0.5 * w[0] + w[4] / SPACING, 0.5 * w[1] - w[3] / SPACING
        fa, fb = np.hypot(ax, ay), np.hypot(bx, by)
        sz = mode[4 + k]
        if sz == 0.0:
            sz = 1.0 if w[2] >= 0.0 else -1.0
        axial[k] = w[2]
        ca, cb, cc = 0.5 * MU_A[k] * D_A[k], 0.5 * MU_B[k] * D_B[k], MU_C[k] * ANN[k] / 3.0
        r[k] = tf[k] - scale * chi[k] * (ca * fa + cb * fb + cc * sz * w[2])
        for l in range(4):
            d = W[1 + l, k]
            dax, day = 0.5 * d[0] - d[4] / SPACING, 0.5 * d[1] + d[3] / SPACING
            dbx, dby = 0.5 * d[0] + d[4] / SPACING, 0.5 * d[1] - d[3] / SPACING
            g = cc * sz * d[2]
            if fa > 0.0:
                g += ca * (ax * dax + ay * day) / fa
            if fb > 0.0:
                g += cb * (bx * dbx + by * dby) / fb
            J[k, l] = (1.0 if k == l else 0.0) - scale * chi[k] * g
    return r


@nb.njit(cache=True)
def evaluate(t, q, v, mode, scale, tf):
    """Full evaluation. tf: in: first guess, out: friction torques. Returns
    (ok, x (27), wrench (4 x 5), axial (4), J, ekin, epot, R, iterations)."""
    X, R, ekin, epot = newton_euler(t, q, v)
    J = np.eye(4)
    axial = np.zeros(4)
    W = np.zeros((5, 4, 5))
    for c in range(5):
        W[c] = wrench(X, R, c)
    ok = True
    its = 0
    if scale == 0.0:
        tf[:] = 0.0
    else:
        chi = np.zeros(4)
        for k in range(4):
            chi[k] = characteristic(v[k], mode[k])
        r = residual(tf, chi, W, mode, scale, J, axial)
        best = np.max(np.abs(r))
        ok = False
        for it in range(40):
            big = np.max(np.abs(tf))
            if best <= 1e-13 * max(big, 1e-30) and it > 0 or best == 0.0:
                ok = True
            if ok and its == 0:
                its = max(it, 1)
            try_tf = tf - np.linalg.solve(J, r)
            if not np.all(np.isfinite(try_tf)):
                break
            Jn = np.zeros((4, 4))
            rn = residual(try_tf, chi, W, mode, scale, Jn, axial)
            new = np.max(np.abs(rn))
            if ok and new >= best:  # converged and at the rounding floor: keep the better one
                break
            tf[:] = try_tf
            r, J, best = rn, Jn, new
        residual(tf, chi, W, mode, scale, J, axial)
        if its == 0:
            its = 40
    x = X[:, 0].copy()
    w = W[0].copy()
    for l in range(4):
        x += X[:, 1 + l] * tf[l]
        w += W[1 + l] * tf[l]
    for k in range(4):
        axial[k] = w[k, 2]
    return ok, x, w, axial, J, ekin, epot, R, its


@nb.njit(cache=True)
def power(t, v, tf):
    p = drive(t, v[0]) * v[0]
    for k in range(4):
        p -= tf[k] * v[k]
    return p


@nb.njit(cache=True)
def rhs1(t, y, mode, scale, tf):
    """Reduced state y = (psi11, speed, work)."""
    q = closure(y[0])
    v = speeds(q, y[1])
    ok, x, w, ax, J, ek, ep, R, its = evaluate(t, q, v, mode, scale, tf)
    return ok, np.array([y[1], x[0], power(t, v, tf)])


@nb.njit(cache=True)
def signs1(t, y, scale, tf, mode):
    """Event functions at a state: joint speeds and axial forces; det J."""
    q = closure(y[0])
    v = speeds(q, y[1])
    ok, x, w, ax, J, ek, ep, R, its = evaluate(t, q, v, mode, scale, tf)
    g = np.zeros(8)
    g[:4] = v
    g[4:] = ax
    return g, np.linalg.det(J)


# --------------------------------------------------------- method A: extrapolation with events
KCOL = 6


@nb.njit(cache=True)
def gbs_step(t, y, h, mode, scale, tf0, f0):
    """One Gragg-Bulirsch-Stoer step, sequence 2,4,..,2 KCOL: (ok, increment, error)."""
    n = y.size
    T = np.zeros((KCOL, KCOL, n))
    tf = tf0.copy()
    for j in range(KCOL):
        m = 2 * (j + 1)
        hs = h / m
        tf[:] = tf0
        a = np.zeros(n)  # increments from y, to keep rounding small
        b = hs * f0
        for i in range(1, m):
            ok, f = rhs1(t + i * hs, y + b, mode, scale, tf)
            if not ok or not np.all(np.isfinite(f)):
                return False, b, np.inf
            a, b = b, a + 2.0 * hs * f
        ok, f = rhs1(t + h, y + b, mode, scale, tf)
        if not ok or not np.all(np.isfinite(f)):
            return False, b, np.inf
        T[j, 0] = 0.5 * (a + b + hs * f)
        for k in range(1, j + 1):
            r = (float(j + 1) / float(j + 1 - k)) ** 2
            T[j, k] = T[j, k - 1] + (T[j, k - 1] - T[j - 1, k - 1]) / (r - 1.0)
    e = np.abs(T[KCOL - 1, KCOL - 1] - T[KCOL - 1, KCOL - 2])
    err = max(e[0], e[1] / 10.0, e[2] / 10.0)
    return True, T[KCOL - 1, KCOL - 1], err


@nb.njit(cache=True)
def add(y, d, lost):
    """y + d with the rounding carried along (compensated summation): (sum, new lost)."""
    x = d + lost
    y1 = y + x
    return y1, x - (y1 - y)


@nb.njit(cache=True)
def run_a(scale, t_out, tol, hmax, t_stop, ev_t, ev_k):
    """Integrates from rest. Returns (rows reached, states, t, y, tf, mode, det, number of events,
    steps, code). code 0: end reached; 1: det passed zero or the loop has no solution beyond (t, y);
    2: det changed sign by a jump at an event."""
    nout = t_out.size
    Y = np.zeros((nout, 3))
    y = np.array([0.5 * PI, 0.0, 0.0])
    t = 0.0
    tf = np.zeros(4)
    plain = np.zeros(8)
    mode = np.zeros(8)
    h = 1e-5
    nev = 0
    nstep = 0
    Y[0] = y
    o = 1
    first = True
    lost = np.zeros(3)
    det = 1.0
    det_old = 1.0
    while o < nout:
        if scale != 0.0:
            # branch of |.| for the next piece
            g, det = signs1(t, y, scale, tf, plain)
            for k in range(8):
                mode[k] = 1.0 if g[k] >= 0.0 else -1.0
            if first:
                mode[:] = 0.0
            if det <= 0.0 and not first:
                return o, Y, t, y, tf, mode, det_old, nev, nstep, 2
            det_old = det
        ok, f0 = rhs1(t, y, mode, scale, tf)
        tn = min(t_out[o], t_stop if t < t_stop else 1e9)
        if first:
            h = 1e-6
        last = t + h * 1.0001 >= tn
        hh = tn - t if last else h
        hh = (t + hh) - t  # a step that the clock can represent
        ok, inc, err = gbs_step(t, y, hh, mode, scale, tf, f0)
        y1, lost1 = add(y, inc, lost)
        fac = 0.2
        if ok and np.isfinite(err):
            fac = 0.9 * (tol / max(err, 1e-300)) ** (1.0 / (2 * KCOL - 1))
            fac = min(max(fac, 0.2), 3.0)
        if not ok or err > tol:
            h = hh * (0.25 if not ok else fac)
            if h < 1e-9:
                return o, Y, t, y, tf, mode, det, nev, nstep, 1
            continue
        nstep += 1
        tfn = tf.copy()
        if scale != 0.0 and not first:
            g, det = signs1(t + hh, y1, scale, tfn, mode)
            bad = False
            for k in range(8):
                bad = bad or (g[k] * mode[k] < 0.0 and k != 4)
            if det <= 0.0:
                h = 0.25 * hh
                if h < 1e-9:
                    return o, Y, t, y, tf, mode, det_old, nev, nstep, 1
                continue
            if bad:
                # bisect / secant on the step length; end just beyond the first event
                lo, hi = 0.0, hh
                ghi = g
                glo, dd = signs1(t, y, scale, tf.copy(), mode)
                yhi, tfhi, losthi = y1, tfn, lost1
                it = 0
                while hi - lo > 4e-12 and it < 200:
                    it += 1
                    # estimate of the earliest event by linear interpolation, bisection every third time
                    m = hi
                    for k in range(8):
                        if k != 4 and ghi[k] * mode[k] < 0.0:
                            den = glo[k] - ghi[k]
                            if den != 0.0:
                                m = min(m, lo + (hi - lo) * glo[k] / den)
                    if it % 3 == 0:
                        m = 0.5 * (lo + hi)
                    elif it % 3 == 1:
                        m = m + 1e-12
                    else:
                        m = m - 1e-12
                    m = min(max(m, lo + 1e-12), hi - 1e-12)
                    m = (t + m) - t
                    okm, incm, em = gbs_step(t, y, m, mode, scale, tf, f0)
                    ym, lostm = add(y, incm, lost)
                    tfm = tf.copy()
                    gm, dd = signs1(t + m, ym, scale, tfm, mode)
                    b = False
                    for k in range(8):
                        b = b or (gm[k] * mode[k] < 0.0 and k != 4)
                    if b:
                        hi, ghi, yhi, tfhi, losthi = m, gm, ym, tfm, lostm
                    else:
                        lo, glo = m, gm
                for k in range(8):
                    if k != 4 and ghi[k] * mode[k] < 0.0:
                        if nev < ev_t.size:
                            ev_t[nev] = t + hi
                            ev_k[nev] = k
                        nev += 1
                t, y, tf, lost = t + hi, yhi, tfhi, losthi
                h = min(h, hmax)
                if t >= t_out[o]:
                    Y[o] = y
                    o += 1
                continue
        first = False
        t = tn if last else t + hh
        y = y1
        lost = lost1
        tf = tfn
        if not last or fac < 1.0:
            h = hh * fac
        h = min(h, hmax)
        if t == t_out[o]:
            Y[o] = y
            o += 1
    return o, Y, t, y, tf, mode, det, nev, nstep, 0


# ------------------------------------------------------- methods B, C: scipy's DOP853 and Radau
def project(y):
    """Closest state on the loop (position, then velocity), minimum norm."""
    q, v = y[:4].copy(), y[4:8].copy()
    for it in range(20):
        R, O, S1, S2 = frames(q)
        D = np.zeros((3, 4))
        D[:, 0] = np.cross(R[0][:, 2], S1 - O[0])
        for j in range(1, 4):
            D[:, j] = -np.cross(R[j][:, 2], S2 - O[j])
        dq = np.linalg.lstsq(D, S1 - S2, rcond=None)[0]
        q -= dq
        if np.max(np.abs(dq)) < 1e-15:
            break
    v -= np.linalg.lstsq(D, D @ v, rcond=None)[0]
    return np.concatenate([q, v, y[8:]])


@nb.njit(cache=True)
def rhs8(t, y, mode, scale, tf):
    ok, x, w, ax, J, ek, ep, R, its = evaluate(t, y[:4].copy(), y[4:8].copy(), mode, scale, tf)
    f = np.zeros(9)
    f[:4] = y[4:8]
    f[4:8] = x[:4]
    f[8] = power(t, y[4:8], tf)
    return f, ax


def run_b(scale, t_out, rtol, hmax=2e-3):
    from scipy.integrate import solve_ivp

    tf = np.zeros(4)
    mode = np.zeros(8)
    plain = np.zeros(8)
    y = np.concatenate([closure(0.5 * PI), np.zeros(5)])
    Y = [y.copy()]
    atol = np.array([1e-14] * 4 + [1e-13] * 5) * (rtol / 1e-13)
    nfev = 0
    nev = 0
    t = 0.0

    def small(t, y, h):
        """midpoint step of length h with the plain law"""
        k1 = rhs8(t, y, plain, scale, tf)[0]
        return y + h * rhs8(t + 0.5 * h, y + 0.5 * h * k1, plain, scale, tf)[0]

    if scale:
        y = small(t, y, 1e-7)
        t = 1e-7
    for te in t_out[1:]:
        while t < te:
            events = None
            if scale:
                ax = rhs8(t, y, plain, scale, tf)[1]
                mode[:4] = np.where(y[4:8] >= 0, 1.0, -1.0)
                mode[4:] = np.where(ax >= 0, 1.0, -1.0)

                def ev(k):
                    def fun(t, y):
                        return y[4 + k] if k < 4 else rhs8(t, y, mode, scale, tf)[1][k - 4]

                    fun.terminal = True
                    return fun

                events = [ev(k) for k in (0, 1, 2, 3, 5, 6, 7)]
            s = solve_ivp(
                lambda t, y: rhs8(t, y, mode, scale, tf)[0], (t, te), y, method="DOP853", rtol=rtol, atol=atol,
                max_step=hmax if scale else np.inf, events=events,
            )
            assert s.status >= 0, s.message
            nfev += s.nfev
            t, y = s.t[-1], project(s.y[:, -1])
            if s.status == 1:
                nev += 1
                h = min(1e-9, te - t)
                y, t = project(small(t, y, h)), t + h
        t = te
        Y.append(y.copy())
    return np.array(Y), nfev, nev


def run_c(scale, t_out, rtol):
    from scipy.integrate import solve_ivp

    tf = np.zeros(4)
    plain = np.zeros(8)
    y = np.array([0.5 * PI, 0.0, 0.0])
    Y = [y]
    nfev = 0
    for a, b in ((0.0, T_KINK), (T_KINK, T_END)):
        te = t_out[(t_out > a + 1e-9) & (t_out < b + 1e-9)]
        te[-1] = b
        # restart at each output time: no dense output in the result
        for e in te:
            s = solve_ivp(lambda t, y: rhs1(t, y, plain, scale, tf)[1], (a, e), y, method="Radau", rtol=rtol, atol=rtol * 0.1)
            assert s.success
            nfev += s.nfev
            y, a = s.y[:, -1], e
            Y.append(y)
    return np.array(Y), nfev


# ------------------------------------------- method D: Lagrange's equation in 40-digit arithmetic
def run_d(t_out, digits=40, harmonics=160, hmax="0.0125"):
    from mpmath import mp, mpf

    def coefficients():
        mp.dps = 60
        half, quarter = mpf(1) / 2, mpf(1) / 4
        ln = [mpf(2) / 10, mpf(2) / 10, mpf(1) / 10, mpf(3) / 10]
        dia = mpf(28) / 1000
        area = 7850 * mp.pi * dia**2 / 4
        zb = mpf(25) / 100

        def pose(psi):
            dx, dy, dz = ln[0] * mp.cos(psi), ln[0] * mp.sin(psi) + mpf(1) / 10, -zb
            rho = mp.sqrt(dx * dx + dz * dz)
            c3 = (rho**2 + dy**2 - ln[2] ** 2 - ln[3] ** 2) / (2 * ln[2] * ln[3])
            s3 = mp.sqrt(1 - c3 * c3)
            up = mp.atan2(dy, rho) + mp.atan2(ln[3] * s3, ln[2] + ln[3] * c3)  # elevation of link (2,2)
            up3 = up - mp.acos(c3)  # and of link (2,3)
            ux, uz = dx / rho, dz / rho  # horizontal direction of the plane of the elbow
            e1 = (mp.cos(psi), mp.sin(psi), mpf(0))
            e3 = (ux * mp.cos(up), mp.sin(up), uz * mp.cos(up))
            e4 = (ux * mp.cos(up3), mp.sin(up3), uz * mp.cos(up3))
            elbow = (ln[2] * e3[0], -mpf(1) / 10 + ln[2] * e3[1], zb + ln[2] * e3[2])
            # centres of links 1, 3, 4 (link 2 only turns about its own axis)
            c1 = tuple(half * ln[0] * a for a in e1)
            c3v = (half * ln[2] * e3[0], -mpf(1) / 10 + half * ln[2] * e3[1], zb + half * ln[2] * e3[2])
            c4 = tuple(p + half * ln[3] * a for p, a in zip(elbow, e4))
            return c1, c3v, c4, e1, e3, e4, (ux, uz), up, up3

        d = mpf(10) ** -15

        def mv(psi):
            # central differences of fourth order: error 1e-60 + rounding 1e-45
            P = [pose(psi + k * d) for k in (-2, -1, 1, 2)]
            p0 = pose(psi)

            def der(i):
                return tuple((8 * (P[2][i][a] - P[1][i][a]) - (P[3][i][a] - P[0][i][a])) / (12 * d) for a in range(len(p0[i])))

            M = mpf(0)
            V = mpf(0)
            du = der(6)
            yaw = du[0] * p0[6][1] - du[1] * p0[6][0]  # rate of the plane about +y
            for i, L in ((0, ln[0]), (1, ln[2]), (2, ln[3])):
                m = area * L
                dc, de = der(i), der(3 + i)
                ax, tr = m * dia**2 / 8, m * (L**2 / 12 + dia**2 / 16)
                M += m * sum(a * a for a in dc) + tr * sum(a * a for a in de)
                # spin about the link's own axis: link 1 none; links in the turning plane: yaw * sin(elevation)
                if i > 0:
                    M += ax * (yaw * p0[3 + i][1]) ** 2
                V += m * mpf(981) / 100 * p0[i][1]
            m2 = area * ln[1]
            M += m2 * dia**2 / 8 * yaw**2
            V += m2 * mpf(981) / 100 * (-mpf(3) / 10 + half * ln[1])
            return M, V

        n = 2 * harmonics
        vals = [mv(2 * mp.pi * k / n) for k in range(n)]
        root = [mp.expjpi(mpf(2) * k / n) for k in range(n)]
        cm, cv = [], []
        for a in range(harmonics):
            cm.append(2 * sum(vals[k][0] * mp.conj(root[(a * k) % n]) for k in range(n)) / n)
            cv.append(2 * sum(vals[k][1] * mp.conj(root[(a * k) % n]) for k in range(n)) / n)
        cm[0] /= 2
        cv[0] /= 2
        return cm, cv

    cm, cv = coefficients()
    tail = max(abs(cm[-1]), abs(cv[-1]))
    mp.dps = digits
    cm = [(c.real, c.imag) for c in cm]
    cv = [(c.real, c.imag) for c in cv]
    keep = max(a for a in range(harmonics) if abs(cm[a][0]) + abs(cm[a][1]) + abs(cv[a][0]) + abs(cv[a][1]) > mpf(10) ** (-26)) + 1

    def series(psi):
        """M, M', V, V'"""
        c, s = mp.cos(psi), mp.sin(psi)
        x, y = mpf(1), mpf(0)
        M = dM = V = dV = mpf(0)
        for a in range(keep):
            M += cm[a][0] * x - cm[a][1] * y
            V += cv[a][0] * x - cv[a][1] * y
            dM -= a * (cm[a][0] * y + cm[a][1] * x)
            dV -= a * (cv[a][0] * y + cv[a][1] * x)
            x, y = x * c - y * s, x * s + y * c
        return M, dM, V, dV

    def rhs(t, y):
        M, dM, V, dV = series(y[0])
        tau = 10 * (t / 2 if t < 2 else mpf(1)) - 10 * y[1] / 9
        return (y[1], (tau - dV - dM * y[1] ** 2 / 2) / M, tau * y[1])

    def step(t, y, h, cols=9):
        f0 = rhs(t, y)
        T = []
        for j in range(cols):
            m = 2 * (j + 1)
            hs = h / m
            a, b = y, tuple(p + hs * f for p, f in zip(y, f0))
            for i in range(1, m):
                f = rhs(t + i * hs, b)
                a, b = b, tuple(p + 2 * hs * g for p, g in zip(a, f))
            f = rhs(t + h, b)
            row = [tuple((p + q + hs * g) / 2 for p, q, g in zip(a, b, f))]
            for k in range(1, j + 1):
                r = (mpf(j + 1) / (j + 1 - k)) ** 2
                row.append(tuple(p + (p - q) / (r - 1) for p, q in zip(row[k - 1], T[k - 1])))
            T = row
        return T[-1], max(abs(p - q) for p, q in zip(T[-1], T[-2]))

    y = (mp.pi / 2, mpf(0), mpf(0))
    Y = [y]
    worst = mpf(0)
    n = int(round(DT_OUT / float(hmax)))
    h = mpf(1) / 20 / n
    M, dM, V, dV = series(y[0])
    e0 = V
    for o in range(len(t_out) - 1):
        for i in range(n):
            y, e = step(mpf(o) / 20 + i * h, y, h)
            worst = max(worst, e)
        Y.append(y)
    M, dM, V, dV = series(y[0])
    drift = abs(M * y[1] ** 2 / 2 + V - y[2] - e0)
    return np.array([[float(a) for a in r] for r in Y]), float(tail), float(worst), float(drift), keep


# -------------------------------------------------------------------------------------- output
def table(scale, t_out, Y):
    names = ["t"] + ["q." + c for c in COORDS] + ["v." + c for c in COORDS] + ["a." + c for c in COORDS]
    names += ["lambda.S." + c for c in ("fx", "fy", "fz")]
    names += [f"reaction.{j}.{c}" for j in JOINTS for c in ("fx", "fy", "fz", "nx", "ny", "nz")]
    if scale:
        names += ["friction." + c for c in COORDS]
    names += ["energy.kinetic", "energy.potential", "energy.work"]
    rows = []
    tf = np.zeros(4)
    for t, y in zip(t_out, Y):
        q = closure(y[0])
        v = speeds(q, y[1])
        ok, x, w, ax, J, ek, ep, R, its = evaluate(t, q, v, np.zeros(8), scale, tf)
        assert ok
        row = [t, *q, *v, *x[:4], *x[24:27]]
        for j in range(4):
            nz = (drive(t, v[0]) if j == 0 else 0.0) - tf[j]
            row += [*w[j], nz]
        if scale:
            row += list(tf)
        row += [ek, ep, y[2]]
        rows.append(row)
    return names, np.array(rows) + 0.0  # no negative zeros


def write(path, names, rows):
    with open(path, "w", newline="\n") as f:
        f.write(",".join(names) + "\n")
        for r in rows:
            f.write(",".join(f"{x:.17g}" if i else f"{x:.2f}".rstrip("0").rstrip(".") for i, x in enumerate(r)) + "\n")


def check_rows(names, rows, scale, picks):
    """Each picked row against Newton's and Euler's laws with the momenta differentiated numerically in
    50-digit arithmetic along psi(t + d) = psi + w d + a d^2/2, the poses from products of the 4 x 4
    matrices of the scene; and the friction torques against formulas (4)-(7) from the row's own reactions.
    Returns the largest residuals: force, moment, angle rates, accelerations, loop, friction torque."""
    from mpmath import matrix, mp, mpf

    mp.dps = 50
    ln = [mpf(2) / 10, mpf(2) / 10, mpf(1) / 10, mpf(3) / 10]
    col = {n: i for i, n in enumerate(names)}
    worst = [mpf(0)] * 6

    def poses(psi):
        """T of the four links; dependent angles by Newton from the double values"""
        q = [psi] + [mpf(x) for x in closure(float(psi))[1:]]

        def chains(q):
            c, s = [mp.cos(a) for a in q], [mp.sin(a) for a in q]
            T1 = matrix([[c[0], -s[0], 0, 0], [s[0], c[0], 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
            T20 = matrix([[1, 0, 0, 0], [0, 1, 0, -mpf(3) / 10], [0, 0, 1, mpf(1) / 4], [0, 0, 0, 1]])
            T2 = T20 * matrix([[s[1], c[1], 0, 0], [0, 0, 1, 0], [c[1], -s[1], 0, 0], [0, 0, 0, 1]])
            T3 = T2 * matrix([[c[2], -s[2], 0, 0], [0, 0, 1, 0], [-s[2], -c[2], 0, ln[1]], [0, 0, 0, 1]])
            T4 = T3 * matrix([[c[3], -s[3], 0, ln[2]], [s[3], c[3], 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
            return [T1, T2, T3, T4]

        def gap(T):
            a, b = T[0] * matrix([ln[0], 0, 0, 1]), T[3] * matrix([ln[3], 0, 0, 1])
            return matrix([b[i] - a[i] for i in range(3)])

        for it in range(3):
            T = chains(q)
            g = gap(T)
            e = mpf(10) ** -24
            Jm = matrix(3, 3)
            for k in range(3):
                qq = list(q)
                qq[1 + k] += e
                d = gap(chains(qq)) - g
                for i in range(3):
                    Jm[i, k] = d[i] / e
            dq = mp.lu_solve(Jm, g)
            q = [q[0]] + [q[1 + k] - dq[k] for k in range(3)]
        return chains(q), q

    def vec(T, x):
        r = T * matrix(list(x) + [1])
        return matrix([r[i] for i in range(3)])

    def cr(a, b):
        return matrix([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])

    h = mpf(10) ** -6
    w4 = [(-2, mpf(1) / 12), (-1, -mpf(2) / 3), (1, mpf(2) / 3), (2, -mpf(1) / 12)]  # first derivative

    for i in picks:
        r = rows[i]
        ps, w, a = mpf(r[col["q.psi11"]]), mpf(r[col["v.psi11"]]), mpf(r[col["a.psi11"]])
        P = {k: poses(ps + w * k * h + a * (k * h) ** 2 / 2) for k in range(-4, 5)}
        for j in range(4):
            dq = sum(c * P[k][1][j] for k, c in w4) / h
            ddq = (-P[2][1][j] + 16 * P[1][1][j] - 30 * P[0][1][j] + 16 * P[-1][1][j] - P[-2][1][j]) / (12 * h * h)
            worst[2] = max(worst[2], abs(dq - mpf(r[col["v." + COORDS[j]]])))
            worst[3] = max(worst[3], abs(ddq - mpf(r[col["a." + COORDS[j]]])))
            worst[4] = max(worst[4], abs(P[0][1][j] - mpf(r[col["q." + COORDS[j]]])))
        fS = matrix([mpf(r[col["lambda.S." + c]]) for c in ("fx", "fy", "fz")])
        F, N, O = [], [], []
        for j in range(4):
            Rj = P[0][0][j][:3, :3]
            F.append(Rj * matrix([mpf(r[col[f"reaction.{JOINTS[j]}.{c}"]]) for c in ("fx", "fy", "fz")]))
            N.append(Rj * matrix([mpf(r[col[f"reaction.{JOINTS[j]}.{c}"]]) for c in ("nx", "ny", "nz")]))
            O.append(vec(P[0][0][j], (0, 0, 0)))
        for j in range(4):
            L = ln[j]
            m = 7850 * mp.pi * (mpf(28) / 1000) ** 2 / 4 * L
            iax, itr = m * (mpf(28) / 1000) ** 2 / 8, m * (L**2 / 12 + (mpf(28) / 1000) ** 2 / 16)
            cl = (0, 0, L / 2) if j == 1 else (L / 2, 0, 0)
            Ib = mp.diag([itr, itr, iax]) if j == 1 else mp.diag([iax, itr, itr])

            def mom(k):
                """linear and angular momentum about C at time k h"""
                dT = sum((c * P[k + kk][0][j] for kk, c in w4), matrix(4, 4)) / h
                R = P[k][0][j][:3, :3]
                Om = dT[:3, :3] * R.T
                om = matrix([Om[2, 1] - Om[1, 2], Om[0, 2] - Om[2, 0], Om[1, 0] - Om[0, 1]]) / 2
                v = dT * matrix(list(cl) + [1])
                return m * matrix([v[0], v[1], v[2]]), R * Ib * R.T * om

            M4 = {k: mom(k) for k in (-2, -1, 1, 2)}
            dp = sum((c * M4[k][0] for k, c in w4), matrix(3, 1)) / h
            dH = sum((c * M4[k][1] for k, c in w4), matrix(3, 1)) / h
            C = vec(P[0][0][j], cl)
            f = F[j] + matrix([0, -m * mpf(981) / 100, 0]) - dp
            n = N[j] + cr(O[j] - C, F[j]) - dH
            if j in (1, 2):
                f -= F[j + 1]
                n -= N[j + 1] + cr(O[j + 1] - C, F[j + 1])
            else:
                sg = 1 if j == 0 else -1
                f += sg * fS
                n += sg * cr(vec(P[0][0][j], (L, 0, 0)) - C, fS)
            worst[0] = max(worst[0], max(abs(x) for x in f))
            worst[1] = max(worst[1], max(abs(x) for x in n))
        if scale:
            for j in range(4):
                fx, fy, fz, nx, ny = (r[col[f"reaction.{JOINTS[j]}.{c}"]] for c in ("fx", "fy", "fz", "nx", "ny"))
                fa = np.hypot(fx / 2 - ny / SPACING, fy / 2 + nx / SPACING)
                fb = np.hypot(fx / 2 + ny / SPACING, fy / 2 - nx / SPACING)
                cap = MU_A[j] * fa * D_A[j] / 2 + MU_B[j] * fb * D_B[j] / 2 + MU_C[j] / 3 * abs(fz) * ANN[j]
                vj = r[col["v." + COORDS[j]]]
                tj = np.sign(vj) * (1 - np.exp(-K_EXP * abs(vj) / PSID_K)) * cap * scale
                worst[5] = max(worst[5], abs(tj - r[col["friction." + COORDS[j]]]))
    return [float(x) for x in worst]


def write_events(path, ev_t, ev_k):
    """Times where a joint speed or the axial force in a joint changes sign."""
    with open(path, "w", newline="\n") as f:
        f.write("t,kind,name\n")
        for t, k in zip(ev_t, ev_k):
            kind, name = ("reversal", COORDS[k]) if k < 4 else ("axial", JOINTS[k - 4])
            f.write(f"{t:.11f},{kind},{name}\n")


def out_times():
    return np.array([k / 20 for k in range(101)])


def solve_a(scale, tol=2e-15, hmax=2e-3):
    ev_t, ev_k = np.zeros(1000), np.zeros(1000, np.int64)
    r = run_a(scale, out_times(), tol, hmax if scale else 0.025, T_KINK, ev_t, ev_k)
    n = min(r[7], 1000)
    return r, ev_t[:n], ev_k[:n]


def diff(name, A, B, b1=(0, 4, 8)):
    d = np.abs(A - B[:, list(b1)])
    print(f"  {name}: psi11 {d[:, 0].max():.2e} (at 5 s {d[-1, 0]:.2e}), speed {d[:, 1].max():.2e}, work {d[:, 2].max():.2e}")


def main():
    t = out_times()
    here = Path(__file__).resolve().parent
    for label, scale in (("ideal", 0.0), ("friction", 1.0)):
        t0 = time.time()
        r, ev_t, ev_k = solve_a(scale)
        assert r[9] == 0
        Y = r[1]
        names, rows = table(scale, t, Y)
        print(f"{label}: A {r[8]} steps, {len(set(np.round(ev_t, 9)))} event times, psi11(5) = {Y[-1, 0]:.15g}, speed {Y[-1, 1]:.15g}  [{time.time() - t0:.0f} s]")
        write(here / f"rsrrr_{label}.csv", names, rows)
        if scale:
            write_events(here / "rsrrr_friction_events.csv", ev_t, ev_k)
        e = rows[:, -3] + rows[:, -2] - rows[:, -1]
        print(f"  A energy balance {np.abs(e - e[0]).max():.2e}")
        c = check_rows(names, rows, scale, range(0, 101, 10))
        print("  rows against differentiated momenta: force {:.1e}, moment {:.1e}, speeds {:.1e}, accelerations {:.1e}, angles {:.1e}, friction torque {:.1e}".format(*c))
        diff("A - A with 30 times the tolerance, half the largest step", Y, solve_a(scale, 6e-14, 1e-3)[0][1], (0, 1, 2))
        t0 = time.time()
        Yb, nfev, nev = run_b(scale, t, 1e-13)
        diff(f"A - B (DOP853, 9 states, {nfev} evaluations, {nev} events)", Y, Yb)
        q = np.array([closure(a) for a in Y[:, 0]])
        v = np.array([speeds(closure(a), w) for a, w in Y[:, :2]])
        print(f"    all q {np.abs(q - Yb[:, :4]).max():.2e}, all v {np.abs(v - Yb[:, 4:8]).max():.2e}  [{time.time() - t0:.0f} s]")
        t0 = time.time()
        for rtol in (1e-9, 1e-11):
            Yc, nfev = run_c(scale, t, rtol)
            diff(f"A - C (Radau, rtol {rtol:g}, {nfev} evaluations)", Y, Yc, (0, 1, 2))
        print(f"    [{time.time() - t0:.0f} s]")
        if not scale:
            t0 = time.time()
            Yd, tail, worst, drift, keep = run_d(t)
            diff("A - D (Lagrange, 40 digits)", Y, Yd, (0, 1, 2))
            print(f"    series {keep} terms, tail {tail:.1e}, largest local error {worst:.1e}, energy {drift:.1e}  [{time.time() - t0:.0f} s]")


if __name__ == "__main__":
    main()
