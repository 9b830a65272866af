//! Files of the library. Written by `cargo xtask library`; do not edit.

/// Paths from the folder of the library, and contents.
#[rustfmt::skip]
pub const FILES: &[(&str, &str)] = &[
    ("panda/robot.toml", include_str!("panda/robot.toml")),
    ("panda/joints/panda_joint1/model.toml", include_str!("panda/joints/panda_joint1/model.toml")),
    ("panda/joints/panda_joint2/model.toml", include_str!("panda/joints/panda_joint2/model.toml")),
    ("panda/joints/panda_joint3/model.toml", include_str!("panda/joints/panda_joint3/model.toml")),
    ("panda/joints/panda_joint4/model.toml", include_str!("panda/joints/panda_joint4/model.toml")),
    ("panda/joints/panda_joint5/model.toml", include_str!("panda/joints/panda_joint5/model.toml")),
    ("panda/joints/panda_joint6/model.toml", include_str!("panda/joints/panda_joint6/model.toml")),
    ("panda/joints/panda_joint7/model.toml", include_str!("panda/joints/panda_joint7/model.toml")),
    ("so101-rotation/axis.toml", include_str!("so101-rotation/axis.toml")),
    ("so101-rotation/model.toml", include_str!("so101-rotation/model.toml")),
    ("tribometer/axis.toml", include_str!("tribometer/axis.toml")),
    ("tribometer/model.toml", include_str!("tribometer/model.toml")),
    ("ur10/robot.toml", include_str!("ur10/robot.toml")),
    ("ur10/joints/shoulder_pan_joint/model.toml", include_str!("ur10/joints/shoulder_pan_joint/model.toml")),
    ("ur10/joints/shoulder_lift_joint/model.toml", include_str!("ur10/joints/shoulder_lift_joint/model.toml")),
    ("ur10/joints/elbow_joint/model.toml", include_str!("ur10/joints/elbow_joint/model.toml")),
    ("ur10/joints/wrist_1_joint/model.toml", include_str!("ur10/joints/wrist_1_joint/model.toml")),
    ("ur10/joints/wrist_2_joint/model.toml", include_str!("ur10/joints/wrist_2_joint/model.toml")),
    ("ur10/joints/wrist_3_joint/model.toml", include_str!("ur10/joints/wrist_3_joint/model.toml")),
    ("xl330/axis.toml", include_str!("xl330/axis.toml")),
    ("xl330/model.toml", include_str!("xl330/model.toml")),
];
