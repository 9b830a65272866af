//! Names of joints in code.

use crate::identifier::identifier;

/// Identifiers of the joints of a robot: distinct for C, which has more than one name from each, also where letters differ in case
/// only. They begin with that of the robot.
///
/// ```
/// use stiction_export::joint_identifiers;
/// let names = joint_identifiers("arm", &["elbow", "Elbow", "arm_wrist"]);
/// assert_eq!(names, ["arm_elbow", "arm_Elbow_2", "arm_wrist"]);
/// ```
pub fn joint_identifiers(robot: &str, joints: &[&str]) -> Vec<String> {
    let single = |name: &str| format!("{name}_f32");
    let whole = format!("{robot}_robot").to_ascii_lowercase();
    let mut taken = vec![single(&whole), whole];
    let mut out = Vec::with_capacity(joints.len());
    for joint in joints {
        let begins = joint.get(..robot.len()).is_some_and(|head| head == robot)
            && joint[robot.len()..].starts_with('_');
        let name = if begins {
            joint.to_string()
        } else {
            format!("{robot}_{joint}")
        };
        let mut found = identifier(&name);
        let is_taken = |found: &str, taken: &[String]| {
            let own = found.to_ascii_lowercase();
            taken.contains(&single(&own)) || taken.contains(&own)
        };
        let mut number = 2_usize;
        while is_taken(&found, &taken) {
            found = identifier(&format!("{name} {number}"));
            number += 1;
        }
        let own = found.to_ascii_lowercase();
        taken.extend([single(&own), own]);
        out.push(found);
    }
    out
}
