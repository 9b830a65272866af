//! The least force that the data support: what a compensator is made of where a log leaves parameters open.

use super::form::{ModelFile, ModelParameter};
use stiction_parameters::{Name, ParameterSet, Quantity};

/// A parameter of which less is used than was identified.
#[derive(Clone, Debug, PartialEq)]
pub struct Lowered {
    /// Which one.
    pub name: Name,
    /// Its identified value, SI.
    pub from: f64,
    /// What is used, SI.
    pub to: f64,
    /// Its SI unit.
    pub unit: String,
}

impl ModelFile {
    /// The parameters with the least force that the data support, and what is lower than identified. A parameter that the
    /// data bound on no side, or from below alone, takes that bound; without one static friction is the Coulomb level, and
    /// damping, viscous friction and offset are zero. A Stribeck velocity without a bound makes static friction the Coulomb
    /// level; stiffness and break-away without one stay. A softer Maxwell-slip element yields at the
    /// same force, so later. `None` for a law of no known name.
    ///
    /// A wide interval does not lower a value: it may be wide because something beside the law is not constant, and held-out
    /// samples have judged the law with its values.
    pub fn supported(&self) -> Option<(ParameterSet, Vec<Lowered>)> {
        let mut values = self.values()?;
        let identified = values.clone();
        let open = self.parameter.iter().filter(|p| is_open(p));
        let open: Vec<(&ModelParameter, Name)> = open
            .filter_map(|p| Some((p, p.name.parse::<Name>().ok()?)))
            .collect();
        for (p, name) in &open {
            let least = least(p);
            let level = Name {
                quantity: Quantity::Coulomb,
                ..*name
            };
            let level = values.get(level).unwrap_or(0.0);
            match name.quantity {
                Quantity::Static => values.insert(*name, least.max(level).min(p.value)),
                Quantity::StribeckVelocity if least > 0.0 => values.insert(*name, least),
                Quantity::StribeckVelocity => {
                    let rise = Name {
                        quantity: Quantity::Static,
                        ..*name
                    };
                    if values.get(rise).is_some() {
                        values.insert(rise, level);
                    }
                }
                Quantity::Sigma0 | Quantity::BreakawayRatio if least > 0.0 => {
                    values.insert(*name, least);
                }
                Quantity::ElementStiffness(k) if least > 0.0 => {
                    values.insert(*name, least);
                    // Softer with the same yield force, so later to yield.
                    let deflection = Quantity::ElementYield(k);
                    if let Some(from) = values.get(deflection) {
                        values.insert(deflection, from * (p.value / least));
                    }
                }
                Quantity::Sigma1 | Quantity::Sigma2 => values.insert(*name, least),
                Quantity::Offset => values.insert(*name, 0.0),
                _ => {}
            }
        }
        let lowered = identified.iter().filter_map(|(name, from)| {
            let to = values.get(name).filter(|to| *to != from)?;
            let p = self.parameter.iter().find(|p| p.name == name.to_string())?;
            Some(Lowered {
                name,
                from,
                to,
                unit: p.unit.clone(),
            })
        });
        let lowered = lowered.collect();
        Some((values, lowered))
    }

    /// Whether the data leave a parameter open.
    pub fn leaves_open(&self, name: Name) -> bool {
        let name = name.to_string();
        self.parameter.iter().any(|p| p.name == name && is_open(p))
    }
}

/// Whether the data bound a parameter on no side, or on one only.
fn is_open(p: &ModelParameter) -> bool {
    let bounded = p
        .ci95
        .is_some_and(|ends| ends.iter().all(|x| x.is_finite()));
    p.origin != "given" && !p.identifiable && !bounded
}

/// The bound of a parameter from below, if that is above 0; else 0.
fn least(p: &ModelParameter) -> f64 {
    let low = p.ci95.map(|[low, _]| low).filter(|low| low.is_finite());
    low.unwrap_or(0.0).clamp(0.0, p.value.max(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use stiction_parameters::Side;

    fn model(parameters: &[(&str, f64, Option<[f64; 2]>, bool)]) -> ModelFile {
        let parameters =
            parameters
                .iter()
                .map(|(name, value, ci95, identifiable)| ModelParameter {
                    name: (*name).into(),
                    value: *value,
                    ci95: *ci95,
                    identifiable: *identifiable,
                    origin: "identified".into(),
                    ..ModelParameter::default()
                });
        ModelFile {
            law: "lugre".into(),
            parameter: parameters.collect(),
            ..ModelFile::default()
        }
    }

    /// What has an interval stays; what is open makes as little force as it may.
    #[test]
    fn what_is_open_makes_no_force() {
        let file = model(&[
            ("sigma0", 1e5, Some([2e4, f64::INFINITY]), false),
            ("sigma1", 300.0, None, false),
            ("sigma2", 5.0, Some([4.0, 6.0]), false),
            ("coulomb", 10.0, Some([9.9, 10.1]), true),
            ("static", 40.0, None, false),
            ("stribeck_velocity", 0.01, Some([0.007, 0.014]), false),
            ("offset", 1.0, None, false),
        ]);
        let (values, lowered) = file.supported().unwrap();
        let value = |quantity: Quantity| values.get(quantity).unwrap();
        assert_eq!(value(Quantity::Sigma0), 2e4);
        assert_eq!(value(Quantity::Sigma1), 0.0);
        assert_eq!(value(Quantity::Sigma2), 5.0);
        assert_eq!(value(Quantity::Coulomb), 10.0);
        assert_eq!(value(Quantity::Static), 10.0);
        assert_eq!(value(Quantity::StribeckVelocity), 0.01);
        assert_eq!(value(Quantity::Offset), 0.0);
        let names: Vec<String> = lowered.iter().map(|l| l.name.to_string()).collect();
        assert_eq!(names, ["sigma0", "sigma1", "static", "offset"]);
    }

    /// An element that may be softer is, and yields at the same force; a bristle may creep earlier.
    #[test]
    fn elements_and_break_away_are_lowered() {
        let mut file = model(&[
            ("coulomb", 10.0, Some([9.9, 10.1]), true),
            ("stiffness_1", 1e6, Some([2.5e5, f64::INFINITY]), false),
            ("stiffness_2", 1e5, Some([9e4, 1.1e5]), true),
            ("yield_1", 5e-6, None, false),
            ("yield_2", 5e-5, None, true),
        ]);
        file.law = "maxwell-slip".into();
        let (values, lowered) = file.supported().unwrap();
        assert_eq!(values.get(Quantity::ElementStiffness(1)), Some(2.5e5));
        assert_eq!(values.get(Quantity::ElementYield(1)), Some(2e-5));
        assert_eq!(values.get(Quantity::ElementYield(2)), Some(5e-5));
        assert_eq!(lowered.len(), 2);
        let mut file = model(&[("breakaway_ratio", 0.7, Some([0.4, f64::INFINITY]), false)]);
        file.law = "elasto-plastic".into();
        let (values, _) = file.supported().unwrap();
        assert_eq!(values.get(Quantity::BreakawayRatio), Some(0.4));
    }

    /// Each direction has its own level; a Stribeck velocity that may be nothing takes static friction with it.
    #[test]
    fn directions_are_lowered_each_for_itself() {
        let file = model(&[
            ("sigma0", 1e5, Some([9e4, 1.1e5]), true),
            ("sigma1", 300.0, Some([290.0, 310.0]), true),
            ("coulomb_pos", 10.0, Some([9.9, 10.1]), true),
            ("coulomb_neg", 12.0, Some([11.9, 12.1]), true),
            ("static_pos", 40.0, Some([11.0, f64::INFINITY]), false),
            ("static_neg", 15.0, Some([14.0, 16.0]), true),
            ("stribeck_velocity_pos", 0.01, Some([0.009, 0.011]), true),
            ("stribeck_velocity_neg", 0.01, None, false),
        ]);
        let (values, _) = file.supported().unwrap();
        let fs = |side| values.on(Quantity::Static, side).unwrap();
        assert_eq!(fs(Side::Positive), 11.0);
        assert_eq!(fs(Side::Negative), 12.0);
    }

    #[test]
    fn a_model_that_is_known_stays() {
        let mut file = model(&[
            ("coulomb", 10.0, None, false),
            ("static", 40.0, Some([39.0, 41.0]), true),
        ]);
        file.parameter[0].origin = "given".into();
        let (values, lowered) = file.supported().unwrap();
        assert_eq!(values.get(Quantity::Static), Some(40.0));
        assert!(lowered.is_empty());
    }
}
