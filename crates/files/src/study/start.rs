//! The study that `simulate --init` begins: every part of a study once, with comments, on an axis that is given or a known one.

use super::model::Model;
use super::resolve::whole;
use crate::error::Error;
use crate::symbols;
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};
use stiction_log::Motion;
use stiction_number::short;
use stiction_parameters::{LawKind, Name, Quantity, Side};

/// The known axis of a study without a model.
const KNOWN: &str = "motor";
/// Control rate of a usual servo axis, Hz.
const RATE: f64 = 4e3;
/// Bandwidth of its controller, Hz.
const BANDWIDTH: f64 = 30.0;
/// Frequency of the sine, Hz.
const FREQUENCY: f64 = 1.0;
/// Limit of the force over what friction and the motion take, dimensionless.
const LIMIT_OVER_FORCE: f64 = 3.0;

/// A study file to write.
#[derive(Clone, Debug)]
pub struct Started {
    /// The text of the study file.
    pub text: String,
    /// What has to be filled in before it runs, if anything has.
    pub undecided: Option<String>,
}

/// A study file at `file` of the axis that a model file describes, or of a known one; with a `second` axis of both along a
/// circle.
///
/// # Errors
/// Where a model cannot be read, or a study does not simulate it, or not beside the other.
pub fn start(model: Option<&Path>, second: Option<&Path>, file: &Path) -> Result<Started, Error> {
    let (first, source) = match model {
        Some(path) => (Model::read(path)?, named(file, path)),
        None => {
            let known = Model::known(KNOWN).ok_or_else(|| {
                let reason = format!("there is no known axis {KNOWN} to begin with");
                Error::output(file, reason)
            })?;
            let line = format!(
                "known      = \"{KNOWN}\"    # or model = \"model.toml\", as stiction identify writes it"
            );
            (known, line)
        }
    };
    let first = Axis::of(first, source);
    let second = second
        .map(|path| Ok::<_, Error>(Axis::of(Model::read(path)?, named(file, path))))
        .transpose()?;
    if let Some(second) = &second {
        take_both(&first.model, &second.model)?;
    }
    let undecided = match &second {
        None if first.mass.is_none() => Some("the model has no mass; give that of the moving part"),
        Some(second) if first.mass.is_none() || second.mass.is_none() => {
            Some("a model has no mass; give that of the moving part of each axis")
        }
        _ => None,
    };
    Ok(Started {
        text: text(&first, second.as_ref(), file),
        undecided: undecided.map(String::from),
    })
}

/// Refuses two axes that no study simulates together.
fn take_both(first: &Model, second: &Model) -> Result<(), Error> {
    if first.motion != second.motion {
        let allowed = format!("{}, as the first axis", first.motion);
        return Err(second.refuse("kind", second.motion.to_string(), &allowed));
    }
    let other = [first, second]
        .into_iter()
        .find(|model| !matches!(model.kind, LawKind::LuGre | LawKind::Dahl));
    other.map_or(Ok(()), |model| {
        let allowed = "lugre or dahl on both axes: with other laws a study has one axis";
        Err(model.refuse("law", model.kind.name().into(), allowed))
    })
}

/// The line that names a model.
fn named(file: &Path, path: &Path) -> String {
    let named = from_folder_of(file, path).display().to_string();
    format!("model      = {}", toml::Value::from(named))
}

/// An axis of the study.
struct Axis {
    model: Model,
    /// The line that says where its parameters come from.
    source: String,
    mass: Option<f64>,
    /// As fast as the logs of the model went, m/s (rad/s).
    velocity: f64,
}

impl Axis {
    fn of(model: Model, source: String) -> Self {
        let velocity = model
            .top_speed()
            .filter(|v| *v > 0.0)
            .unwrap_or(match model.motion {
                Motion::Linear => 0.05,
                Motion::Rotary => 5.0,
            });
        Axis {
            mass: model.value(Quantity::Mass).filter(|mass| *mass > 0.0),
            velocity,
            source,
            model,
        }
    }

    /// Three times the force that friction and a motion take, N (N m).
    fn peak_force(&self, velocity: f64) -> f64 {
        let largest = |quantity: Quantity| {
            let sides = [Side::Both, Side::Positive, Side::Negative];
            let values = sides.map(|side| self.model.value(Name { quantity, side }));
            values.into_iter().flatten().fold(0.0, f64::max)
        };
        let friction = largest(Quantity::Static).max(largest(Quantity::Coulomb));
        let inertia = self.mass.unwrap_or(0.0) * acceleration(velocity);
        LIMIT_OVER_FORCE * (friction + largest(Quantity::Sigma2) * velocity + inertia)
    }

    /// The lines of its table that are not those of every axis; `rate` is one more of the first.
    fn lines(&self, rate: &str, velocity: f64) -> String {
        let mass = match (self.mass, self.model.motion) {
            (Some(_), _) => "",
            (None, Motion::Linear) => "mass       = \"? kg\"    # to fill in: the model has none\n",
            (None, Motion::Rotary) => {
                "mass       = \"? kg m^2\"    # to fill in: the model has none\n"
            }
        };
        let force = symbols::force_unit(self.model.motion);
        let peak = short(self.peak_force(velocity));
        format!(
            "{}\n{mass}{rate}peak_force = \"{peak} {force}\"    # what the drive can give: three times what the motion below takes\n",
            self.source
        )
    }
}

/// That of a ramp of 70 ms with rounded ends.
fn acceleration(velocity: f64) -> f64 {
    velocity / 0.05
}

fn text(first: &Axis, second: Option<&Axis>, file: &Path) -> String {
    // Both axes go as fast as the slower one.
    let velocity = second.map_or(first.velocity, |second| first.velocity.min(second.velocity));
    let model = &first.model;
    let motion = model.motion;
    let length = symbols::length_unit(motion);
    let drawn = model
        .covariance
        .as_ref()
        .is_some_and(|c| !c.names.is_empty());
    let covariance = match drawn {
        true => {
            "# [[parameter_error]]    # parameters drawn from the covariance of the model\n\
             # kind = \"covariance\"\n\n"
        }
        false => "",
    };
    let [name, out] = [file, &results(file)].map(|path| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        name.replace(char::is_control, "?")
    });
    let motions = match second {
        None => paths(motion, velocity),
        Some(second) => format!(
            "[second_axis]    # y; the keys of [axis] but rate\n{}\n\
             # [coupling]    # control of the contour error above both axes\n\
             # bandwidth = \"{} Hz\"\n\
             # limit     = \"{} {}\"\n\n{}",
            second.lines("", velocity),
            short(BANDWIDTH),
            short(velocity),
            symbols::speed_unit(motion),
            circle(motion, velocity)
        ),
    };
    let rate = format!(
        "rate       = \"{} Hz\"    # of the controller; a delay of one period follows it\n",
        short(RATE)
    );
    format!(
        "# What compensation of friction does on {what}, simulated. It runs as it is:\n#\n\
         #     stiction simulate {name} --out {out}\n#\n\
         # Every path is run under every controller, without and with every compensator. Every key: docs/study.md.\n\n\
         [axis]\n{axis}\
         # encoder      = \"{encoder} {length}\"    # one step of the position; without it the position is exact\n\
         # current_loop = \"1 kHz\"    # bandwidth of the drive; without it the force comes at once\n\n\
         {motions}\
         [[controller]]\n\
         kind      = \"cascade\"    # or \"pid\", \"fuzzy-pid\"\n\
         bandwidth = \"{bandwidth} Hz\"    # tunes all gains for the mass; put in that of your controller\n\n\
         [[compensator]]\n\
         kind = \"coulomb\"    # Coulomb and viscous friction of the reference velocity\n\n\
         [[compensator]]\n\
         kind = \"{whole}\"    # the whole law; three quarters of its force\n\n\
         {covariance}\
         # [[parameter_error]]    # parameters that are each 10 % too large or too small\n\
         # kind = \"corners\"\n\
         # by   = \"10 %\"\n",
        what = if second.is_some() {
            "two axes along a circle"
        } else {
            "an axis"
        },
        axis = first.lines(&rate, velocity),
        whole = whole(model.kind),
        encoder = short(match motion {
            Motion::Linear => 50e-9,
            Motion::Rotary => 10e-6,
        }),
        bandwidth = short(BANDWIDTH),
    )
}

/// Motions of one axis.
fn paths(motion: Motion, velocity: f64) -> String {
    let (length, speed) = (symbols::length_unit(motion), symbols::speed_unit(motion));
    let acceleration = acceleration(velocity);
    format!(
        "[[path]]\n\
         kind         = \"move\"    # there and back, with a rest of 0.2 s after each\n\
         distance     = \"{distance} {length}\"\n\
         velocity     = \"{velocity} {speed}\"\n\
         acceleration = \"{acceleration} {speed}2\"\n\
         jerk         = \"{jerk} {speed}3\"\n\n\
         [[path]]\n\
         kind      = \"sine\"    # its second half counts\n\
         amplitude = \"{amplitude} {length}\"\n\
         frequency = \"{frequency} Hz\"\n\n\
         [[path]]\n\
         kind = \"crawl\"    # {crawl}: does it stick and slip?\n\n\
         [[path]]\n\
         kind = \"hold\"    # a move and a long rest: does it hunt?\n\n",
        distance = short(0.2 * velocity),
        jerk = short(acceleration / 0.02),
        acceleration = short(acceleration),
        amplitude = short(velocity / (TAU * FREQUENCY)),
        velocity = short(velocity),
        frequency = short(FREQUENCY),
        crawl = match motion {
            Motion::Linear => "1, 10 and 100 um/s",
            Motion::Rotary => "0.1, 1 and 10 mrad/s",
        },
    )
}

/// A circle, of which a turn takes as long as a period of the sine.
fn circle(motion: Motion, velocity: f64) -> String {
    let (length, speed) = (symbols::length_unit(motion), symbols::speed_unit(motion));
    let acceleration = acceleration(velocity);
    format!(
        "[[contour]]\n\
         kind         = \"circle\"    # its second turn counts; or \"corner\", \"square\", \"figure-eight\", \"file\"\n\
         radius       = \"{radius} {length}\"\n\
         velocity     = \"{velocity} {speed}\"    # along the circle\n\
         acceleration = \"{acceleration} {speed}2\"\n\
         jerk         = \"{jerk} {speed}3\"\n\n",
        radius = short(velocity / (TAU * FREQUENCY)),
        jerk = short(acceleration / 0.02),
        acceleration = short(acceleration),
        velocity = short(velocity),
    )
}

/// The folder for what a study finds: its name without what says that it is a study file.
pub fn results(file: &Path) -> PathBuf {
    match file.extension() {
        Some(_) => file.with_extension(""),
        None => file.with_extension("results"),
    }
}

/// A path that is typed, as a file in another folder names it.
fn from_folder_of(file: &Path, path: &Path) -> PathBuf {
    let folder = file.parent().unwrap_or(Path::new(""));
    match path.strip_prefix(folder) {
        _ if path.is_absolute() => path.into(),
        Ok(inside) => inside.into(),
        Err(_) => std::path::absolute(path).unwrap_or_else(|_| path.into()),
    }
}
