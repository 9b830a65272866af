//! What simulators take of a model, with the ranges and correlations that its file keeps.

use stiction_export::{Domain, Model, Number, Scale};
use stiction_files::ModelFile;
use stiction_files::model::{ModelParameter, square_root};
use stiction_parameters::{Name, Quantity};
use stiction_policy::interval;

/// Half width of a logarithm up to which a number that the force is linear in counts as normal in it.
const MOST_OF_A_LOGARITHM: f64 = 0.5;

/// What a robot file says of a joint beside its model.
pub(super) struct Known {
    /// Inertia of the rotor, kg m² or kg.
    pub armature: f64,
    /// Coulomb and viscous friction, if it has them.
    pub line: Option<[f64; 2]>,
}

/// What a number is drawn with: numbers of one source go together.
#[derive(Clone, Copy, PartialEq)]
enum Source<'a> {
    /// Coulomb or viscous friction of the nearest line.
    Line(usize),
    /// A parameter of the law, or the mass.
    Law(&'a str),
}

/// The numbers of a joint: first those of simulators, then the parameters of its law.
pub(super) fn of(file: &ModelFile, model: &Model, robot: Option<Known>) -> Domain {
    let by_name = |name: &str| file.parameter.iter().find(|p| p.name == name);
    let of_law = |quantity: Quantity| {
        let name = Name::from(quantity).to_string();
        by_name(&name).or_else(|| by_name(&format!("{name}_pos")))
    };
    let mut all: Vec<(Number, Source<'_>)> = Vec::new();
    let mass = by_name("mass").filter(|p| p.value > 0.0);
    match (mass, &robot) {
        // The inertia of one axis holds what it moves.
        (Some(own), None) => all.push((named(own, "inertia", own.value), Source::Law("mass"))),
        (Some(own), Some(known)) => {
            let number = named(own, "armature", known.armature);
            all.push((number, Source::Law("mass")));
        }
        (None, Some(known)) => {
            let unit = if model.rotary { "kg m^2" } else { "kg" };
            let number = plain("armature", unit.into(), known.armature);
            all.push((number, Source::Law("mass")));
        }
        (None, None) => {}
    }
    let line = robot.and_then(|known| known.line);
    let logged = || {
        Some([
            file.line.as_ref()?.coulomb.value,
            file.line.as_ref()?.viscous.value,
        ])
    };
    let logged = || logged().map(|own| own.map(|x| x.max(0.0)));
    let line = line.or_else(logged);
    let nominal = line.unwrap_or_else(|| stiction_export::nearest_line(model));
    let force = file.force_unit.replace(['*', '·'], " ");
    let per_speed = format!("{force} s/{}", if model.rotary { "rad" } else { "m" });
    let known = file.line.as_ref().map(|own| [own.coulomb, own.viscous]);
    for (k, (name, unit, quantity)) in [
        ("frictionloss", force.clone(), Quantity::Coulomb),
        ("damping", per_speed, Quantity::Sigma2),
    ]
    .into_iter()
    .enumerate()
    {
        all.push(match (&known, of_law(quantity)) {
            (Some(known), _) => {
                let half = [Some(known[k].repeat), Some(known[k].transfer)];
                let number = Number {
                    half,
                    is_determined: known[k].repeat <= interval::MAX_HALF_WIDTH * nominal[k],
                    ..plain(name, unit, nominal[k])
                };
                (number, Source::Line(k))
            }
            // Files that were written before the line was kept: as well as the law is known.
            (None, Some(own)) if own.value > 0.0 => {
                (named(own, name, nominal[k]), Source::Law(&own.name))
            }
            _ => (plain(name, unit, nominal[k]), Source::Line(k)),
        });
    }
    let at_rest = stiction_export::static_friction(model).max(nominal[0]);
    let sliding = all.iter().find(|(own, _)| own.name == "frictionloss");
    let (mut number, source) = match (of_law(Quantity::Static), sliding) {
        (Some(own), _) => (
            named(own, "static_friction", at_rest),
            Source::Law(&own.name),
        ),
        (None, Some(sliding)) => sliding.clone(),
        (None, None) => (
            plain("static_friction", force, at_rest),
            Source::Law("static"),
        ),
    };
    number.name = "static_friction".into();
    number.nominal = at_rest;
    all.push((number, source));
    let law = file.parameter.iter().filter(|p| is_of_the_law(p));
    all.extend(law.map(|own| (named(own, &own.name, own.value), Source::Law(&own.name))));
    let (numbers, sources): (Vec<_>, Vec<_>) = all.into_iter().unzip();
    Domain {
        root: root(file, &sources),
        numbers,
    }
}

/// Whether a parameter describes friction, a force beside it or the delay, rather than the mass or a place that others count from.
fn is_of_the_law(p: &ModelParameter) -> bool {
    let name = p.name.parse::<Name>();
    name.is_ok_and(|name| {
        !matches!(
            name.quantity,
            Quantity::Mass
                | Quantity::LoadReference
                | Quantity::TemperatureReference
                | Quantity::PositionReference
                | Quantity::PositionStroke
                | Quantity::TransmittedReference
        )
    })
}

/// A number without ranges.
fn plain(name: &str, unit: String, nominal: f64) -> Number {
    Number {
        name: name.into(),
        unit,
        nominal,
        half: [None; 2],
        scale: Scale::NotNegative,
        is_determined: false,
    }
}

/// A parameter under a name of simulators with a value that may be another one; then its ranges are so much of that one.
fn named(p: &ModelParameter, name: &str, nominal: f64) -> Number {
    let quantity = p.name.parse::<Name>().map(|name| name.quantity);
    let is_positive = quantity
        .as_ref()
        .is_ok_and(|own| own.allowed().is_never_negative());
    let is_log = is_positive && p.value > 0.0;
    // What the force is linear in is normal as it is: in the logarithm the upper tail of a wide interval has many times the value.
    let is_linear = matches!(
        quantity,
        Ok(Quantity::Mass | Quantity::Coulomb | Quantity::Sigma2)
    );
    let bounded = p.ci95.filter(|ends| ends.iter().all(|end| end.is_finite()));
    let repeat = bounded.and_then(|[low, high]| match is_log {
        true if low > 0.0 => Some(0.5 * p.value * libm::log(high / low)),
        true => None,
        false => Some(0.5 * (high - low)),
    });
    let size = if p.value == 0.0 {
        1.0
    } else {
        nominal / p.value
    };
    // What the data bound on no side is not varied.
    let half = [repeat, p.transfer.filter(|_| repeat.is_some())];
    let is_wide = (half.iter().flatten()).any(|half| *half > MOST_OF_A_LOGARITHM * p.value);
    let half = half.map(|half| {
        let scaled = half.map(|half| half * size.abs());
        scaled.filter(|_| nominal != 0.0 || !is_log)
    });
    Number {
        name: name.into(),
        unit: p.unit.replace(['*', '·'], " "),
        nominal,
        half,
        scale: match (is_log && !(is_linear && is_wide), is_positive) {
            (true, _) => Scale::Log,
            (false, true) => Scale::NotNegative,
            (false, false) => Scale::Any,
        },
        is_determined: p.origin == "given" || p.identifiable && half[0].is_some(),
    }
}

/// A square root of the correlations of numbers by their sources.
///
/// The line is known from another fit than the law: the two are independent but for what both have to do with the mass.
fn root(file: &ModelFile, sources: &[Source<'_>]) -> Vec<Vec<f64>> {
    let mut own: Vec<Source<'_>> = Vec::new();
    for source in sources.iter().chain(&[Source::Law("mass")]) {
        if !own.contains(source) {
            own.push(*source);
        }
    }
    let of_both = file.line.as_ref().and_then(|line| line.correlation);
    let with_mass = file.line.as_ref().and_then(|l| l.correlation_with_mass);
    let with_mass = with_mass.unwrap_or([0.0; 2]);
    let of = |a: Source<'_>, b: Source<'_>| match (a, b) {
        _ if a == b => 1.0,
        (Source::Line(_), Source::Line(_)) => of_both.unwrap_or(0.0),
        (Source::Line(k), Source::Law(name)) | (Source::Law(name), Source::Line(k)) => {
            with_mass[k] * correlation(file, "mass", name)
        }
        (Source::Law(a), Source::Law(b)) => correlation(file, a, b),
    };
    let matrix: Vec<Vec<f64>> = (own.iter())
        .map(|a| own.iter().map(|b| of(*a, *b)).collect())
        .collect();
    let independent = || {
        let one = |i: usize| (0..own.len()).map(move |j| f64::from(u8::from(i == j)));
        (0..own.len()).map(|i| one(i).collect()).collect()
    };
    let rows: Vec<Vec<f64>> = square_root(&matrix).unwrap_or_else(|_| independent());
    let place = |source: &Source<'_>| own.iter().position(|other| other == source);
    let rows = sources
        .iter()
        .map(|source| place(source).map_or(Vec::new(), |at| rows[at].clone()));
    rows.collect()
}

/// Correlation of two parameters; 0 where the file does not know it.
fn correlation(file: &ModelFile, a: &str, b: &str) -> f64 {
    if a == b {
        return 1.0;
    }
    let covariance = &file.covariance;
    let place = |name: &str| covariance.names.iter().position(|own| own == name);
    let (Some(i), Some(j)) = (place(a), place(b)) else {
        return 0.0;
    };
    let m = &covariance.matrix;
    let found = m[i][j] / libm::sqrt(m[i][i] * m[j][j]);
    if found.is_finite() {
        found.clamp(-1.0, 1.0)
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use crate::export::{Draws, Error, ExportOptions, File, Target, Width, export};
    use stiction_files::ModelFile;

    /// An axis whose line and mass go together, as an identification writes it.
    const MODEL: &str = "schema = \"stiction.model/1\"\nkind = \"rotary\"\nlaw = \"coulomb-viscous\"\nforce_unit = \"N*m\"\n\
        [line]\nviscous_unit = \"N*m*s/rad\"\ncorrelation = -0.6\ncorrelation_with_mass = [0.5, 0.0]\n\
        [line.coulomb]\nvalue = 8.0\nat_once = 0.1\nrepeat = 0.4\ntransfer = 0.8\n\
        [line.viscous]\nvalue = 1.5\nat_once = 0.1\nrepeat = 0.2\ntransfer = 0.3\n\
        [[parameter]]\nname = \"coulomb\"\nvalue = 8.0\nunit = \"N*m\"\nstd = 0.2\nci95 = [7.6, 8.42105]\ntransfer = 1.0\n\
        [[parameter]]\nname = \"sigma2\"\nvalue = 1.5\nunit = \"N*m*s/rad\"\nstd = 0.1\nci95 = [1.3, 1.7]\n\
        [[parameter]]\nname = \"mass\"\nvalue = 0.2\nunit = \"kg*m^2\"\nstd = 0.01\nci95 = [0.18, 0.222]\n\
        [covariance]\nnames = [\"coulomb\", \"mass\"]\nmatrix = [[0.04, 0.001], [0.001, 0.0001]]\n";

    fn text(model: &str, count: Option<usize>) -> Result<String, Error> {
        let model = ModelFile::parse(model).unwrap();
        let mut options = ExportOptions::new(Target::DomainJson, 1e-3);
        options.draws = count.map(|count| Draws {
            count,
            seed: 0,
            width: Width::Transfer,
        });
        let files: Vec<File> = export(&model, &options)?.files;
        Ok(String::from_utf8(files[0].bytes.clone()).unwrap())
    }

    #[test]
    fn ranges_and_correlations_are_those_of_the_file() {
        let found: serde_json::Value =
            serde_json::from_str(&text(MODEL, Some(4)).unwrap()).unwrap();
        let joint = &found["joints"][0];
        let of = |name: &str| joint["numbers"][name].clone();
        assert_eq!(
            of("frictionloss")["repeatability"],
            serde_json::json!([7.6, 8.4])
        );
        assert_eq!(
            of("frictionloss")["transfer"],
            serde_json::json!([7.2, 8.8])
        );
        // e^(1/8) to each side.
        assert_eq!(
            of("coulomb")["transfer"],
            serde_json::json!([7.05998, 9.06519])
        );
        // A file without it.
        assert_eq!(of("sigma2")["transfer"], serde_json::Value::Null);
        assert_eq!(of("inertia")["unit"], "kg m^2");
        let names: Vec<&str> = (joint["correlation"]["names"].as_array().unwrap().iter())
            .map(|name| name.as_str().unwrap())
            .collect();
        let between = |a: &str, b: &str| {
            let [i, j] = [a, b].map(|own| names.iter().position(|name| *name == own).unwrap());
            joint["correlation"]["matrix"][i][j].as_f64().unwrap()
        };
        assert_eq!(between("frictionloss", "damping"), -0.6);
        assert_eq!(between("frictionloss", "static_friction"), 1.0);
        assert_eq!(between("coulomb", "inertia"), 0.5);
        assert_eq!(between("frictionloss", "inertia"), 0.5);
        // By way of the mass.
        assert_eq!(between("frictionloss", "coulomb"), 0.25);
        assert_eq!(between("sigma2", "coulomb"), 0.0);
        assert_eq!(
            found["draws"]["joints"]["axis_joint"]["sigma2"]
                .as_array()
                .unwrap()
                .len(),
            4
        );
    }

    /// What is hardly known is not many times itself in a draw.
    #[test]
    fn a_wide_range_ends_at_nothing() {
        let wide = MODEL.replace("ci95 = [0.18, 0.222]", "ci95 = [0.02, 2.0]\ntransfer = 0.6");
        let found: serde_json::Value =
            serde_json::from_str(&text(&wide, Some(1000)).unwrap()).unwrap();
        let own = &found["joints"][0]["numbers"]["inertia"];
        assert_eq!(own["repeatability"], serde_json::json!([0.0, 0.660517]));
        assert_eq!(own["transfer"], serde_json::json!([0.0, 0.8]));
        let drawn = &found["draws"]["joints"]["axis_joint"]["inertia"];
        let drawn: Vec<f64> = serde_json::from_value(drawn.clone()).unwrap();
        // Three deviations of the transfer, .6/1.96.
        assert!(drawn.iter().all(|x| (0.0..=0.2 + 0.9184).contains(x)));
        assert!(drawn.iter().any(|x| *x > 0.8));
    }

    /// Files that were written before have the intervals of the law alone, and those by hand none.
    #[test]
    fn older_files_are_read() {
        let (head, rest) = MODEL.split_once("[line]").unwrap();
        let law = rest.split_once("[[parameter]]").unwrap().1;
        let older = format!("{head}[[parameter]]{law}").replace("transfer = 1.0\n", "");
        let found: serde_json::Value =
            serde_json::from_str(&text(&older, Some(4)).unwrap()).unwrap();
        let own = &found["joints"][0]["numbers"]["frictionloss"];
        assert_eq!(own["repeatability"], serde_json::json!([7.6, 8.42105]));
        assert_eq!(own["transfer"], serde_json::Value::Null);
        let drawn = &found["draws"]["joints"]["axis_joint"];
        assert_eq!(drawn["frictionloss"], drawn["coulomb"]);
    }

    #[test]
    fn draws_are_bounded() {
        let said = |count| text(MODEL, Some(count)).unwrap_err().to_string();
        for count in [0, 100_001] {
            assert!(said(count).contains("from 1 to 100000"), "{}", said(count));
        }
        let mut options = ExportOptions::new(Target::C, 1e-3);
        options.draws = Some(Draws {
            count: 1,
            seed: 0,
            width: Width::Repeatability,
        });
        let model = ModelFile::parse(MODEL).unwrap();
        let said = export(&model, &options).unwrap_err().to_string();
        assert!(said.contains("draws for the target c"), "{said}");
    }
}
