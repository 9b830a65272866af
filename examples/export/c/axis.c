/* The compensator in a loop, over one period of a triangle of the position, 10 mm/s each way.
 *
 *     stiction export examples/export/model.toml --target c --out c
 *     cc -std=c99 -O2 -Ic examples/export/c/axis.c c/x_axis_friction.c -lm && ./a.out
 */
#include "x_axis_friction.h"

#include <stdio.h>

/* In the place of yours: what the set point generator, the encoder and the speed controller say, and the drive's input. */
static double reference_velocity(int cycle) { return (cycle < 1000) ? 0.010 : -0.010; }
static double tracking_error(void) { return 0.0; }
static double controller_force(void) { return 0.0; }

int main(void)
{
    x_axis_params_t params;
    x_axis_state_t state;
    x_axis_params(&params);
    params.gain = 0.5;
    /* off for this example only: the watchdog would let the axis move without compensation first */
    params.watchdog_window = 0.0;
    if (!x_axis_init(&params, &state)) {
        return 1;
    }
    for (int cycle = 0; cycle < 2000; cycle++) {
        const x_axis_input_t input = { reference_velocity(cycle), tracking_error(), true };
        const double force = controller_force() + x_axis_step(&params, &state, &input);
        if ((cycle % 1000) == 999) {
            (void)printf("%.2f N at %.0f mm/s\n", force, 1e3 * input.reference_velocity);
        }
    }
    return 0;
}
