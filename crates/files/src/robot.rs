//! `robot.toml`: what is known of a robot and its logs, joint by joint.

mod identified;
pub mod model;
pub mod result;

pub use identified::{IdentifiedBody, IdentifiedJoint, IdentifiedRobot};

use crate::axis::Axis;
use crate::config::{Form, Given, Places, Source, Table, read};
use crate::error::Error;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use stiction_formats::Dimension;
use stiction_log::{Channel, Motion, Role};

/// What the file is called where there is none.
const IN_MEMORY: &str = "robot.toml";
/// Most joints of a coupling.
const MOST_COUPLED: usize = 8;
/// Most couplings.
const MOST_COUPLINGS: usize = 32;
/// Largest component of a gravity, m/s^2: that of any planet.
const LARGEST_GRAVITY: f64 = 300.0;
/// Farthest that a centre of mass is from the frame of its link, m.
const FARTHEST: f64 = 100.0;

/// Everything that a robot file says; `Robot::default()` leaves all to the URDF and the log.
#[derive(Clone, Debug)]
pub struct Robot {
    /// Name of the robot for reports.
    pub name: Option<String>,
    /// The URDF, from the folder of the file.
    pub urdf: Option<PathBuf>,
    /// Gravity in the frame of the base link, m/s^2.
    pub gravity: Option<[f64; 3]>,
    /// What the robot carries.
    pub tool: Option<Tool>,
    /// Joints whose motors move several of them.
    pub couplings: Vec<Coupling>,
    joints: BTreeMap<String, RobotJoint>,
    identified: Option<IdentifiedRobot>,
    /// What holds for every joint.
    axis: Axis,
    places: Places,
    /// The file that it was read from, with the SHA-256 of its text.
    read_from: Option<(PathBuf, String)>,
}

/// A joint as the file has it.
#[derive(Clone, Debug)]
pub struct RobotJoint {
    /// Its columns and what else an axis has.
    pub axis: Axis,
    /// Whether its friction is fitted.
    pub fit: bool,
    /// Where it stands, m or rad, where it was not logged.
    pub at: Option<(f64, Dimension)>,
}

/// A load that is fixed to a link.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Tool {
    /// The link.
    pub link: String,
    /// Mass, kg.
    pub mass: f64,
    /// Centre of mass in the frame of the link, m.
    pub center: [f64; 3],
}

/// Positions of joints from those of their motors.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Coupling {
    /// The joints, in the order of the matrix.
    pub joints: Vec<String>,
    /// Row by row: position of a joint from those of the motors.
    pub matrix: Vec<Vec<f64>>,
}

impl Default for Robot {
    fn default() -> Self {
        Robot {
            name: None,
            urdf: None,
            gravity: None,
            tool: None,
            couplings: Vec::new(),
            joints: BTreeMap::new(),
            identified: None,
            axis: Axis::of_no_robot(IN_MEMORY),
            places: Places::in_memory(IN_MEMORY, Form::Robot),
            read_from: None,
        }
    }
}

impl Robot {
    /// Reads and checks a robot file.
    ///
    /// # Errors
    /// With file, line, column and key, what was found and what is allowed.
    pub fn read(file: impl AsRef<Path>) -> Result<Self, Error> {
        let file = file.as_ref();
        let text = read(file, Form::Robot)?;
        let mut robot = resolve(&text, file)?;
        let sha256 = crate::hash::sha256_of(text.as_bytes());
        robot.read_from = Some((file.into(), sha256));
        Ok(robot)
    }

    /// Checks the text of a robot file.
    ///
    /// # Errors
    /// With line, column and key, what was found and what is allowed.
    pub fn parse(text: &str) -> Result<Self, Error> {
        resolve(text, Path::new(IN_MEMORY))
    }

    /// The file that it was read from, with the SHA-256 of its text.
    pub fn file(&self) -> Option<(&Path, &str)> {
        let (file, sha256) = self.read_from.as_ref()?;
        Some((file, sha256))
    }

    /// What holds for every joint.
    pub fn axis(&self) -> &Axis {
        &self.axis
    }

    /// What the file says of a joint.
    pub fn joint(&self, name: &str) -> Option<&RobotJoint> {
        self.joints.get(name)
    }

    /// What an identification found, where it wrote the file.
    pub fn identified(&self) -> Option<&IdentifiedRobot> {
        self.identified.as_ref()
    }

    /// The names of the joints that it speaks of.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.joints.keys().map(String::as_str)
    }

    /// A joint that turns or slides, with the columns that were found for what the file leaves open.
    pub fn axis_of(&self, name: &str, motion: Motion, found: &[(Role, Channel)]) -> Axis {
        let given = self.joints.get(name).map(|joint| joint.axis.clone());
        let mut axis = given.unwrap_or_else(|| self.axis.joint(name));
        axis.mapping.motion = Some(motion);
        let is_made = axis
            .mapping
            .drive
            .is_some_and(|drive| drive.position_loop.is_some());
        for (role, channel) in found {
            // A servo's own loop says more than the current that it states.
            if *role == Role::Force && is_made {
                continue;
            }
            if axis.mapping.channel(*role).is_none() {
                axis.mapping.set(*role, channel.clone());
            }
        }
        let needed = [Role::Position, Role::Velocity, Role::Force];
        let open = Role::OPTIONAL.into_iter().chain(needed);
        let open = open.filter(|role| axis.mapping.channel(*role).is_none());
        // Columns of other joints would be taken for those of this one.
        axis.mapping.absent = open.collect();
        axis
    }

    /// An error at a key, or at the table that lacks it.
    pub fn refuse(&self, key: &str, found: impl Into<String>, allowed: &str) -> Error {
        self.places.refuse(key, found.into(), allowed)
    }
}

/// Checks the text of a robot file; `file` is for messages.
fn resolve(text: &str, file: &Path) -> Result<Robot, Error> {
    let source = Source {
        file,
        text,
        form: Form::Robot,
        swept: None,
    };
    let entries = source.parse()?;
    let root = Table::root(source, &entries);
    let places = Places::of(&source, &entries);
    let folder = file.parent().unwrap_or(Path::new(""));
    if let Some(given) = root.get("schema") {
        let own = given.as_text() == Some(result::SCHEMA);
        own.then_some(())
            .ok_or_else(|| given.refused(&format!("{:?}", result::SCHEMA)))?;
    }
    let mut identified = IdentifiedRobot {
        urdf_sha256: root.text("urdf_sha256")?.map(str::to_string),
        bodies: identified::bodies(&root)?,
        joints: Vec::new(),
    };
    let name = root.line("name")?.map(str::to_string);
    let urdf = root.get("urdf").map(|given| given.path("a URDF"));
    let gravity = root.get("gravity").map(|given| {
        let allowed = "three numbers in m/s^2 in the frame of the base link, such as [0, 0, -9.81]";
        vector(&given, LARGEST_GRAVITY, allowed)
    });
    let axis = Axis::of_robot(&root, &source, places.clone())?;
    let mut joints = BTreeMap::new();
    if let Some(table) = root.table("joint")? {
        for (name, given) in table.named() {
            let own = given.as_table();
            let own = own.ok_or_else(|| given.refused(&format!("a table [joint.{name}]")))?;
            identified
                .joints
                .extend(identified::joint(&own, name, folder)?);
            joints.insert(name.to_string(), joint(&own, name, &axis)?);
        }
    }
    let robot = Robot {
        name: name.filter(|name| !name.trim().is_empty()),
        urdf: urdf.transpose()?.map(|urdf| folder.join(urdf)),
        gravity: gravity.transpose()?,
        tool: root.table("tool")?.map(|own| tool(&own)).transpose()?,
        couplings: root
            .tables("coupling", MOST_COUPLINGS)?
            .iter()
            .map(coupling)
            .collect::<Result<_, _>>()?,
        joints,
        identified: (identified != IdentifiedRobot::default()).then_some(identified),
        axis,
        places,
        read_from: None,
    };
    root.end()?;
    Ok(robot)
}

fn joint(table: &Table<'_>, name: &str, all: &Axis) -> Result<RobotJoint, Error> {
    let joint = RobotJoint {
        axis: all.joint_of(name, table)?,
        fit: table.flag("fit")?.unwrap_or(true),
        at: table
            .get("at")
            .map(|given| given.value(&[Dimension::ANGLE, Dimension::LENGTH]))
            .transpose()?,
    };
    table.end()?;
    Ok(joint)
}

fn tool(table: &Table<'_>) -> Result<Tool, Error> {
    let link = table.text("link")?;
    let link = table.required("link", link, "the link of the URDF that carries it")?;
    let mass = table.positive("mass", Dimension::MASS)?;
    let center = table.get("center").map(|given| {
        let allowed = "three numbers in m in the frame of the link, such as [0, 0, 0.05]";
        vector(&given, FARTHEST, allowed)
    });
    let tool = Tool {
        link: link.to_string(),
        mass: table.required("mass", mass, "the mass, such as \"2.3 kg\"")?,
        center: center.transpose()?.unwrap_or_default(),
    };
    table.end()?;
    Ok(tool)
}

fn coupling(table: &Table<'_>) -> Result<Coupling, Error> {
    let allowed = format!("the names of 2 to {MOST_COUPLED} joints in quotes");
    let joints = table.get("joints");
    let joints = table.required("joints", joints, &allowed)?;
    let names: Option<Vec<&str>> = joints
        .as_list()
        .and_then(|list| list.iter().map(Given::as_text).collect());
    let names = names.filter(|names| (2..=MOST_COUPLED).contains(&names.len()));
    let names = names.ok_or_else(|| joints.refused(&allowed))?;
    let size = names.len();
    let allowed = format!("{size} rows of {size} numbers, such as [[1, 0], [1, 1]]");
    let matrix = table.get("matrix");
    let matrix = table.required("matrix", matrix, &allowed)?;
    let row = |given: &Given<'_>| numbers(given, FARTHEST).filter(|row| row.len() == size);
    let rows: Option<Vec<Vec<f64>>> = matrix
        .as_list()
        .and_then(|list| list.iter().map(row).collect());
    let rows = rows.filter(|rows| rows.len() == size);
    let coupling = Coupling {
        joints: names.into_iter().map(str::to_string).collect(),
        matrix: rows.ok_or_else(|| matrix.refused(&allowed))?,
    };
    table.end()?;
    Ok(coupling)
}

/// Three numbers, none larger than `most`.
fn vector(given: &Given<'_>, most: f64, allowed: &str) -> Result<[f64; 3], Error> {
    let found = numbers(given, most).and_then(|list| <[f64; 3]>::try_from(list).ok());
    found.ok_or_else(|| given.refused(allowed))
}

/// A list of numbers, none larger than `most`; `None` for anything else.
fn numbers(given: &Given<'_>, most: f64) -> Option<Vec<f64>> {
    let list = given.as_list()?;
    let number = |entry: &Given<'_>| entry.as_number().filter(|x| x.abs() <= most);
    list.iter().map(number).collect()
}
