//! The study that `simulate --init` begins: every part of a study once, with comments, on an axis that is given or a known one.

use super::model::Model;
use super::resolve::whole;
use crate::error::Error;
use crate::symbols;
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};
use stiction_log::Motion;
use stiction_number::short;
use stiction_parameters::{Name, Quantity, Side};

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

/// A study file at `file` of the axis that a model file describes, or of a known one.
///
/// # Errors
/// Where the model cannot be read, or a study does not simulate it.
pub fn start(model: Option<&Path>, file: &Path) -> Result<Started, Error> {
    let (model, axis) = match model {
        Some(path) => {
            let named = from_folder_of(file, path).display().to_string();
            let line = format!("model      = {}", toml::Value::from(named));
            (Model::read(path)?, line)
        }
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
    let mass = model.value(Quantity::Mass).filter(|mass| *mass > 0.0);
    Ok(Started {
        text: text(&model, &axis, mass, file),
        undecided: mass
            .is_none()
            .then(|| "the model has no mass; give that of the moving part".into()),
    })
}

fn text(model: &Model, axis: &str, mass: Option<f64>, file: &Path) -> String {
    let motion = model.motion;
    let (length, speed, force) = (
        symbols::length_unit(motion),
        symbols::speed_unit(motion),
        symbols::force_unit(motion),
    );
    // A move of a quarter of a second with ramps of 70 ms, as fast as the logs of the model went.
    let velocity = model
        .top_speed()
        .filter(|v| *v > 0.0)
        .unwrap_or(match motion {
            Motion::Linear => 0.05,
            Motion::Rotary => 5.0,
        });
    let acceleration = velocity / 0.05;
    let largest = |quantity: Quantity| {
        let sides = [Side::Both, Side::Positive, Side::Negative];
        let values = sides.map(|side| model.value(Name { quantity, side }));
        values.into_iter().flatten().fold(0.0, f64::max)
    };
    let friction = largest(Quantity::Static).max(largest(Quantity::Coulomb));
    let limit = LIMIT_OVER_FORCE
        * (friction + largest(Quantity::Sigma2) * velocity + mass.unwrap_or(0.0) * acceleration);
    let mass_line = match (mass, motion) {
        (Some(_), _) => "",
        (None, Motion::Linear) => "mass       = \"? kg\"    # to fill in: the model has none\n",
        (None, Motion::Rotary) => "mass       = \"? kg m^2\"    # to fill in: the model has none\n",
    };
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
    let v = short(velocity);
    format!(
        "# What compensation of friction does on an axis, simulated. It runs as it is:\n#\n\
         #     stiction simulate {name} --out {out}\n#\n\
         # Every path is run under every controller, without and with every compensator. Every key: docs/study.md.\n\n\
         [axis]\n{axis}\n{mass_line}\
         rate       = \"{rate} Hz\"    # of the controller; a delay of one period follows it\n\
         peak_force = \"{limit} {force}\"    # what the drive can give: three times what the motion below takes\n\
         # encoder      = \"{encoder} {length}\"    # one step of the position; without it the position is exact\n\
         # current_loop = \"1 kHz\"    # bandwidth of the drive; without it the force comes at once\n\n\
         [[path]]\n\
         kind         = \"move\"    # there and back, with a rest of 0.2 s after each\n\
         distance     = \"{distance} {length}\"\n\
         velocity     = \"{v} {speed}\"\n\
         acceleration = \"{acceleration} {speed}2\"\n\
         jerk         = \"{jerk} {speed}3\"\n\n\
         [[path]]\n\
         kind      = \"sine\"    # its second half counts\n\
         amplitude = \"{amplitude} {length}\"\n\
         frequency = \"{frequency} Hz\"\n\n\
         [[path]]\n\
         kind = \"crawl\"    # {crawl}: does it stick and slip?\n\n\
         [[path]]\n\
         kind = \"hold\"    # a move and a long rest: does it hunt?\n\n\
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
        whole = whole(model.kind),
        rate = short(RATE),
        limit = short(limit),
        encoder = short(match motion {
            Motion::Linear => 50e-9,
            Motion::Rotary => 10e-6,
        }),
        distance = short(0.2 * velocity),
        acceleration = short(acceleration),
        jerk = short(acceleration / 0.02),
        amplitude = short(velocity / (TAU * FREQUENCY)),
        frequency = short(FREQUENCY),
        crawl = match motion {
            Motion::Linear => "1, 10 and 100 um/s",
            Motion::Rotary => "0.1, 1 and 10 mrad/s",
        },
        bandwidth = short(BANDWIDTH),
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
