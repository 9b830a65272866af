//! What `model.toml` carries for a later study to draw from: every fitted parameter, its interval, and
//! a covariance that comes back bit for bit and is one.

use crate::common::{Bench, both_ways, friction, noise, options};
use stiction_files::ModelFile;
use stiction_files::result::{CovarianceEntry, Origin};
use stiction_identify::Silent;
use stiction_parameters::LawKind;
use stiction_workflows::identify::Outcome;

fn stribeck(bench: &Bench, axis: &str, asymmetric: bool) -> Outcome {
    // A Stribeck curve of 8 N and 30 mm/s with exponent 1.4 on top of the friction of the other tests.
    let log = bench.log(
        "curve.csv",
        6000,
        |t| both_ways(t)[0],
        |i, t| {
            let [x, v, a] = both_ways(t);
            let curve = 8.0 * v.signum() * (-(v.abs() / 0.03).powf(1.4)).exp();
            friction([x, v, a]) + curve + 0.3 * noise(5, i)
        },
    );
    let mut options = options(&[&log], LawKind::Stribeck);
    options.asymmetric = asymmetric;
    options.files.axis = Some(bench.write("axis.toml", axis));
    options.identify(&mut Silent).unwrap()
}

/// Whether a symmetric matrix has no negative eigenvalue, up to rounding: Cholesky of its correlation
/// with 1e-9 on the diagonal.
fn is_covariance(matrix: &[Vec<f64>]) -> bool {
    let n = matrix.len();
    let size: Vec<f64> = (0..n)
        .map(|i| matrix[i][i].sqrt())
        .map(|s| if s > 0.0 { s } else { 1.0 })
        .collect();
    let mut lower = vec![vec![0.0; n]; n];
    for i in 0..n {
        for j in 0..=i {
            let scaled = matrix[i][j] / (size[i] * size[j]);
            if (matrix[i][j] - matrix[j][i]).abs() > 1e-9 * size[i] * size[j] {
                return false;
            }
            let lift = if i == j { 1e-9 } else { 0.0 };
            let sum: f64 = (0..j).map(|k| lower[i][k] * lower[j][k]).sum();
            let left = scaled + lift - sum;
            if i == j {
                if left < 0.0 {
                    return false;
                }
                lower[i][i] = left.sqrt();
            } else {
                lower[i][j] = left / lower[j][j];
            }
        }
    }
    true
}

#[test]
fn the_covariance_is_complete_and_comes_back() {
    for (axis, asymmetric) in [
        ("[terms]\nstribeck_exponent = \"fit\"\n", false),
        ("[terms]\nstribeck_exponent = \"fit\"\n", true),
        ("mass = \"9 kg\"\n", true),
    ] {
        let bench = Bench::new();
        let outcome = stribeck(&bench, axis, asymmetric);
        let model = ModelFile::from_result(&outcome.result);
        let back = ModelFile::parse(&model.to_toml()).unwrap();
        assert_eq!(back, model);
        let bits = |m: &ModelFile| -> Vec<u64> {
            let rows = m.covariance.matrix.iter().flatten();
            rows.map(|x| x.to_bits()).collect()
        };
        assert_eq!(bits(&back), bits(&model));

        let fitted: Vec<&str> = back
            .parameter
            .iter()
            .filter(|p| p.origin == "identified")
            .map(|p| p.name.as_str())
            .collect();
        assert_eq!(back.covariance.names, fitted);
        assert_eq!(back.covariance.matrix.len(), fitted.len());
        let exponent = fitted.contains(&"stribeck_exponent");
        assert_eq!(exponent, axis.contains("fit"));
        assert_eq!(fitted.contains(&"stribeck_velocity_neg"), asymmetric);
        for (p, (i, row)) in back
            .parameter
            .iter()
            .filter(|p| p.origin == "identified")
            .zip(back.covariance.matrix.iter().enumerate())
        {
            if let Some(std) = p.std {
                assert!((row[i].sqrt() / std - 1.0).abs() < 1e-12, "{}", p.name);
                assert!(p.interval.is_some() || p.ci95.is_none(), "{}", p.name);
            }
        }
        assert!(is_covariance(&back.covariance.matrix), "{fitted:?}");
    }
}

/// An interval that is open to one side is `null` there in JSON and infinite in TOML, and both are
/// read back.
#[test]
fn an_open_interval_is_written_and_read() {
    let bench = Bench::new();
    let mut result = stribeck(&bench, "", false).result;
    let open = result
        .parameters
        .iter_mut()
        .find(|p| p.name == "stribeck_velocity")
        .unwrap();
    open.ci95 = Some([None, Some(0.5)]);
    let json = serde_json::to_string(&result).unwrap();
    assert!(json.contains("\"ci95\":[null,0.5]"));
    let back: stiction_files::result::ResultFile = serde_json::from_str(&json).unwrap();
    assert_eq!(back, result);
    let model = ModelFile::from_result(&result);
    let text = model.to_toml();
    assert!(text.contains("ci95 = [-inf, 0.5]"), "{text}");
    assert_eq!(ModelFile::parse(&text).unwrap(), model);
}

/// The exponent of the log comes out of the whole workflow, with the other parameters of the curve.
#[test]
fn a_fitted_exponent_is_that_of_the_log() {
    let bench = Bench::new();
    let outcome = stribeck(&bench, "[terms]\nstribeck_exponent = \"fit\"\n", false);
    let p = outcome
        .result
        .parameters
        .iter()
        .find(|p| p.name == "stribeck_exponent")
        .unwrap();
    assert_eq!(p.origin, Origin::Identified);
    let (low, high) = p.range().unwrap();
    assert!(low < 1.4 && 1.4 < high, "{} in {low} .. {high}", p.value);
}

/// A model that was edited by hand: what no longer fits its law is named, whoever reads it.
#[test]
fn what_is_refused_of_an_edited_model() {
    let bench = Bench::new();
    let mut good = ModelFile::from_result(&stribeck(&bench, "", false).result);
    good.law = "lugre".into();
    for (name, unit, value) in [("sigma0", "N/m", 1e5), ("sigma1", "N*s/m", 300.0)] {
        let mut parameter = good.parameter[0].clone();
        (parameter.name, parameter.unit) = (name.into(), unit.into());
        parameter.value = value;
        (parameter.std, parameter.ci95, parameter.interval) = (None, None, None);
        good.parameter.push(parameter);
    }
    let read = |model: &ModelFile| ModelFile::parse(&model.to_toml());
    assert_eq!(read(&good).unwrap(), good);
    // Another spelling of the same unit is no fault.
    let mut spelt = good.clone();
    spelt.parameter.last_mut().unwrap().unit = "N s/m".into();
    assert_eq!(read(&spelt).unwrap(), spelt);

    let mut said = String::new();
    let mut refused = |what: &str, model: &ModelFile| {
        let error = read(model).expect_err(what);
        assert_eq!(error.code().as_str(), "bad-config");
        said.push_str(&format!("{what}: {error}\n"));
    };
    for (name, value) in [
        ("sigma0", 1e-300),
        ("sigma0", -1.0),
        ("coulomb", 1e300),
        ("coulomb", -1.0),
        ("static", f64::NAN),
        ("stribeck_velocity", 0.0),
        ("stribeck_exponent", 0.0),
        ("stribeck_exponent", 1e300),
        ("mass", f64::INFINITY),
    ] {
        let mut model = good.clone();
        let parameter = model.parameter.iter_mut().find(|p| p.name == name);
        parameter.unwrap().value = value;
        refused(&format!("{name} {value:e}"), &model);
    }
    for (name, unit) in [("coulomb", "kN"), ("sigma0", "N"), ("mass", "kg*m^2")] {
        let mut model = good.clone();
        let parameter = model.parameter.iter_mut().find(|p| p.name == name);
        parameter.unwrap().unit = unit.into();
        refused(&format!("{name} in {unit}"), &model);
    }
    // It goes into the text of every program that is exported.
    for unit in [
        "",
        "N\"; remove(\"/\"); //",
        "{1}",
        "%s",
        "%",
        "kN",
        "N\n",
        "]]>",
        " N",
        &"N*".repeat(900),
    ] {
        let mut model = good.clone();
        model.force_unit = unit.into();
        refused(
            &format!("force unit {:?}", &unit[..unit.len().min(20)]),
            &model,
        );
    }
    // It stands in titles and in the comments of programs.
    for name in [
        "an axis\nof two lines",
        "\u{1b}[2J",
        &"long ".repeat(100_000),
    ] {
        let mut model = good.clone();
        model.name = Some(name.into());
        refused(&format!("name {:?}", &name[..name.len().min(20)]), &model);
    }
    for (ends, std) in [
        ([f64::NAN, 1.0], 1.0),
        ([2.0, 1.0], 1.0),
        ([0.0, f64::INFINITY], -1.0),
        ([0.0, f64::INFINITY], f64::INFINITY),
    ] {
        let mut model = good.clone();
        (model.parameter[0].ci95, model.parameter[0].std) = (Some(ends), Some(std));
        refused(&format!("interval {ends:?}, std {std}"), &model);
    }
    for law in ["dahl", "gms", "coulomb-viscous", "coulomb"] {
        let mut model = good.clone();
        model.law = law.into();
        refused(law, &model);
    }
    let mut model = good.clone();
    model.asymmetric = true;
    refused("asymmetric", &model);
    for side in ["_pos", "_neg"] {
        let mut parameter = model
            .parameter
            .iter()
            .find(|p| p.name == "coulomb")
            .cloned();
        parameter.as_mut().unwrap().name += side;
        model.parameter.extend(parameter);
    }
    model.parameter.retain(|p| p.name != "coulomb");
    refused("a name of before", &model);
    for name in &mut model.covariance.names {
        if name == "coulomb" {
            *name += "_pos";
        }
    }
    assert_eq!(read(&model).unwrap(), model);
    model.asymmetric = false;
    refused("not asymmetric", &model);
    let mut model = good.clone();
    model.parameter.last_mut().unwrap().name = "sigma2_pos".into();
    refused("one side", &model);
    for (from, to) in [
        ("sigma1", "sigma1_pos"),
        ("stribeck_exponent", "stribeck_exponent_pos"),
        ("stribeck_exponent", "stribeck_exponant"),
        ("stribeck_exponent", "stiffness_one"),
    ] {
        let mut model = good.clone();
        let parameter = model.parameter.iter_mut().find(|p| p.name == from);
        parameter.unwrap().name = to.into();
        refused(to, &model);
    }
    // Terms beside the law, in their units.
    let mut model = good.clone();
    for (name, unit) in [
        ("cogging2_cos", "N"),
        ("quadratic_viscous", "N*s^2/m^2"),
        ("coulomb_pitch1_sin", "N"),
    ] {
        let mut parameter = good.parameter[0].clone();
        (parameter.name, parameter.unit) = (name.into(), unit.into());
        model.parameter.push(parameter);
    }
    assert_eq!(read(&model).unwrap(), model);
    type Edit = fn(&mut CovarianceEntry);
    let edits: [(&str, Edit); 7] = [
        ("no number", |c| {
            (c.matrix[0][1], c.matrix[1][0]) = (f64::NAN, f64::NAN)
        }),
        ("one no number", |c| c.matrix[1][0] = f64::INFINITY),
        ("two halves", |c| c.matrix[1][0] *= 1.0 + 1e-3),
        ("infinite", |c| c.matrix[0][0] = f64::INFINITY),
        ("negative", |c| c.matrix[0][0] = -1.0),
        ("unknown", |c| c.names[0] = "a".into()),
        ("named twice", |c| c.names[0] = c.names[1].clone()),
    ];
    for (what, edit) in edits {
        let mut model = good.clone();
        edit(&mut model.covariance);
        refused(what, &model);
    }
    let mut model = good;
    model.kind = "rotary".into();
    refused("rotary", &model);
    insta::assert_snapshot!(said);
}
