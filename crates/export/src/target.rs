//! The targets and the files of each.

use crate::{
    Error, Model, backlash, bam, c, check, cogging_map, cpp, domain, drive_table, fmu, hal, joint,
    matlab, modelica, mujoco, newton, ros2, rust, st, tf5200,
};

/// A form in which the compensator is exported.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Target {
    /// C99, in double and single precision.
    C,
    /// A header-only C++11 library for Arduino, PlatformIO and others.
    Cpp,
    /// The same as a class whose settings are parameters of a node of ROS 2.
    Ros2,
    /// IEC 61131-3 Structured Text, LREAL and REAL.
    St,
    /// The same as TwinCAT 3 objects.
    TcPou,
    /// The same as PLCopen TC6 XML.
    PlcOpen,
    /// A `no_std` crate on `stiction-friction`, whose source comes with it.
    Rust,
    /// The friction of a joint in MuJoCo 4.
    Mujoco,
    /// The law as a differential equation in Modelica.
    Modelica,
    /// Coulomb and viscous friction of a joint in URDF.
    Urdf,
    /// The same in SDFormat, for Gazebo.
    Sdf,
    /// The same, and static friction, of an actuator of Isaac Lab.
    IsaacLab,
    /// The same in Newton.
    Newton,
    /// Parameters of BAM, Better Actuator Models M1 to M5.
    Bam,
    /// What simulators take with its ranges, and draws from them.
    DomainJson,
    /// A component of LinuxCNC's HAL.
    Hal,
    /// Functional Mock-up Units for co-simulation, FMI 2.0 and 3.0.
    Fmu,
    /// Functions of MATLAB and Octave, and an S-function of Simulink.
    Matlab,
    /// The friction table of TwinCAT CNC.
    Tf5200,
    /// Numbers for the friction compensation that drives have built in.
    DriveTable,
    /// Cogging as maps of the force, of which some motor drivers hold one.
    CoggingMap,
    /// Backlash as a correction of the position, for LinuxCNC and TwinCAT.
    Backlash,
}

/// A file of an export.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct File {
    /// Path relative to the folder of the export, parts separated by `/`.
    pub path: String,
    /// Content.
    pub bytes: Vec<u8>,
}

impl File {
    pub(crate) fn text(path: impl Into<String>, text: String) -> Self {
        File {
            path: path.into(),
            bytes: text.into_bytes(),
        }
    }
}

impl Target {
    /// All of them.
    pub const ALL: [Target; 22] = [
        Target::C,
        Target::Cpp,
        Target::Ros2,
        Target::St,
        Target::TcPou,
        Target::PlcOpen,
        Target::Rust,
        Target::Mujoco,
        Target::Modelica,
        Target::Urdf,
        Target::Sdf,
        Target::IsaacLab,
        Target::Newton,
        Target::Bam,
        Target::DomainJson,
        Target::Hal,
        Target::Fmu,
        Target::Matlab,
        Target::Tf5200,
        Target::DriveTable,
        Target::CoggingMap,
        Target::Backlash,
    ];

    /// Name as typed.
    pub fn name(self) -> &'static str {
        match self {
            Target::C => "c",
            Target::Cpp => "cpp",
            Target::Ros2 => "ros2",
            Target::St => "st",
            Target::TcPou => "tcpou",
            Target::PlcOpen => "plcopen",
            Target::Rust => "rust",
            Target::Mujoco => "mujoco",
            Target::Modelica => "modelica",
            Target::Urdf => "urdf",
            Target::Sdf => "sdf",
            Target::IsaacLab => "isaaclab",
            Target::Newton => "newton",
            Target::Bam => "bam",
            Target::DomainJson => "domain-json",
            Target::Hal => "hal",
            Target::Fmu => "fmu",
            Target::Matlab => "matlab",
            Target::Tf5200 => "tf5200",
            Target::DriveTable => "drive-table",
            Target::CoggingMap => "cogging-map",
            Target::Backlash => "backlash",
        }
    }

    /// Whether it has nothing but steady friction of a simulated joint.
    pub(crate) fn is_joint(self) -> bool {
        matches!(
            self,
            Target::Urdf
                | Target::Sdf
                | Target::IsaacLab
                | Target::Newton
                | Target::Bam
                | Target::DomainJson
        )
    }

    /// Whether draws can be written with it.
    pub fn takes_draws(self) -> bool {
        matches!(
            self,
            Target::Mujoco | Target::IsaacLab | Target::Newton | Target::Bam | Target::DomainJson
        )
    }

    /// Whether it is the friction of a simulated joint: the whole friction, without gain, limit and watchdog.
    pub fn is_simulated(self) -> bool {
        matches!(self, Target::Mujoco | Target::Modelica) || self.is_joint()
    }

    /// Whether it is a map along the position of what stands beside friction, without friction itself.
    pub fn is_map(self) -> bool {
        matches!(self, Target::CoggingMap | Target::Backlash)
    }

    /// The name of its number type with the smallest range.
    pub(crate) fn narrowest(self) -> &'static str {
        match self {
            Target::C | Target::Cpp => "float",
            Target::St | Target::TcPou | Target::PlcOpen => "REAL",
            Target::Rust => "f32",
            Target::Ros2
            | Target::Mujoco
            | Target::Modelica
            | Target::Urdf
            | Target::Sdf
            | Target::IsaacLab
            | Target::Newton
            | Target::Bam
            | Target::DomainJson
            | Target::Hal
            | Target::Fmu
            | Target::Matlab
            | Target::Tf5200
            | Target::DriveTable
            | Target::CoggingMap
            | Target::Backlash => "double",
        }
    }
}

/// A text that names no target.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0:?} is no target; allowed: {names}", names = Target::ALL.map(Target::name).join(", "))]
pub struct UnknownTarget(pub String);

impl std::str::FromStr for Target {
    type Err = UnknownTarget;

    fn from_str(name: &str) -> Result<Self, UnknownTarget> {
        let mut all = Self::ALL.into_iter();
        all.find(|own| own.name() == name)
            .ok_or_else(|| UnknownTarget(name.into()))
    }
}

impl std::fmt::Display for Target {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.name())
    }
}

/// The files of a model for a target; FMUs with their source only, [`fmu`](crate::fmu) makes those with binaries.
///
/// # Errors
/// If the target cannot express the model: its names, numbers or law.
pub fn export(model: &Model, target: Target) -> Result<Vec<File>, Error> {
    check::check(model, target.narrowest())?;
    let mut files = of_target(model, target)?;
    let own = domain::Own::axis(model);
    if target == Target::DomainJson || target.takes_draws() && model.draws.is_some() {
        own.in_newtons(target.name())?;
        let head = domain::Head::axis(model);
        files.extend(domain::files(&head, &[own], model.draws.as_ref()));
    }
    Ok(files)
}

fn of_target(model: &Model, target: Target) -> Result<Vec<File>, Error> {
    match target {
        Target::C => c::files(model),
        Target::Cpp => cpp::files(model),
        Target::Ros2 => ros2::files(model),
        Target::St => st::files(model),
        Target::TcPou => st::twincat(model),
        Target::PlcOpen => st::plcopen(model),
        Target::Rust => rust::files(model),
        Target::Mujoco => mujoco::files(model),
        Target::Modelica => modelica::files(model),
        Target::Urdf => joint::urdf(model),
        Target::Sdf => joint::sdf(model),
        Target::IsaacLab => joint::isaac_lab(model),
        Target::Newton => newton::axis(model),
        Target::Bam => bam::axis(model),
        Target::DomainJson => Ok(Vec::new()),
        Target::Hal => hal::files(model),
        Target::Fmu => fmu::fmu(model, &mut |_, _| None),
        Target::Matlab => matlab::files(model),
        Target::Tf5200 => tf5200::files(model),
        Target::DriveTable => drive_table::files(model),
        Target::CoggingMap => cogging_map::files(model),
        Target::Backlash => backlash::files(model),
    }
}
