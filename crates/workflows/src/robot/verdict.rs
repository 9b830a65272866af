//! Whether the model of a robot may be used: pure functions of facts and thresholds.

use stiction_policy::robot;
use stiction_say::OfRobot;

/// What is known of the model of one joint.
#[derive(Clone, Debug)]
pub(super) struct JointFacts {
    /// Its name.
    pub joint: String,
    /// Why its friction could not be fitted, if so.
    pub refused: Option<String>,
    /// Part of its torque that the model leaves on samples that were not fitted.
    pub left: f64,
    /// Whether the search converged.
    pub converged: bool,
}

impl JointFacts {
    /// What speaks against its model.
    pub fn against(&self) -> Option<OfRobot> {
        let joint = self.joint.clone();
        if let Some(why) = self.refused.clone() {
            return Some(OfRobot::NotFitted { joint, why });
        }
        if !self.converged {
            return Some(OfRobot::NotConverged { joint });
        }
        let most = robot::MAX_TORQUE_ERROR;
        let left = self.left;
        (left.is_nan() || left > most).then_some(OfRobot::TorqueLeft { joint, left, most })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_joint_is_refused_for_what_it_leaves_and_for_what_could_not_be_fitted() {
        let sound = JointFacts {
            joint: "elbow".into(),
            refused: None,
            left: 0.1,
            converged: true,
        };
        assert_eq!(sound.against(), None);
        let with = |change: &dyn Fn(&mut JointFacts)| {
            let mut facts = sound.clone();
            change(&mut facts);
            facts.against()
        };
        let left = with(&|facts| facts.left = 0.5);
        assert!(matches!(left, Some(OfRobot::TorqueLeft { left: 0.5, .. })));
        let nothing = with(&|facts| facts.left = f64::NAN);
        assert!(matches!(nothing, Some(OfRobot::TorqueLeft { .. })));
        let open = with(&|facts| facts.converged = false);
        assert!(matches!(open, Some(OfRobot::NotConverged { .. })));
        let refused = with(&|facts| facts.refused = Some("too short".into()));
        assert!(matches!(refused, Some(OfRobot::NotFitted { .. })));
    }
}
