//! A `no_std` crate with the numbers of the model, on `stiction-friction` itself, which comes with it.

use crate::number::Literal;
use crate::template::Fill;
use crate::terms::{self, Extra};
use crate::vectors::{DOUBLE_TOLERANCE, SINGLE_TOLERANCE, Vectors};
use crate::{Error, File, Model, header, law};
use stiction_friction::compensator::{Channel, Friction, Levels, Terms, WAVES, Wave};
use stiction_friction::source;

const MANIFEST: &str = include_str!("../templates/rust/Cargo.toml.in");
const FRICTION: &str = include_str!("../templates/rust/friction.toml.in");
const LIBRARY: &str = include_str!("../templates/rust/lib.rs.in");
const SELFTEST: &str = include_str!("../templates/rust/selftest.rs.in");

pub(crate) fn files(model: &Model) -> Result<Vec<File>, Error> {
    let vectors = Vectors::<f64>::new(model, "f64")?;
    let small = Vectors::<f32>::new(model, "f32")?;
    let compensator = model.compensator::<f64>(&model.settings, "f64")?;
    let name = model.identifier.to_ascii_lowercase();
    let mut fill = Fill::default();
    fill.set("crate", format!("{}-friction", name.replace('_', "-")))
        .set("module", format!("{name}_friction"))
        .set("version", env!("CARGO_PKG_VERSION"))
        .set("v_unit", model.speed_unit())
        .set("x_unit", model.length_unit())
        .set("f_unit", model.force_unit())
        .set(
            "also",
            match model.settings.adaptation {
                Some(_) => ", force of the drive and whether to learn",
                None => "",
            },
        )
        .flag("watchdog", model.settings.watchdog.is_some());
    law::fill(&mut fill, compensator.friction(), f64::c);
    if let Friction::Gms(law) = compensator.friction() {
        // A literal of infinity there is none.
        let attraction = match law.attraction() {
            c if c.is_finite() => c.c(),
            _ => "f64::INFINITY".into(),
        };
        fill.set("attraction", attraction);
    }
    let lines = law::element_lines(compensator.friction(), |_, element| {
        let (stiffness, share) = (element.stiffness.c(), element.share.c());
        format!(
            "        Element {{\n            stiffness: n({stiffness}),\n            share: n({share}),\n        }},"
        )
    });
    fill.set("element_lines", lines);
    let terms = compensator.terms().copied().unwrap_or_default();
    let extras = Extra::of(&terms);
    let each = |text: &dyn Fn(&str) -> String| -> String {
        extras.iter().map(|extra| text(extra.name())).collect()
    };
    fill.flag("terms", terms::has(&terms))
        .flag("levels", terms.levels.is_some())
        .flag("weight", terms.weight.is_some())
        .set("terms", literal(&terms))
        .set("extra_names", terms::names(&terms))
        .set("extra_types", "T, ".repeat(extras.len()))
        .set("extra_values", each(&|name| format!("{name}, ")));
    let mut test = fill.clone();
    law::settings(&mut fill, compensator.settings(), f64::c);
    law::settings(&mut test, &vectors.settings, f64::c);
    test.set("header", header::comment(model, "//! "))
        .set("rows", rows(&vectors))
        .set("rows_f32", rows(&small))
        .set(
            "tolerance_f32",
            f64::c(SINGLE_TOLERANCE * small.scale(model)),
        )
        .set("count", vectors.rows.len().to_string())
        .set("tolerance", (DOUBLE_TOLERANCE * vectors.scale(model)).c());
    let manifest = fill
        .clone()
        .set("header", header::comment(model, "# "))
        .render(MANIFEST);
    let friction = fill.render(FRICTION);
    let library = fill
        .set("header", header::comment(model, "//! "))
        .render(LIBRARY);
    let mut files = vec![
        File::text("Cargo.toml", manifest),
        File::text("src/lib.rs", library),
        File::text("tests/selftest.rs", test.render(SELFTEST)),
        File::text(beside("Cargo.toml"), friction),
    ];
    let sources = source::FILES.iter();
    files.extend(sources.map(|(path, text)| File::text(beside(path), (*text).into())));
    Ok(files)
}

/// A path in the folder of the law.
fn beside(path: &str) -> String {
    format!("stiction-friction/{path}")
}

/// The terms as Rust.
fn literal(terms: &Terms<f64>) -> String {
    let number = |x: f64| format!("n({})", x.c());
    let both = |x: [f64; 2]| format!("[{}, {}]", number(x[0]), number(x[1]));
    let channel = |c: Channel<f64>| {
        format!(
            "Channel {{ reference: {}, range: {}, turns: {} }}",
            number(c.reference),
            both(c.range),
            c.turns
        )
    };
    let wave = |w: &Wave<f64>| match w.rate > 0.0 {
        true => format!(
            "Wave {{ rate: {}, whole: {}, sine: {}, cosine: {} }}",
            number(w.rate),
            w.whole,
            number(w.sine),
            number(w.cosine)
        ),
        false => "Wave::default()".into(),
    };
    let waves = |all: &[Wave<f64>; WAVES]| {
        let each: Vec<String> = all.iter().map(wave).collect();
        format!("[{}]", each.join(", "))
    };
    let levels = |l: &Levels<f64>| {
        format!(
            "Some(Levels {{\n            load: {},\n            temperature: {},\n            position: {},\n            transmitted: {},\n            driven: {},\n            \
             waves: [{}, {}],\n            viscous: {},\n            quadratic: {},\n            top_speed: {},\n        }})",
            both(l.load),
            both(l.temperature),
            both(l.position),
            both(l.transmitted),
            both(l.driven),
            waves(&l.waves[0]),
            waves(&l.waves[1]),
            both(l.viscous),
            both(l.quadratic),
            number(l.top_speed)
        )
    };
    let weight = terms.weight.map_or("None".into(), |w| {
        format!(
            "Some(Weight {{ constant: {}, wave: {} }})",
            number(w.constant),
            wave(&w.wave)
        )
    });
    let c = &terms.channels;
    format!(
        "Terms {{\n        channels: Channels {{\n            load: {},\n            temperature: {},\n            position: {},\n            transmitted: {},\n        \
         }},\n        levels: {},\n        mass: {},\n        weight: {weight},\n        cogging: {},\n    }}",
        channel(c.load),
        channel(c.temperature),
        channel(c.position),
        channel(c.transmitted),
        terms.levels.as_ref().map_or("None".into(), levels),
        number(terms.mass),
        waves(&terms.cogging)
    )
}

fn rows<T: Literal>(vectors: &Vectors<T>) -> String {
    let rows: Vec<String> = vectors
        .rows
        .iter()
        .map(|row| {
            let (v, e, f) = (plain(row.velocity), plain(row.error), plain(row.force));
            let drive = row
                .drive
                .map(|(u, learn)| format!("{}, {learn}, ", plain(u)));
            let extras: String = row
                .extras
                .iter()
                .map(|x| format!("{}, ", plain(*x)))
                .collect();
            format!(
                "    ({v}, {e}, {}, {}{extras}{f}),",
                row.enable,
                drive.unwrap_or_default()
            )
        })
        .collect();
    rows.join("\n")
}

/// A number without the suffix of its type in C.
fn plain<T: Literal>(x: T) -> String {
    x.c().trim_end_matches('f').to_string()
}
