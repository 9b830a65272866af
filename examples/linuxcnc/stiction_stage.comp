component stiction_stage "A linear motor stage with friction: force in, encoder out";

description """
The machine of this example, simulated: M dv/dt = F - friction, with the friction law of Canudas de Wit, Olsson, Astrom and
Lischinsky 1995 (LuGre, doi 10.1109/9.376053), eqs. 1 to 4 with their sigma0 g in newtons:

    dz/dt = v - sigma0 |v| / g(v) z,    g(v) = coulomb + (static_friction - coulomb) exp(-(v/stribeck_velocity)^2)
    friction = sigma0 z + sigma1 dz/dt + sigma2 v

F follows the commanded force, within limit, as a current loop does. A call moves it on by a period of the thread, in a hundred
steps of the classical Runge-Kutta method, whenever it is called.
""";

pin in float force "commanded force, N";
pin out float position "what the encoder counts, mm";
param rw float mass = 4.6 "kg";
param rw float sigma0 = 2e6 "N/m";
param rw float sigma1 = 1500 "N s/m";
param rw float sigma2 = 30 "N s/m";
param rw float coulomb = 12 "N";
param rw float static_friction = 18 "N";
param rw float stribeck_velocity = 0.003 "m/s";
param rw float limit = 200 "largest force of the drive, N";
param rw float current_loop = 0.00016 "its time constant, s";
param rw float count = 1e-7 "step of the encoder, m";
variable double at[4];

// The pins' names are those of the equations.
option no_convenience_defines;
function _ fp "before the motion controller";
license "GPL";
author "stiction";
;;
#include "rtapi_math.h"

enum { X, V, Z, F, STATES };

static void rates(const struct __comp_state *axis, double command, const double *now, double *rate) {
    const double v = now[V], ratio = v / axis->stribeck_velocity;
    const double level = axis->coulomb + (axis->static_friction - axis->coulomb) * exp(-ratio * ratio);
    rate[X] = v;
    rate[Z] = v - axis->sigma0 * fabs(v) / level * now[Z];
    rate[V] = (now[F] - axis->sigma0 * now[Z] - axis->sigma1 * rate[Z] - axis->sigma2 * v) / axis->mass;
    rate[F] = (command - now[F]) / axis->current_loop;
}

/* FUNCTION(_), written out: halcompile's own define comes with those of the pins. */
static void _(struct __comp_state *axis, long period) {
    const int steps = 100;
    const double h = period * 1e-9 / steps;
    const double command = fmax(-axis->limit, fmin(axis->limit, *axis->force));
    static const double ahead[4] = { 0.0, 0.5, 0.5, 1.0 }, weight[4] = { 1.0, 2.0, 2.0, 1.0 };
    int i, stage, k;
    for (i = 0; i < steps; i++) {
        double rate[STATES] = { 0.0 }, sum[STATES] = { 0.0 }, now[STATES];
        for (stage = 0; stage < 4; stage++) {
            for (k = 0; k < STATES; k++) { now[k] = axis->at[k] + h * ahead[stage] * rate[k]; }
            rates(axis, command, now, rate);
            for (k = 0; k < STATES; k++) { sum[k] += weight[stage] * rate[k]; }
        }
        for (k = 0; k < STATES; k++) { axis->at[k] += h / 6.0 * sum[k]; }
    }
    *axis->position = rint(axis->at[X] / axis->count) * axis->count * 1e3;
}
