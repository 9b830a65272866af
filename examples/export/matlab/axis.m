% The compensator in a loop, over a triangle of the position, 10 mm/s each way.
%
%     stiction export examples/export/model.toml --target matlab --out matlab
%     octave-cli --path matlab examples/export/matlab/axis.m
%
% In MATLAB: addpath matlab, then run it. Nothing is added for the first 11 s: the watchdog learns the error without compensation
% over five cycles of the motion.
params = x_axis_params();
params.gain = 0.5;
params.watchdog_window = 1.9; % a little less than a cycle of the motion
state = x_axis_init(params);
assert(state.ready);
for cycle = 0:13999
    % in the place of yours: what the set point generator, the encoder, the speed controller and the drive say
    if mod(cycle, 2000) < 1000
        input.reference_velocity = 0.010;
    else
        input.reference_velocity = -0.010;
    end
    input.tracking_error = 0;
    controller_force = 0;
    input.enable = true; % drive in operation, homed, no stop asked for, brake open
    [force, state] = x_axis_step(params, state, input);
    force = controller_force + force;
    if (cycle >= 12000) && (mod(cycle, 1000) == 999)
        fprintf('%.2f N at %.0f mm/s\n', force, 1e3 * input.reference_velocity);
    end
end
