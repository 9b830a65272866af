/* The compensator in a loop, over a triangle of the position, 10 mm/s each way.
 *
 *     stiction export examples/export/model.toml --target c --out c
 *     cc -std=c99 -O2 -Ic examples/export/c/axis.c c/x_axis_friction.c -lm && ./a.out
 *
 * Nothing is added for the first 11 s: the watchdog learns the error without compensation over five cycles of the motion.
 */
#include "x_axis_friction.h"

#include <stdio.h>

/* In the place of yours: what the set point generator, the encoder, the speed controller and the drive say. */
static double reference_velocity(int cycle) { return ((cycle % 2000) < 1000) ? 0.010 : -0.010; }
static double tracking_error(void) { return 0.0; }
static double controller_force(void) { return 0.0; }
static bool drive_operates(void) { return true; } /* CiA 402, 6041h: bits 0, 1, 2 and 5 set, bit 3 clear */
static bool homed(void) { return true; }
static bool stopping(void) { return false; } /* E-stop or safe torque off is asked for */
static bool brake_open(void) { return true; }

int main(void)
{
    x_axis_params_t params;
    x_axis_state_t state;
    x_axis_params(&params);
    params.gain = 0.5;
    params.watchdog_window = 1.9; /* a little less than a cycle of the motion */
    if (!x_axis_init(&params, &state)) {
        return 1;
    }
    for (int cycle = 0; cycle < 14000; cycle++) {
        const bool enable = drive_operates() && homed() && !stopping() && brake_open();
        if (stopping()) {
            x_axis_reset(&params, &state); /* gone at once, without the ramp */
        }
        const x_axis_input_t input = { reference_velocity(cycle), tracking_error(), enable };
        const double force = controller_force() + x_axis_step(&params, &state, &input);
        if ((cycle >= 12000) && ((cycle % 1000) == 999)) {
            (void)printf("%.2f N at %.0f mm/s\n", force, 1e3 * input.reference_velocity);
        }
    }
    return 0;
}
