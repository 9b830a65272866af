//! Filters of a robot's rigid body, and when its model is refused.

thresholds! {
    COMMON_CUTOFF: f64 = 5.0, "Hz", "Low-pass on torques and regressor of the rigid body.", "published fits of six-joint arms; faster motion hardly moves links";
    MAX_COMMON_CUTOFF: f64 = 1.0 / 6.0, "1", "The same, as a part of the sample rate.", "choice: three samples for each of the fastest half periods";
    SOURCE_CUTOFF: f64 = 0.4, "1", "Low-pass on the positions of the joints, as a part of the sample rate.", "UR10, Panda and simulated arms: the other filter removes the noise from torques and regressor alike";
    MAX_FILTERED_ERROR: f64 = 0.8, "1", "Residual with a low-pass in the torques over that without from which there is one.", "choice: UR10 .4, Panda .9";
    MAX_BEYOND_FILTER: f64 = 0.05, "1", "Torque above twice the cut-off of such a low-pass, over the whole torque.", "UR10 .002; SO-101, which has none, .3, Panda .15; a fourth-order low-pass passes 1/256";
    MAX_TORQUE_ERROR: f64 = 1.0 / 3.0, "1", "Part of the torque of a joint that the model may leave on samples that were not fitted.", "as for friction: MAX_HELD_OUT_ERROR";
    BEYOND_LIMITS: f64 = 0.25, "1", "Part of a joint's range in the URDF by which its positions go beyond before its column is doubted.", "choice: soft limits of controllers and zero offsets are within it, degrees far beyond";
    OTHER_UNITS: f64 = 3.0, "1", "Range of a joint's positions over that in the URDF from which they are refused.", "choice: degrees are 57 times as many";
    PAYLOAD_DEVIATIONS: f64 = 3.0, "1", "Standard deviations of a load that is not in the URDF from which it is reported.", "choice: links within their prior reach 2";
    MAX_URDF_DISTANCE: f64 = 6.0, "1", "Distance of a body from that of the URDF, in standard deviations of the prior, from which it is reported.", "UR10 with a tool 3.5, Panda 2; a simulated arm with gravity inverted, a zero off by 90 degrees or time twice as fast 15 to 28";
    MIN_PAYLOAD: f64 = 0.02, "1", "The same, as a part of the robot's mass.", "choice: cables and screws are less";
}
