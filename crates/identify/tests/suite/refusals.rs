//! What is said where nothing can be identified: what took the samples, and numbers of any size.

use stiction_identify::{Conditioning, Cutoff, Error, Law, LawKind, Samples, Settings, Terms};

/// Three seconds at 500 Hz of a slow sine with friction.
fn samples() -> Samples {
    let time: Vec<f64> = (0..1500).map(|i| f64::from(i) / 500.0).collect();
    let position = time.iter().map(|t| 0.02 * (5.0 * t).sin()).collect();
    let force = time.iter().map(|t| 20.0 * (5.0 * t).cos().signum());
    Samples {
        force: force.collect(),
        position: Some(position),
        time,
        ..Samples::default()
    }
}

fn refused(samples: &Samples, conditioning: &Conditioning) -> String {
    let logs = std::slice::from_ref(samples);
    let record = match stiction_identify::condition(logs, conditioning) {
        Ok(record) => record,
        Err(error) => return error.to_string(),
    };
    let law = Law::new(LawKind::LuGre);
    let observer = &mut stiction_identify::Silent;
    stiction_identify::separable(
        &record,
        law,
        &Terms::default(),
        &Settings::default(),
        observer,
    )
    .expect_err("enough samples")
    .to_string()
}

#[test]
fn what_took_the_samples_is_said() {
    let plain = Conditioning::default();
    let mut said = String::new();
    let mut tell = |what: &str, text: String| said.push_str(&format!("{what}: {text}\n"));

    let fast = Conditioning {
        min_speed: 0.097,
        ..plain
    };
    tell("slow", refused(&samples(), &fast));

    let mut saturated = samples();
    saturated.valid = (0..1500).map(|i| i % 100 < 20).collect();
    tell("saturated", refused(&saturated, &plain));

    let mut broken = samples();
    broken.breaks = (50..1500).step_by(50).collect();
    tell("broken", refused(&broken, &plain));

    let low = Conditioning {
        common_cutoff: Cutoff::Hz(2.0),
        ..plain
    };
    tell("thinned", refused(&samples(), &low));
    insta::assert_snapshot!(said);
}

/// Numbers of three hundred digits are written with a power of ten.
#[test]
fn numbers_of_any_size_stay_short() {
    let plain = Conditioning::default();
    for size in [5e-324, 1e-300, 1e300] {
        let cut = Conditioning {
            source_cutoff: Cutoff::Hz(size),
            ..plain
        };
        let text = refused(&samples(), &cut);
        assert!(
            text.contains(&format!("{size:e}")) && text.len() < 200,
            "{text}"
        );
        let error = Error::NoForce { value: size };
        assert!(error.to_string().contains(&format!("{size:e}")), "{error}");
    }
}
