/* Independent reference solutions of the RSUP linkage: ideal, planar and spatial clearance in R, rigid or flexible coupler.
 *
 * Formulation (deliberately unlike the program under test): every body, also the slider, has six free coordinates (centre
 * of mass, quaternion) in global axes; ALL joints are equations, S and the sdes included. Accelerations from
 * (G M^-1 G^T) lambda = -gamma - G M^-1 f; positions and speeds are projected after every step (least kinetic metric).
 * Integrators: extrapolation of the midpoint rule (order 2k, any k) and Fehlberg's 7(8) pair, both from their definitions.
 * Contact made and lost: the step is repeated with other lengths until the gap at its end is zero to rounding.
 *
 * Build:  cc -O2 -o rsup rsup.c -lm          long double;  -DREAL=double for double
 * Usage:  rsup [key=value ...]   keys: clearance=0|1|2 (none, planar, spatial)  n=sdes (0: rigid)  friction=0|1  end=s
 *         tol=1e-15  method=0 (extrapolation) | 8 (Fehlberg)  k=columns  hmax=s  axis=0|1 (spatial: axial equation along x_12 or x_22)
 *         every=s (output times)  at=t1,t2,..  out=PREFIX  (writes PREFIX_states.csv, PREFIX_events.csv)
 */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tgmath.h>

#ifndef REAL
#define REAL long double
#endif
typedef REAL real;
#define MAXB 24          /* bodies and the ground */
#define MAXM (6 * MAXB)  /* equations */
#define NX 16            /* states behind the bodies: bristles (4), work of drive, contact, damping; integrals */
#define MAXY (13 * MAXB + NX)

/* ------------------------------------------------------------------------------------------------ data of the scene */
static const real RHO = 7850, EMOD = 2.1e11L, GRAV = 9.81L, LCR = 0.2L, LCO = 0.4L, DCR = 0.028L, DCO = 0.010L;
static const real YO = -0.1L, RB = 0.005L, RJ = 0.004L, LB = 0.02L, TAU = 2e-5L, REST = 0.9L;
static const real MUS = 0.2L, MUK = 0.1L, VS = 0.0175L, S0 = 600;
static real S1, KC, CLR, PI;

/* ------------------------------------------------------------------------------------------------------- the options */
static int CL = 0, NS = 0, FRIC = 1, METHOD = 0, KCOL = 8, AXIS = 0;
static double TOL = 1e-16, HMAX = 0.01, END = 5, EVERY = 0.5;

/* ------------------------------------------------------------------------------------------------------ the mechanism */
static int NB, SLI, YOK, LAST, NY, NC; /* bodies: 0 crank, 1..LAST coupler, SLI, YOK; NB is the ground; contacts */
static real mass[MAXB], inert[MAXB][3], CBEND, CTOR;

/* discrete state of the contacts, changed at events only: touching, sign of the sliding speed, force clamped at zero */
static int mode[2], sg[2] = {1, 1}, clamped[2];
static real vimp[2];
static long evals;

static void cross(const real *a, const real *b, real *c) {
    real x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2], z = a[0] * b[1] - a[1] * b[0];
    c[0] = x, c[1] = y, c[2] = z;
}
static real dot(const real *a, const real *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
static void mulv(real R[3][3], const real *s, real *o) {
    real t[3];
    for (int i = 0; i < 3; i++) t[i] = dot(R[i], s);
    memcpy(o, t, sizeof t);
}
static void trmul(real A[3][3], real B[3][3], real C[3][3]) { /* A^T B */
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) C[i][j] = A[0][i] * B[0][j] + A[1][i] * B[1][j] + A[2][i] * B[2][j];
}
static void axis_of(real R[3][3], int k, real *o) {
    for (int i = 0; i < 3; i++) o[i] = R[i][k];
}

/* state: body b: r 0..2, quaternion 3..6, v 7..9, omega (global axes) 10..12; then NX extras */
static real *body(real *y, int b) { return y + 13 * b; }
enum { Z0 = 0, WDRIVE = 4, WCONT, WDAMP, IFN }; /* extras; bristles z[2 k + i] */

typedef struct {
    real R[MAXB][3][3], r[MAXB][3], v[MAXB][3], w[MAXB][3];
} kin;

static void kinematics(const real *y, kin *K) {
    for (int b = 0; b < NB; b++) {
        const real *s = y + 13 * b, *q = s + 3;
        real n = 2 / (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
        for (int i = 0; i < 3; i++) {
            K->r[b][i] = s[i], K->v[b][i] = s[7 + i], K->w[b][i] = s[10 + i];
            for (int j = 0; j < 3; j++) K->R[b][i][j] = n * q[1 + i] * q[1 + j];
        }
        real c = 1 - n * (q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
        for (int i = 0; i < 3; i++) K->R[b][i][i] += c;
        K->R[b][0][1] -= n * q[0] * q[3], K->R[b][1][0] += n * q[0] * q[3];
        K->R[b][0][2] += n * q[0] * q[2], K->R[b][2][0] -= n * q[0] * q[2];
        K->R[b][1][2] -= n * q[0] * q[1], K->R[b][2][1] += n * q[0] * q[1];
    }
    memset(K->R[NB], 0, sizeof K->R[NB]);
    for (int i = 0; i < 3; i++) K->R[NB][i][i] = 1, K->r[NB][i] = K->v[NB][i] = K->w[NB][i] = 0;
}

/* a point fixed on a body: lever, position, velocity, acceleration for vanishing accelerations of the body */
typedef struct {
    real s[3], p[3], v[3], a[3];
} pt;
static void point(kin *K, int b, real x, real y, real z, pt *P) {
    real l[3] = {x, y, z};
    mulv(K->R[b], l, P->s);
    cross(K->w[b], P->s, P->v);
    cross(K->w[b], P->v, P->a);
    for (int i = 0; i < 3; i++) P->p[i] = K->r[b][i] + P->s[i], P->v[i] += K->v[b][i];
}

/* ------------------------------------------------------------------------------------------------------ joint equations */
typedef struct {
    int a, b;
    real A[6], B[6], phi, gam; /* phi' = A.(v,w)_a + B.(v,w)_b;  phi'' = ... + gam */
} row;
static row ROW[MAXM];
static int M, ROW_R; /* number of equations; the first of joint R */

static void add_point(int a, pt *P, int b, pt *Q) {
    for (int k = 0; k < 3; k++) {
        row *r = &ROW[M++];
        real e[3] = {k == 0, k == 1, k == 2};
        r->a = a, r->b = b;
        for (int i = 0; i < 3; i++) r->A[i] = e[i], r->B[i] = -e[i];
        cross(P->s, e, r->A + 3), cross(Q->s, e, r->B + 3);
        for (int i = 0; i < 3; i++) r->B[3 + i] = -r->B[3 + i];
        r->phi = P->p[k] - Q->p[k], r->gam = P->a[k] - Q->a[k];
    }
}
/* axis i of body a normal to axis j of body b */
static void add_normal(kin *K, int a, int i, int b, int j) {
    row *r = &ROW[M++];
    real u[3], w[3], du[3], dw[3], ddu[3], ddw[3];
    axis_of(K->R[a], i, u), axis_of(K->R[b], j, w);
    cross(K->w[a], u, du), cross(K->w[b], w, dw), cross(K->w[a], du, ddu), cross(K->w[b], dw, ddw);
    r->a = a, r->b = b;
    memset(r->A, 0, sizeof r->A), memset(r->B, 0, sizeof r->B);
    cross(u, w, r->A + 3);
    for (int k = 0; k < 3; k++) r->B[3 + k] = -r->A[3 + k];
    r->phi = dot(u, w), r->gam = dot(ddu, w) + 2 * dot(du, dw) + dot(u, ddw);
}
/* (P - Q) . (axis i of body b) = 0, P on a, Q on b */
static void add_along(kin *K, int a, pt *P, int b, pt *Q, int i) {
    row *r = &ROW[M++];
    real u[3], du[3], ddu[3], d[3], dv[3], da[3], t[3];
    axis_of(K->R[b], i, u), cross(K->w[b], u, du), cross(K->w[b], du, ddu);
    for (int k = 0; k < 3; k++) d[k] = P->p[k] - Q->p[k], dv[k] = P->v[k] - Q->v[k], da[k] = P->a[k] - Q->a[k];
    r->a = a, r->b = b;
    for (int k = 0; k < 3; k++) r->A[k] = u[k], r->B[k] = -u[k];
    cross(P->s, u, r->A + 3), cross(Q->s, u, r->B + 3), cross(u, d, t);
    for (int k = 0; k < 3; k++) r->B[3 + k] = t[k] - r->B[3 + k];
    r->phi = dot(d, u), r->gam = dot(da, u) + 2 * dot(dv, du) + dot(d, ddu);
}

static real length_of(int b) { /* of a coupler body */
    return NS == 0 ? LCO : (b == 1 || b == LAST) ? LCO / NS / 2 : LCO / NS;
}

static void equations(kin *K) {
    pt P, Q;
    M = 0;
    point(K, 0, 0, -LCR / 2, 0, &P), point(K, NB, 0, 0, 0, &Q);
    add_point(0, &P, NB, &Q); /* crank on the ground, about global x */
    add_normal(K, 0, 2, NB, 1), add_normal(K, 0, 2, NB, 2);
    point(K, 0, 0, LCR / 2, 0, &P), point(K, 1, 0, length_of(1) / 2, 0, &Q);
    add_point(0, &P, 1, &Q); /* S */
    for (int b = 2; b <= LAST; b++) {
        point(K, b - 1, 0, -length_of(b - 1) / 2, 0, &P), point(K, b, 0, length_of(b) / 2, 0, &Q);
        add_point(b - 1, &P, b, &Q); /* sde */
    }
    ROW_R = M;
    point(K, LAST, 0, -length_of(LAST) / 2, 0, &P), point(K, YOK, 0, 0, 0, &Q);
    if (CL == 0)
        add_point(LAST, &P, YOK, &Q);
    else if (CL == 2 && AXIS == 0)
        add_along(K, YOK, &Q, LAST, &P, 0);
    else
        add_along(K, LAST, &P, YOK, &Q, 0);
    if (CL < 2) add_normal(K, LAST, 0, YOK, 1), add_normal(K, LAST, 0, YOK, 2);
    point(K, SLI, 0, 0, 0, &P);
    add_point(YOK, &Q, SLI, &P); /* yoke on the slider, about z_21 */
    add_normal(K, YOK, 2, SLI, 0), add_normal(K, YOK, 2, SLI, 1);
    point(K, NB, 0, YO, 0, &Q); /* slider along global x */
    add_along(K, SLI, &P, NB, &Q, 1), add_along(K, SLI, &P, NB, &Q, 2);
    add_normal(K, SLI, 0, NB, 2), add_normal(K, SLI, 0, NB, 0), add_normal(K, SLI, 1, NB, 0);
}

/* M^-1 on a wrench (force, torque about the centre of mass) */
static void minv(kin *K, int b, const real *f, real *o) {
    if (b == NB) {
        memset(o, 0, 6 * sizeof(real));
        return;
    }
    real t[3] = {0, 0, 0}, l[3];
    for (int i = 0; i < 3; i++) o[i] = f[i] / mass[b];
    for (int j = 0; j < 3; j++) {
        axis_of(K->R[b], j, l);
        real c = dot(l, f + 3) / inert[b][j];
        for (int i = 0; i < 3; i++) t[i] += c * l[i];
    }
    memcpy(o + 3, t, sizeof t);
}

/* solves (G M^-1 G^T) x = rhs within its envelope; W = M^-1 G^T is kept */
static real WA[MAXM][6], WB[MAXM][6], S[MAXM][MAXM];
static int FIRST[MAXM];
static real dot6(const real *a, const real *b) { return dot(a, b) + dot(a + 3, b + 3); }
static void factor(kin *K) {
    for (int i = 0; i < M; i++) {
        minv(K, ROW[i].a, ROW[i].A, WA[i]), minv(K, ROW[i].b, ROW[i].B, WB[i]);
        FIRST[i] = i;
        for (int j = 0; j <= i; j++) {
            row *r = &ROW[i], *c = &ROW[j];
            real s = 0;
            int hit = 0;
            if (r->a == c->a && r->a != NB) s += dot6(r->A, WA[j]), hit = 1;
            if (r->a == c->b && r->a != NB) s += dot6(r->A, WB[j]), hit = 1;
            if (r->b == c->a && r->b != NB) s += dot6(r->B, WA[j]), hit = 1;
            if (r->b == c->b && r->b != NB) s += dot6(r->B, WB[j]), hit = 1;
            if (hit && j < FIRST[i]) FIRST[i] = j;
            S[i][j] = s;
        }
        for (int j = FIRST[i]; j <= i; j++) {
            real s = S[i][j];
            for (int k = FIRST[i] > FIRST[j] ? FIRST[i] : FIRST[j]; k < j; k++) s -= S[i][k] * S[j][k];
            S[i][j] = j == i ? sqrt(s) : s / S[j][j];
        }
    }
}
static void solve(real *x) {
    for (int i = 0; i < M; i++) {
        for (int k = FIRST[i]; k < i; k++) x[i] -= S[i][k] * x[k];
        x[i] /= S[i][i];
    }
    for (int i = M - 1; i >= 0; i--) {
        x[i] /= S[i][i];
        for (int k = FIRST[i]; k < i; k++) x[k] -= S[i][k] * x[i];
    }
}

/* -------------------------------------------------------------------------------------------------------------- contact */
typedef struct {
    real dist, rate, n[3], t[3], a[3], vt, va;      /* |e|, its rate, directions, sliding speeds (along t, along a) */
    real damp, fn, mut, mua, zt, za, fb[3], pb[3], pj[3]; /* normal force, coefficients, bristle rates, force on the bearing, points */
} touch;

static void contact(kin *K, const real *x, int k, touch *C) {
    pt E, O, P, J;
    real e[3], de[3], ab[3], xj[3], w[3];
    real h = length_of(LAST) / 2;
    point(K, LAST, 0, -h, 0, &E), point(K, YOK, 0, 0, 0, &O);
    axis_of(K->R[YOK], 0, xj);
    if (CL == 1) { /* plane normal to x_22 */
        P = E, J = O;
        memcpy(C->a, xj, sizeof xj);
        real s = 0;
        for (int i = 0; i < 3; i++) s += (P.p[i] - J.p[i]) * xj[i];
        for (int i = 0; i < 3; i++) e[i] = P.p[i] - J.p[i] - s * xj[i], de[i] = P.v[i] - J.v[i];
    } else { /* edge k of the bearing: plane normal to x_12; the journal's axis is met at s */
        axis_of(K->R[LAST], 0, ab);
        memcpy(C->a, ab, sizeof ab);
        point(K, LAST, k == 0 ? LB / 2 : -LB / 2, -h, 0, &P);
        real d[3], s, ds, c = dot(xj, ab);
        for (int i = 0; i < 3; i++) d[i] = P.p[i] - O.p[i];
        s = dot(d, ab) / c;
        point(K, YOK, s, 0, 0, &J);
        for (int i = 0; i < 3; i++) e[i] = P.p[i] - J.p[i], de[i] = P.v[i] - J.v[i];
        cross(K->w[LAST], ab, w);
        ds = (dot(de, ab) + dot(e, w)) / c;
        for (int i = 0; i < 3; i++) de[i] -= ds * xj[i];
    }
    C->dist = sqrt(dot(e, e));
    if (C->dist == 0) { /* centred: no direction; at rest in the start only */
        C->rate = sqrt(dot(de, de));
        C->fn = C->vt = C->va = C->mut = C->mua = C->zt = C->za = 0;
        memset(C->fb, 0, sizeof C->fb);
        return;
    }
    for (int i = 0; i < 3; i++) C->n[i] = e[i] / C->dist;
    C->rate = dot(de, C->n);
    cross(C->a, C->n, C->t);
    real vr[3], sb[3], sj[3], vb[3], vj[3];
    for (int i = 0; i < 3; i++) {
        C->pb[i] = P.p[i] - RB * C->n[i], C->pj[i] = J.p[i] - RJ * C->n[i];
        sb[i] = C->pb[i] - E.p[i], sj[i] = C->pj[i] - O.p[i];
    }
    cross(K->w[LAST], sb, vb), cross(K->w[YOK], sj, vj);
    for (int i = 0; i < 3; i++) vr[i] = E.v[i] + vb[i] - O.v[i] - vj[i];
    C->vt = dot(vr, C->t), C->va = CL == 2 ? dot(vr, C->a) : 0;
    C->fn = C->mut = C->mua = C->zt = C->za = 0;
    memset(C->fb, 0, sizeof C->fb);
    if (!mode[k]) return;
    real d = C->dist - CLR;
    C->damp = 1 + 3 * (1 - REST * REST) / 4 * C->rate / vimp[k];
    if (d > 0 && !clamped[k]) C->fn = KC / NC * d * sqrt(d) * C->damp;
    if (FRIC) {
        real v = CL == 2 ? sqrt(C->vt * C->vt + C->va * C->va) : sg[k] * C->vt; /* |.| by its branch */
        real g = MUK + (MUS - MUK) * exp(-(v / VS) * (v / VS)), zt = x[Z0 + 2 * k], za = x[Z0 + 2 * k + 1];
        C->zt = C->vt - S0 * v * zt / g, C->za = C->va - S0 * v * za / g;
        C->mut = S0 * zt + S1 * C->zt, C->mua = S0 * za + S1 * C->za;
    }
    for (int i = 0; i < 3; i++) C->fb[i] = -C->fn * (C->n[i] + C->mut * C->t[i] + C->mua * C->a[i]);
}

/* ------------------------------------------------------------------------------------- angles psi, theta, phi of a pair */
/* a in axes of the inner body; columns of H: the axes about which psi, theta, phi turn, global */
static void zyx(kin *K, int a, int b, real ang[3], real rate[3], real H[3][3]) {
    real Rab[3][3], W[3], ax[3][3], det;
    trmul(K->R[a], K->R[b], Rab);
    ang[0] = atan2(Rab[1][0], Rab[0][0]);
    ang[1] = atan2(-Rab[2][0], sqrt(Rab[0][0] * Rab[0][0] + Rab[1][0] * Rab[1][0]));
    ang[2] = atan2(Rab[2][1], Rab[2][2]);
    real yl[3] = {-sin(ang[0]), cos(ang[0]), 0};
    axis_of(K->R[a], 2, ax[0]), mulv(K->R[a], yl, ax[1]), axis_of(K->R[b], 0, ax[2]);
    for (int i = 0; i < 3; i++) W[i] = K->w[b][i] - K->w[a][i];
    /* dual vectors: rate_k = dual_k . W, and a generalised force Q_k acts as the torque sum Q_k dual_k */
    for (int k = 0; k < 3; k++) cross(ax[(k + 1) % 3], ax[(k + 2) % 3], H[k]);
    det = dot(ax[0], H[0]);
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < 3; i++) H[k][i] /= det;
        rate[k] = dot(H[k], W);
    }
}

/* ------------------------------------------------------------------------------------------------- equations of motion */
static real F[MAXB][6], LAM[MAXM], ACC[MAXB][6];
static void wrench(kin *K, int b, const real *f, const real *p, real sign) {
    real s[3], m[3];
    for (int i = 0; i < 3; i++) s[i] = p[i] - K->r[b][i];
    cross(s, f, m);
    for (int i = 0; i < 3; i++) F[b][i] += sign * f[i], F[b][3 + i] += sign * m[i];
}

static void rhs(real t, const real *y, real *f, kin *K) {
    const real *x = y + 13 * NB;
    real *fx = f + 13 * NB;
    evals++;
    kinematics(y, K);
    memset(fx, 0, NX * sizeof(real));
    for (int b = 0; b < NB; b++) {
        real l[3], g[3] = {0, 0, 0}, u[3];
        for (int j = 0; j < 3; j++) {
            axis_of(K->R[b], j, u);
            l[j] = inert[b][j] * dot(u, K->w[b]);
            for (int i = 0; i < 3; i++) g[i] += l[j] * u[i];
        }
        cross(g, K->w[b], F[b] + 3); /* -omega x h */
        F[b][0] = F[b][1] = 0, F[b][2] = -mass[b] * GRAV;
    }
    real zc[3], w = 0, drive;
    axis_of(K->R[0], 2, zc);
    w = dot(zc, K->w[0]);
    drive = 10 * (t < 2 ? t / 2 : 1) - 10 * w / 9;
    for (int i = 0; i < 3; i++) F[0][3 + i] += drive * zc[i];
    fx[WDRIVE] = drive * w;
    for (int b = 2; b <= LAST; b++) {
        real a[3], r[3], H[3][3];
        zyx(K, b - 1, b, a, r, H);
        for (int k = 0; k < 3; k++) {
            real c = k == 1 ? CTOR : CBEND, q = -c * (a[k] + TAU * r[k]);
            fx[WDAMP] -= c * TAU * r[k] * r[k];
            for (int i = 0; i < 3; i++) F[b][3 + i] += q * H[k][i], F[b - 1][3 + i] -= q * H[k][i];
        }
    }
    for (int k = 0; k < NC; k++)
        if (mode[k]) {
            touch C;
            contact(K, x, k, &C);
            fx[Z0 + 2 * k] = C.zt, fx[Z0 + 2 * k + 1] = C.za;
            wrench(K, LAST, C.fb, C.pb, 1), wrench(K, YOK, C.fb, C.pj, -1);
            real vb[3], vj[3], s[3];
            for (int i = 0; i < 3; i++) s[i] = C.pb[i] - K->r[LAST][i];
            cross(K->w[LAST], s, vb);
            for (int i = 0; i < 3; i++) s[i] = C.pj[i] - K->r[YOK][i];
            cross(K->w[YOK], s, vj);
            for (int i = 0; i < 3; i++) fx[WCONT] += C.fb[i] * (K->v[LAST][i] + vb[i] - K->v[YOK][i] - vj[i]);
            fx[IFN] += C.fn;
        }
    equations(K);
    factor(K);
    for (int b = 0; b < NB; b++) minv(K, b, F[b], ACC[b]);
    memset(ACC[NB], 0, sizeof ACC[NB]);
    for (int i = 0; i < M; i++) LAM[i] = -ROW[i].gam - dot6(ROW[i].A, ACC[ROW[i].a]) - dot6(ROW[i].B, ACC[ROW[i].b]);
    solve(LAM);
    for (int i = 0; i < M; i++)
        for (int j = 0; j < 6; j++) {
            if (ROW[i].a != NB) ACC[ROW[i].a][j] += LAM[i] * WA[i][j];
            if (ROW[i].b != NB) ACC[ROW[i].b][j] += LAM[i] * WB[i][j];
        }
    for (int b = 0; b < NB; b++) {
        real *d = f + 13 * b;
        const real *q = y + 13 * b + 3, *o = y + 13 * b + 10;
        for (int i = 0; i < 3; i++) d[i] = y[13 * b + 7 + i], d[7 + i] = ACC[b][i], d[10 + i] = ACC[b][3 + i];
        real c[3];
        cross(o, q + 1, c);
        d[3] = -dot(o, q + 1) / 2;
        for (int i = 0; i < 3; i++) d[4 + i] = (q[0] * o[i] + c[i]) / 2;
    }
}

static void turn(real *q, const real *th) { /* by a small rotation vector, global */
    real c[3], d[4];
    cross(th, q + 1, c);
    d[0] = -dot(th, q + 1) / 2;
    for (int i = 0; i < 3; i++) d[1 + i] = (q[0] * th[i] + c[i]) / 2;
    real n = 0;
    for (int i = 0; i < 4; i++) q[i] += d[i], n += q[i] * q[i];
    n = sqrt(n);
    for (int i = 0; i < 4; i++) q[i] /= n;
}

static real project(real *y, int sweeps) {
    kin K;
    real x[MAXM], worst = 0;
    for (int it = 0; it <= sweeps; it++) {
        kinematics(y, &K), equations(&K), factor(&K);
        if (it == sweeps) {
            for (int i = 0; i < M; i++)
                x[i] = -dot(ROW[i].A, K.v[ROW[i].a]) - dot(ROW[i].A + 3, K.w[ROW[i].a]) - dot(ROW[i].B, K.v[ROW[i].b]) -
                       dot(ROW[i].B + 3, K.w[ROW[i].b]);
        } else
            for (int i = 0; i < M; i++) x[i] = -ROW[i].phi, worst = fabs(x[i]) > worst ? fabs(x[i]) : worst;
        solve(x);
        real d[MAXB][6];
        memset(d, 0, sizeof d);
        for (int i = 0; i < M; i++)
            for (int j = 0; j < 6; j++) {
                if (ROW[i].a != NB) d[ROW[i].a][j] += x[i] * WA[i][j];
                if (ROW[i].b != NB) d[ROW[i].b][j] += x[i] * WB[i][j];
            }
        for (int b = 0; b < NB; b++) {
            real *s = body(y, b);
            if (it == sweeps)
                for (int i = 0; i < 6; i++) s[7 + i] += d[b][i];
            else {
                for (int i = 0; i < 3; i++) s[i] += d[b][i];
                turn(s + 3, d[b] + 3);
            }
        }
    }
    return worst;
}

/* --------------------------------------------------------------------------------------------------------- integrators */
static real F0[MAXY]; /* right-hand side at the start of the step */

/* Depth^1.5 has no second derivative where contact begins or ends. There the step is done in sigma instead of t:
 * kind 1: t = t0 + sigma^2; kind 2: t = t0 + h - (sqrt(h) - sigma)^2; the motion is smooth in sigma. */
static int KIND;
static real TA, HS;
static void rate(real s, const real *y, real *f, kin *K) {
    if (!KIND) {
        rhs(TA + s, y, f, K);
        return;
    }
    real r = HS - s, c = 2 * (KIND == 1 ? s : r);
    if (r < 0) r = 0;
    rhs(TA + (KIND == 1 ? s * s : HS * HS - r * r), y, f, K);
    for (int i = 0; i < NY; i++) f[i] *= c;
}

static real weighted(const real *e, const real *y) {
    real w = 0;
    for (int i = 0; i < NY; i++) {
        real v = fabs(e[i]) / (1 + fabs(y[i]));
        if (!(v <= w)) w = v;
    }
    return w;
}

static real step_extrapolation(const real *y, real h, const real *f0, real *out) {
    static real T[20][MAXY], u[MAXY], v[MAXY], w[MAXY], f[MAXY], e[MAXY];
    kin K;
    for (int j = 0; j < KCOL; j++) {
        int n = 2 * (j + 1);
        real s = h / n;
        memcpy(u, y, NY * sizeof(real));
        for (int i = 0; i < NY; i++) v[i] = y[i] + s * f0[i];
        for (int m = 1; m < n; m++) {
            rate(m * s, v, f, &K);
            for (int i = 0; i < NY; i++) w[i] = u[i] + 2 * s * f[i], u[i] = v[i], v[i] = w[i];
        }
        /* Aitken-Neville in 1/n^2, in place: T[l] is the entry of column j - l */
        for (int i = 0; i < NY; i++) {
            real c = v[i];
            for (int l = j - 1; l >= 0; l--) {
                real q = (real)(j + 1) / (l + 1), nx = c + (c - T[l][i]) / (q * q - 1);
                T[l + 1][i] = c, c = nx;
            }
            if (j == KCOL - 1) e[i] = j ? c - T[1][i] : 0;
            T[0][i] = c;
        }
    }
    memcpy(out, T[0], NY * sizeof(real));
    return weighted(e, out);
}

static const real FC[13] = {0, 2.0L / 27, 1.0L / 9, 1.0L / 6, 5.0L / 12, 0.5L, 5.0L / 6, 1.0L / 6, 2.0L / 3, 1.0L / 3, 1, 0, 1};
static const real FA[13][12] = {
    {0},
    {2.0L / 27},
    {1.0L / 36, 1.0L / 12},
    {1.0L / 24, 0, 1.0L / 8},
    {5.0L / 12, 0, -25.0L / 16, 25.0L / 16},
    {1.0L / 20, 0, 0, 1.0L / 4, 1.0L / 5},
    {-25.0L / 108, 0, 0, 125.0L / 108, -65.0L / 27, 125.0L / 54},
    {31.0L / 300, 0, 0, 0, 61.0L / 225, -2.0L / 9, 13.0L / 900},
    {2, 0, 0, -53.0L / 6, 704.0L / 45, -107.0L / 9, 67.0L / 90, 3},
    {-91.0L / 108, 0, 0, 23.0L / 108, -976.0L / 135, 311.0L / 54, -19.0L / 60, 17.0L / 6, -1.0L / 12},
    {2383.0L / 4100, 0, 0, -341.0L / 164, 4496.0L / 1025, -301.0L / 82, 2133.0L / 4100, 45.0L / 82, 45.0L / 164, 18.0L / 41},
    {3.0L / 205, 0, 0, 0, 0, -6.0L / 41, -3.0L / 205, -3.0L / 41, 3.0L / 41, 6.0L / 41, 0},
    {-1777.0L / 4100, 0, 0, -341.0L / 164, 4496.0L / 1025, -289.0L / 82, 2193.0L / 4100, 51.0L / 82, 33.0L / 164, 12.0L / 41, 0, 1}};
static const real FB[13] = {0, 0, 0, 0, 0, 34.0L / 105, 9.0L / 35, 9.0L / 35, 9.0L / 280, 9.0L / 280, 0, 41.0L / 840, 41.0L / 840};

static real step_fehlberg(const real *y, real h, const real *f0, real *out) {
    static real k[13][MAXY], u[MAXY];
    kin K;
    memcpy(k[0], f0, NY * sizeof(real));
    for (int s = 1; s < 13; s++) {
        for (int i = 0; i < NY; i++) {
            real a = 0;
            for (int j = 0; j < s; j++)
                if (FA[s][j] != 0) a += FA[s][j] * k[j][i];
            u[i] = y[i] + h * a;
        }
        rate(FC[s] * h, u, k[s], &K);
    }
    for (int i = 0; i < NY; i++) {
        real a = 0;
        for (int s = 5; s < 13; s++) a += FB[s] * k[s][i];
        out[i] = y[i] + h * a;
        u[i] = 41.0L / 840 * h * (k[0][i] + k[10][i] - k[11][i] - k[12][i]);
    }
    return weighted(u, out);
}
static real step(real t, const real *y, real h, int kind, real *out) {
    static real f0[MAXY];
    KIND = kind, TA = t, HS = kind ? sqrt(h) : h;
    for (int i = 0; i < NY; i++) f0[i] = kind == 0 ? F0[i] : kind == 1 ? 0 : 2 * HS * F0[i];
    return METHOD ? step_fehlberg(y, HS, f0, out) : step_extrapolation(y, HS, f0, out);
}

/* ------------------------------------------------------------------------------------------------------------- results */
static real unwrapped[2];
static FILE *FS, *FE;

static real near(real a, real b) { return a + 2 * PI * rint((b - a) / (2 * PI)); }
/* psi11, psi12, theta12, phi12, z21, psi22 and their speeds */
static void coordinates(kin *K, real q[6], real v[6]) {
    real H[3][3], *R;
    R = &K->R[0][0][0];
    /* axes of {1,0}: x = -Z, y = Y, z = X; x_11 = cos psi x + sin psi y */
    q[0] = unwrapped[0] = near(atan2(R[3], -R[6]), unwrapped[0]);
    v[0] = K->w[0][0];
    zyx(K, 0, 1, q + 1, v + 1, H);
    q[4] = K->r[SLI][0], v[4] = K->v[SLI][0];
    /* axes of {2,1}: x = Y, y = Z, z = X */
    R = &K->R[YOK][0][0];
    q[5] = unwrapped[1] = near(atan2(R[6], R[3]), unwrapped[1]);
    v[5] = K->w[YOK][0];
}

static void header(void) {
    const char *name[6] = {"psi11", "psi12", "theta12", "phi12", "z21", "psi22"};
    fprintf(FS, "t");
    for (int s = 0; s < 2; s++) {
        for (int i = 0; i < 6; i++) fprintf(FS, ",%c.%s", "qv"[s], name[i]);
        for (int b = 1; b < LAST; b++) fprintf(FS, ",%c.psi12.%d,%c.theta12.%d,%c.phi12.%d", "qv"[s], b, "qv"[s], b, "qv"[s], b);
    }
    fprintf(FS, ",a.psi11,a.z21,R.fx,R.fy,R.fz,R.nx,R.ny,R.nz");
    const char *part[8] = {"depth", "rate", "normal", "tangent", "tangent_axial", "bristle", "bristle_axial", "impact_speed"};
    for (int k = 0; k < NC; k++)
        for (int j = 0; j < 8; j++)
            if (NC == 2 || (j != 4 && j != 6)) fprintf(FS, ",contact.R%s.%s", NC == 1 ? "" : k ? "2" : "1", part[j]);
    fprintf(FS, ",energy.kinetic,energy.potential,work.drive");
    if (NS) fprintf(FS, ",energy.elastic,work.damping");
    if (NC) fprintf(FS, ",energy.contact,work.contact,impulse.normal");
    fprintf(FS, "\n");
}

static void output(real t, const real *y) {
    static real f[MAXY];
    kin K;
    real q[6], v[6], H[3][3], e[5] = {0}, fo[3] = {0}, mo[3] = {0}, d[3];
    const real *x = y + 13 * NB;
    rhs(t, y, f, &K);
    coordinates(&K, q, v);
#define P(x) fprintf(FS, ",%.17Lg", (long double)(x))
    fprintf(FS, "%.15Lg", (long double)t);
    for (int s = 0; s < 2; s++) {
        for (int i = 0; i < 6; i++) P(s ? v[i] : q[i]);
        for (int b = 2; b <= LAST; b++) {
            real a[3], r[3];
            zyx(&K, b - 1, b, a, r, H);
            for (int i = 0; i < 3; i++) P(s ? r[i] : a[i]);
        }
    }
    P(ACC[0][3]), P(ACC[SLI][0]);
    /* all that joint R exerts on the coupler, kept equations and contact: force, and moment about E, global axes */
    pt E;
    point(&K, LAST, 0, -length_of(LAST) / 2, 0, &E);
    for (int i = ROW_R; i < ROW_R + (CL == 0 ? 5 : CL == 1 ? 3 : 1); i++) {
        real *g = ROW[i].a == LAST ? ROW[i].A : ROW[i].B, m[3];
        cross(E.s, g, m);
        for (int k = 0; k < 3; k++) fo[k] += LAM[i] * g[k], mo[k] += LAM[i] * (g[3 + k] - m[k]);
    }
    touch C[2];
    for (int k = 0; k < NC; k++) {
        contact(&K, x, k, &C[k]);
        if (!mode[k]) continue;
        real m[3];
        for (int i = 0; i < 3; i++) d[i] = C[k].pb[i] - E.p[i], fo[i] += C[k].fb[i];
        cross(d, C[k].fb, m);
        for (int i = 0; i < 3; i++) mo[i] += m[i];
        real dep = C[k].dist - CLR;
        if (dep > 0) e[3] += KC / NC * dep * dep * sqrt(dep) / 2.5L;
    }
    for (int i = 0; i < 3; i++) P(fo[i]);
    for (int i = 0; i < 3; i++) P(mo[i]);
    for (int k = 0; k < NC; k++) {
        P(C[k].dist - CLR), P(C[k].rate), P(C[k].fn), P(C[k].fn * C[k].mut);
        if (NC == 2) P(C[k].fn * C[k].mua);
        P(x[Z0 + 2 * k]);
        if (NC == 2) P(x[Z0 + 2 * k + 1]);
        P(mode[k] ? vimp[k] : 0);
    }
    for (int b = 0; b < NB; b++) {
        real u[3];
        e[0] += mass[b] * dot(K.v[b], K.v[b]) / 2, e[1] += mass[b] * GRAV * K.r[b][2];
        for (int j = 0; j < 3; j++) {
            axis_of(K.R[b], j, u);
            real w = dot(u, K.w[b]);
            e[0] += inert[b][j] * w * w / 2;
        }
    }
    for (int b = 2; b <= LAST; b++) {
        real a[3], r[3];
        zyx(&K, b - 1, b, a, r, H);
        for (int k = 0; k < 3; k++) e[2] += (k == 1 ? CTOR : CBEND) * a[k] * a[k] / 2;
    }
    P(e[0]), P(e[1]), P(x[WDRIVE]);
    if (NS) P(e[2]), P(x[WDAMP]);
    if (NC) P(e[3]), P(x[WCONT]), P(x[IFN]);
    fprintf(FS, "\n");
    fflush(FS);
}

/* ------------------------------------------------------------------------------------------------------------ the start */
static void frame(real *y, int b, const real *c1, const real *c2, const real *c3) { /* orientation by its columns */
    real R[3][3], *q = body(y, b) + 3, best = -1;
    for (int i = 0; i < 3; i++) R[i][0] = c1[i], R[i][1] = c2[i], R[i][2] = c3[i];
    real d[4] = {1 + R[0][0] + R[1][1] + R[2][2], 1 + R[0][0] - R[1][1] - R[2][2], 1 - R[0][0] + R[1][1] - R[2][2],
                 1 - R[0][0] - R[1][1] + R[2][2]};
    int k = 0;
    for (int i = 0; i < 4; i++)
        if (d[i] > best) best = d[i], k = i;
    real s = 2 * sqrt(best);
    q[k] = s / 4;
    real a = (R[2][1] - R[1][2]) / s, b2 = (R[0][2] - R[2][0]) / s, c = (R[1][0] - R[0][1]) / s;
    real p = (R[0][1] + R[1][0]) / s, r = (R[0][2] + R[2][0]) / s, t = (R[1][2] + R[2][1]) / s;
    if (k == 0) q[1] = a, q[2] = b2, q[3] = c;
    if (k == 1) q[0] = a, q[2] = p, q[3] = r;
    if (k == 2) q[0] = b2, q[1] = p, q[3] = t;
    if (k == 3) q[0] = c, q[1] = r, q[2] = t;
}

static void start(real *y) {
    PI = 4 * atan((real)1);
    S1 = sqrt((real)600), CLR = RB - RJ;
    real s = (1 - 0.09L) / EMOD;
    KC = 4 / (3 * (s + s)) * sqrt(RB * RJ / (RB - RJ));
    LAST = NS + 1, SLI = LAST + 1, YOK = SLI + 1, NB = YOK + 1, NC = CL;
    NY = 13 * NB + NX;
    memset(y, 0, MAXY * sizeof(real));
    for (int b = 0; b <= LAST; b++) {
        real d = b ? DCO : DCR, l = b ? length_of(b) : LCR, m = RHO * PI * d * d / 4 * l;
        mass[b] = m, inert[b][1] = m * d * d / 8, inert[b][0] = inert[b][2] = m * (l * l / 12 + d * d / 16);
    }
    mass[SLI] = 1, mass[YOK] = 0.1L;
    for (int i = 0; i < 3; i++) inert[SLI][i] = 0.01L /* never turns */, inert[YOK][i] = 2e-5L;
    if (NS) {
        CBEND = EMOD * PI * DCO * DCO * DCO * DCO / 64 / (LCO / NS);
        CTOR = EMOD / 2.6L * PI * DCO * DCO * DCO * DCO / 32 / (LCO / NS);
    }
    /* crank upright: x_11 = Y, y_11 = Z, z_11 = X; S = (0, 0, 0.2), E on the slide with positive x */
    real X[3] = {1, 0, 0}, Y[3] = {0, 1, 0}, Z[3] = {0, 0, 1}, S_[3] = {0, 0, LCR}, E[3] = {0, YO, 0}, u[3], x[3], z[3];
    E[0] = sqrt(LCO * LCO - YO * YO - LCR * LCR);
    for (int i = 0; i < 3; i++) u[i] = (S_[i] - E[i]) / LCO; /* y_12 */
    cross(u, X, x); /* x_12 normal to the coupler and to the slide; of the two, the one near the guess (psi, theta small) */
    real n = sqrt(dot(x, x));
    for (int i = 0; i < 3; i++) x[i] /= n;
    if (x[1] < 0)
        for (int i = 0; i < 3; i++) x[i] = -x[i];
    cross(x, u, z);
    frame(y, 0, Y, Z, X);
    body(y, 0)[2] = LCR / 2;
    real at = 0;
    for (int b = 1; b <= LAST; b++) {
        frame(y, b, x, u, z);
        for (int i = 0; i < 3; i++) body(y, b)[i] = S_[i] - (at + length_of(b) / 2) * u[i];
        at += length_of(b);
    }
    frame(y, SLI, Y, Z, X);
    cross(X, x, z);
    frame(y, YOK, x, z, X);
    for (int i = 0; i < 3; i++) body(y, SLI)[i] = body(y, YOK)[i] = E[i];
    unwrapped[0] = PI / 2, unwrapped[1] = 0;
}

/* ------------------------------------------------------------------------------------------------------------- the run */
/* what is watched, 3 of each contact: gap closed (sign by mode), sliding speed (sign by sg), damping factor (sign by clamped);
 * each is positive while the discrete state holds, 1 where it does not apply */
static void watch(const real *y, real *g) {
    kin K;
    kinematics(y, &K);
    for (int k = 0; k < NC; k++) {
        touch C;
        contact(&K, y + 13 * NB, k, &C);
        g[3 * k] = mode[k] ? C.dist - CLR : CLR - C.dist;
        g[3 * k + 1] = mode[k] && FRIC && CL == 1 ? sg[k] * C.vt : 1;
        g[3 * k + 2] = mode[k] ? (clamped[k] ? -C.damp : C.damp) : 1;
    }
}
static void watch_rates(const real *y, const real *f, const real *g, real *dg) {
    static real u[MAXY];
    const real eps = 1e-8L;
    for (int i = 0; i < NY; i++) u[i] = y[i] + eps * f[i];
    watch(u, dg);
    for (int k = 0; k < 3 * NC; k++) dg[k] = (dg[k] - g[k]) / eps;
}
static real advance(real t, const real *y, real h, int kind, real *out) {
    real e = step(t, y, h, kind, out);
    project(out, 1);
    return e;
}
/* could the cubic through values and rates dip towards 0 within the step although both ends are positive? */
static int suspicious(real g0, real d0, real g1, real d1, real h) {
    if (d0 >= 0 || d1 <= 0) return 0;
    for (int i = 1; i < 32; i++) {
        real u = i / 32.0L, v = 1 - u;
        real c = v * v * (1 + 2 * u) * g0 + u * u * (1 + 2 * v) * g1 + h * u * v * (v * d0 - u * d1);
        if (c < (g0 < g1 ? g0 : g1) / 8) return 1;
    }
    return 0;
}

int main(int argc, char **argv) {
    const char *prefix = "rsup";
    static double times[10000];
    int nt = 0, it = 0;
    for (int i = 1; i < argc; i++) {
        char *v = strchr(argv[i], '=');
        if (!v) return fprintf(stderr, "key=value expected: %s\n", argv[i]), 2;
        *v++ = 0;
#define KEY(k, var, conv) else if (!strcmp(argv[i], k)) var = conv(v)
        if (!strcmp(argv[i], "out")) prefix = v;
        else if (!strcmp(argv[i], "at"))
            for (char *p = v; *p; p += *p == ',') times[nt++] = strtod(p, &p);
        KEY("clearance", CL, atoi); KEY("n", NS, atoi); KEY("friction", FRIC, atoi); KEY("method", METHOD, atoi);
        KEY("k", KCOL, atoi); KEY("axis", AXIS, atoi); KEY("tol", TOL, atof); KEY("hmax", HMAX, atof);
        KEY("end", END, atof); KEY("every", EVERY, atof);
        else return fprintf(stderr, "unknown key %s\n", argv[i]), 2;
    }
    if (!nt)
        for (nt = 0; nt * EVERY <= END * (1 + 1e-12); nt++) times[nt] = nt * EVERY;
    char name[400];
    snprintf(name, sizeof name, "%s_states.csv", prefix), FS = fopen(name, "w");
    if (!FS) return 1;
    static real y[MAXY], y1[MAXY], y2[MAXY], f1[MAXY];
    real t = 0, h = 1e-6L, g0[6], d0[6], g1[6], d1[6], worst = 0, shared = 0, made[2] = {0};
    long steps = 0, rejected = 0, makes = 0, halved = 0, reversals = 0, clamps = 0;
    int fresh = 0; /* contact has just begun */
    start(y);
    if (NC) {
        snprintf(name, sizeof name, "%s_events.csv", prefix), FE = fopen(name, "w");
        if (!FE) return 1;
        fprintf(FE, "t,kind,name,speed\n");
    }
    real moved = project(y, 2);
    header();
    while (it < nt && times[it] <= 0) output(0, y), it++;
    kin K;
    real q_[6], v_[6];
    while (t < END) {
        real stop = END;
        if (it < nt && times[it] < stop) stop = times[it];
        if (t < 2 && stop > 2) stop = 2;
        int hits = 0, fired = -1;
        if (h > (real)HMAX) h = HMAX;
        real want = h;
        if (t + h * 1.0001L >= stop) h = stop - t, hits = 1;
        rhs(t, y, F0, &K);
        watch(y, g0), watch_rates(y, F0, g0, d0);
        real err = advance(t, y, h, fresh ? 1 : 0, y1);
        if (!(err < 1e-3L)) { /* far too long */
            h /= 10, rejected++;
            continue;
        }
        watch(y1, g1);
        for (int pass = 0; pass < 3; pass++)
            for (int k = 0; k < 3 * NC; k++) {
                if (g1[k] >= 0) continue;
                /* the earliest zero of function k: false position with halving, repeating the step */
                int kind = k % 3 == 0 && mode[k / 3] ? 2 : fresh ? 1 : 0;
                real a = 0, b = h, fa = g0[k] > 0 ? g0[k] : 0, fb = g1[k], c = h;
                for (int i = 0; i < 120; i++) {
                    c = i == 0 || i % 12 == 11 || fa == 0 ? (a + b) / 2 : (a * fb - b * fa) / (fb - fa);
                    if (!(c > a && c < b)) c = (a + b) / 2;
                    err = advance(t, y, c, kind, y2), watch(y2, g1);
                    if (g1[k] > 0) {
                        if (fa == g1[k]) break;
                        a = c, fa = g1[k], fb /= i > 1 ? 2 : 1;
                    } else {
                        b = c, fb = g1[k], fa /= i > 1 ? 2 : 1;
                    }
                    if (b - a < 1e-19L || fabs(g1[k]) < (k % 3 ? 1e-19L : 3e-20L)) break;
                }
                g1[k] = 0;
                memcpy(y1, y2, sizeof y1);
                h = c, hits = 0, fired = k;
            }
        err /= (real)TOL;
        real order = METHOD ? 8 : 2 * KCOL - 1, scale = err > 0 ? 0.85L * pow(err, -1 / order) : 4;
        if (!(err <= 1)) {
            h *= scale < 0.1L ? 0.1L : scale, rejected++;
            if (h < 1e-16L) return fprintf(stderr, "step too short at %.12Lg, err %.3Lg\n", (long double)t, (long double)err), 1;
            continue;
        }
        if (NC) {
            int redo = 0;
            rhs(t + h, y1, f1, &K);
            watch_rates(y1, f1, g1, d1);
            for (int k = 0; k < 3 * NC; k++) redo |= h > 1e-9L && k != fired && suspicious(g0[k], d0[k], g1[k], d1[k], h);
            if (redo) {
                h /= 2, halved++;
                continue;
            }
        }
        t = hits ? stop : t + h;
        memcpy(y, y1, sizeof y), steps++, fresh = 0;
        kinematics(y, &K), coordinates(&K, q_, v_), equations(&K);
        for (int i = 0; i < M; i++) worst = fabs(ROW[i].phi) > worst ? fabs(ROW[i].phi) : worst;
        if (fired >= 0) {
            int k = fired / 3;
            touch C;
            contact(&K, y + 13 * NB, k, &C);
            h = want;
            if (fired % 3 == 1) sg[k] = -sg[k], reversals++;
            if (fired % 3 == 2) clamped[k] = !clamped[k], clamps++;
            if (fired % 3 == 0) {
                if (mode[k] == 0) {
                    mode[k] = 1, vimp[k] = C.rate > 1e-6L ? C.rate : 1e-6L, made[k] = t, makes++;
                    sg[k] = C.vt < 0 ? -1 : 1, clamped[k] = 0, fresh = 1;
                    h = want < 1e-5L ? want : 1e-5L;
                } else {
                    mode[k] = 0, shared += t - made[k];
                    y[13 * NB + Z0 + 2 * k] = y[13 * NB + Z0 + 2 * k + 1] = 0;
                }
                fprintf(FE, "%.17Lg,%s,R%s,%.17Lg\n", (long double)t, mode[k] ? "made" : "lost", NC == 1 ? "" : k ? "2" : "1",
                        (long double)C.rate);
                fflush(FE);
            }
        } else
            h = hits ? (want > h ? want : h) : h * (scale > 4 ? 4 : scale < 0.2L ? 0.2L : scale);
        if (hits)
            while (it < nt && times[it] <= (double)t) output(t, y), it++;
    }
    for (int k = 0; k < NC; k++)
        if (mode[k]) shared += t - made[k];
    printf("steps %ld rejected %ld halved %ld evaluations %ld; impacts %ld share in contact %.12Lf sliding reversals %ld clamp switches %ld; "
           "start moved %.1Le, worst residual %.1Le\n",
           steps, rejected, halved, evals, makes, (long double)(shared / END), reversals, clamps, (long double)moved, (long double)worst);
    return 0;
}
