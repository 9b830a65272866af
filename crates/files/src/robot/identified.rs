//! What an identification found, read back from `robot.toml`.

use super::{numbers, vector};
use crate::config::{Given, LARGEST_SI, Table};
use crate::error::Error;
use std::path::{Path, PathBuf};

/// Most bodies.
const MOST_BODIES: usize = 128;

/// The identified part of a robot file: `[joint.NAME.identified]` and `[[body]]`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct IdentifiedRobot {
    /// SHA-256 of the URDF that it was identified with, hexadecimal.
    pub urdf_sha256: Option<String>,
    /// Joints whose friction was identified, in the order of the file.
    pub joints: Vec<IdentifiedJoint>,
    /// Inertias.
    pub bodies: Vec<IdentifiedBody>,
}

/// Identified numbers of a joint, in SI.
#[derive(Clone, Debug, PartialEq)]
pub struct IdentifiedJoint {
    /// Name in the URDF.
    pub name: String,
    /// Model file of its friction law.
    pub model: PathBuf,
    /// Inertia of the rotor at the joint, kg m^2 or kg.
    pub armature: f64,
    /// Coulomb friction, N m or N, and viscous friction, N m s/rad or N s/m, as simulators take them.
    pub simulators: Option<[f64; 2]>,
}

/// Inertia of a body, at its centre of mass along the directions of its link.
#[derive(Clone, Debug, PartialEq)]
pub struct IdentifiedBody {
    /// The joint that moves it.
    pub joint: String,
    /// The link that has the inertia in the URDF.
    pub link: String,
    /// Mass, kg.
    pub mass: f64,
    /// Centre of mass in the frame of the link, m.
    pub center: [f64; 3],
    /// xx, xy, yy, xz, yz, zz about that centre, kg m^2.
    pub inertia: [f64; 6],
}

/// Reads `[joint.NAME.identified]`; model files are named from `folder`.
pub(super) fn joint(
    table: &Table<'_>,
    name: &str,
    folder: &Path,
) -> Result<Option<IdentifiedJoint>, Error> {
    let Some(own) = table.table("identified")? else {
        return Ok(None);
    };
    let model = own.get("model").map(|given| given.path("a model file"));
    let model = own.required("model", model, "the model file of its friction")?;
    let armature = own.number("armature", 0.0, LARGEST_SI)?;
    let friction = own.number("friction", 0.0, LARGEST_SI)?;
    let damping = own.number("damping", 0.0, LARGEST_SI)?;
    let simulators = match (friction, damping) {
        (None, None) => None,
        (friction, damping) => Some([
            own.required("friction", friction, "Coulomb friction beside damping")?,
            own.required("damping", damping, "viscous friction beside friction")?,
        ]),
    };
    let joint = IdentifiedJoint {
        name: name.to_string(),
        model: folder.join(model?),
        armature: own.required(
            "armature",
            armature,
            "the inertia of the rotor, such as 0.1",
        )?,
        simulators,
    };
    own.end()?;
    Ok(Some(joint))
}

/// Reads every `[[body]]`.
pub(super) fn bodies(root: &Table<'_>) -> Result<Vec<IdentifiedBody>, Error> {
    root.tables("body", MOST_BODIES)?.iter().map(body).collect()
}

fn body(table: &Table<'_>) -> Result<IdentifiedBody, Error> {
    let text = |key, example| {
        let text = table.text(key)?;
        table.required(key, text, example).map(str::to_string)
    };
    let joint = text("joint", "the joint that moves it")?;
    let link = text("link", "the link of the URDF that has its inertia")?;
    let mass = table.get("mass");
    let mass = table.required("mass", mass, "the mass in kg, such as 2.3")?;
    let positive = mass.as_number().filter(|x| *x > 0.0 && *x <= LARGEST_SI);
    let center = table.get("center");
    let center = table.required("center", center, "the centre of mass in m")?;
    let inertia = table.get("inertia");
    let inertia = table.required("inertia", inertia, "the inertia in kg m^2")?;
    let six = |given: &Given<'_>| <[f64; 6]>::try_from(numbers(given, LARGEST_SI)?).ok();
    let body = IdentifiedBody {
        joint,
        link,
        mass: positive.ok_or_else(|| mass.refused("a mass in kg above 0, without quotes"))?,
        center: vector(&center, LARGEST_SI, "three numbers in m")?,
        inertia: six(&inertia)
            .ok_or_else(|| inertia.refused("six numbers in kg m^2: xx, xy, yy, xz, yz, zz"))?,
    };
    table.end()?;
    Ok(body)
}
