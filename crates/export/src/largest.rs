//! The largest force that code with terms beside the law may ask for at a speed.

use crate::Model;
use crate::model::ALMOST_STANDSTILL;
use stiction_friction::compensator::Channel;

impl Model {
    /// With a share `gain` of the friction, in the direction that needs more, wherever in their ranges load, temperature and
    /// position are, or more: all that adds up at once. What the mass needs depends on the acceleration, and is not in it.
    pub(crate) fn largest(&self, gain: f64, speed: f64) -> f64 {
        let levels = self.terms.levels.unwrap_or_default();
        let factor = levels.largest(&self.terms.channels);
        let warmest = reach(&self.terms.channels.temperature);
        let (offset, viscous) = (self.friction.offset(), self.friction.viscous());
        let of = |side: usize| {
            let sign = [1.0, -1.0][side];
            let steady = self.steady_of_law(sign * speed.max(ALMOST_STANDSTILL)) - offset;
            let dry = sign * steady - viscous[side] * speed;
            let viscous = viscous[side] + levels.viscous[side].abs() * warmest;
            let bent = (levels.quadratic[side] * speed.min(levels.top_speed)).max(0.0);
            let viscous = viscous + bent;
            dry * factor + viscous * speed
        };
        gain * (of(0).max(of(1)) + offset.abs()) + self.terms.largest_beside()
    }

    /// What is in [`Model::largest`], in words.
    pub(crate) fn what_is_largest(&self) -> String {
        let weight = self.terms.weight.map(|_| "weight");
        let cogging = (self.terms.cogging[0].rate > 0.0).then_some("cogging");
        let all: Vec<&str> = ["friction"]
            .into_iter()
            .chain(weight)
            .chain(cogging)
            .collect();
        match all.split_last() {
            Some((last, [])) => (*last).into(),
            Some((last, before)) => format!("{} and {last}", before.join(", ")),
            None => String::new(),
        }
    }
}

/// Farthest way of a channel from its reference.
fn reach(channel: &Channel<f64>) -> f64 {
    let [low, high] = channel.range;
    (high - channel.reference).max(channel.reference - low)
}
