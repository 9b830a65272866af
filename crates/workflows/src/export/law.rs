//! The law of a model file as the code has it.

use stiction_export::Target;
use stiction_files::ModelFile;
use stiction_files::model::Lowered;
use stiction_friction::ParamError;
use stiction_friction::compensator::{Channels, Friction, Levels, Terms};
use stiction_parameters::{FrictionLaw, LawError, Name, ParameterSet, Quantity, Side};

/// Why no law that can be exported follows from the numbers of a model.
pub(super) enum Unfit {
    Law,
    Missing(Name),
    Value(ParamError),
}

impl From<LawError> for Unfit {
    fn from(e: LawError) -> Self {
        match e {
            LawError::Missing { name, .. } => Unfit::Missing(name),
            LawError::NotLuGre { .. } => Unfit::Law,
            LawError::Value(e) => Unfit::Value(e),
        }
    }
}

/// The law as it was identified, sigma1 constant: the export caps it, and warns where that counts.
pub(super) fn friction(
    file: &ModelFile,
    cycle_time: f64,
) -> Result<(Friction<f64>, Vec<Lowered>), Unfit> {
    let (mut values, mut lowered) = file.supported().ok_or(Unfit::Law)?;
    if let Some(stiffness) = resolved(file, &mut values, cycle_time) {
        // Of one that was lowered before, this is the lower value.
        lowered.retain(|l| l.name != stiffness.name);
        lowered.push(stiffness);
    }
    let friction = match values.law()? {
        FrictionLaw::CoulombViscous(law) => Friction::Coulomb(law),
        FrictionLaw::Stribeck(curve) => Friction::Stribeck(curve),
        FrictionLaw::LuGre(law) => Friction::LuGre(law),
        FrictionLaw::ElastoPlastic(law) => Friction::ElastoPlastic(law),
        FrictionLaw::MaxwellSlip(law) => Friction::Gms(law),
    };
    Ok((friction, lowered))
}

/// A stiffness that the data leave open is no stiffer than a cycle resolves: at the Stribeck velocity the presliding length is
/// passed in one.
fn resolved(file: &ModelFile, values: &mut ParameterSet, cycle_time: f64) -> Option<Lowered> {
    let from = values.get(Quantity::Sigma0)?;
    let speed = values.on(Quantity::StribeckVelocity, Side::Positive)?;
    let level = values.on(Quantity::Coulomb, Side::Positive)?;
    let to = level / (speed * cycle_time);
    let name = Name::from(Quantity::Sigma0);
    if !(file.leaves_open(name) && to > 0.0 && to < from) {
        return None;
    }
    values.insert(name, to);
    let p = file.parameter.iter().find(|p| p.name == name.to_string())?;
    Some(Lowered {
        name,
        from: p.value,
        to,
        unit: p.unit.clone(),
    })
}

/// Quadratic viscous friction of what holds the steady force and nothing else: tables, and joints with two numbers of it. For BAM
/// also what the level grows by with the transmitted torque.
pub(super) fn bent(file: &ModelFile, friction: &Friction<f64>, target: Target) -> Terms<f64> {
    let steady = !matches!(target, Target::Mujoco | Target::Modelica);
    let known = file.dependences(friction.coulomb());
    let loaded = target == Target::Bam;
    let share = |sides: [f64; 2]| if loaded { sides } else { [0.0; 2] };
    let levels = known.levels.map(|l| Levels {
        quadratic: l.quadratic,
        top_speed: l.top_speed,
        transmitted: share(l.transmitted),
        driven: share(l.driven),
        ..Levels::default()
    });
    let channels = Channels {
        transmitted: known.channels.transmitted,
        ..Channels::default()
    };
    Terms {
        channels: if loaded {
            channels
        } else {
            Channels::default()
        },
        levels: levels.filter(|l| steady && *l != Levels::default()),
        ..Terms::default()
    }
}

/// The parameters of quadratic viscous friction.
pub(super) fn quadratic(file: &ModelFile) -> impl Iterator<Item = String> + '_ {
    parameters(file, |quantity| quantity == Quantity::QuadraticViscous)
}

/// Those with which friction grows with the transmitted torque.
pub(super) fn of_the_transmitted(file: &ModelFile) -> impl Iterator<Item = String> + '_ {
    parameters(file, |quantity| {
        matches!(
            quantity,
            Quantity::CoulombTransmitted | Quantity::CoulombDriven
        )
    })
}

fn parameters(file: &ModelFile, is: fn(Quantity) -> bool) -> impl Iterator<Item = String> + '_ {
    let names = file.parameter.iter().map(|p| &p.name);
    names
        .filter(move |name| name.parse().is_ok_and(|name: Name| is(name.quantity)))
        .cloned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use stiction_friction::{Damping, Shape};

    /// A study and an export use the same law for the same model, whatever its Stribeck exponent; the only difference
    /// is that sigma1 is capped where the axis is simulated.
    #[test]
    fn a_study_and_an_export_have_one_law() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("model.toml");
        for (exponent, shape) in [
            (1.0, Shape::Exponential),
            (1.3, Shape::Power(1.3)),
            (2.0, Shape::Gaussian),
        ] {
            let mut text = String::from(
                "schema = \"stiction.model/1\"\nkind = \"linear\"\nlaw = \"lugre\"\nasymmetric = true\n\
                 force_unit = \"N\"\ntrustworthy = true\n[source]\nversion = \"0\"\nmethod = \"separable\"\n\
                 seed = 0\ninputs = []\n",
            );
            for (name, value, unit) in [
                ("sigma0", 2e6, "N/m"),
                ("sigma1", 1500.0, "N*s/m"),
                ("sigma2", 30.0, "N*s/m"),
                ("coulomb_pos", 12.0, "N"),
                ("coulomb_neg", 13.0, "N"),
                ("static", 18.0, "N"),
                ("stribeck_velocity", 3e-3, "m/s"),
                ("stribeck_exponent", exponent, "1"),
                ("offset", -1.0, "N"),
                ("mass", 4.6, "kg"),
            ] {
                text += &format!(
                    "[[parameter]]\nname = \"{name}\"\nsymbol = \"\"\nvalue = {value:?}\nunit = \"{unit}\"\n\
                     identifiable = true\norigin = \"identified\"\n"
                );
            }
            text += "[covariance]\nnames = []\nmatrix = []\n";
            std::fs::write(&path, &text).unwrap();
            let file = ModelFile::read(&path).unwrap();
            let Ok((Friction::LuGre(exported), _)) = friction(&file, 1e-3) else {
                panic!("no law is exported");
            };
            assert_eq!(exported.curve().shape(), shape);
            assert_eq!(exported.curve().negative().coulomb, 13.0);
            assert_eq!(exported.damping(), Damping::Constant(1500.0));
            let study = stiction_files::study::Model::read(&path).unwrap();
            assert_eq!(study.values().lugre().unwrap(), exported);
        }
    }
}
