//! Why a URDF or a change to a robot was refused: the line, what was found, what is allowed.

/// A URDF that cannot be read, or a request that names what the robot does not have. Lines are counted from 1.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// More text or elements than are read.
    #[error(
        "the URDF has more than {most} {what}; shorten it, for instance by its meshes' comments"
    )]
    Large {
        /// What there is too much of.
        what: &'static str,
        /// Most of it.
        most: usize,
    },
    /// Not well-formed XML.
    #[error("line {line}: not XML: {reason}; correct the file or export it again")]
    NotXml {
        /// Where.
        line: usize,
        /// What the XML parser found.
        reason: String,
    },
    /// The root element is another one.
    #[error("line {line}: the file starts with <{found}>; a URDF starts with <robot>")]
    NoRobot {
        /// Where.
        line: usize,
        /// Name of the root element.
        found: String,
    },
    /// A xacro file, which is a macro text for a URDF.
    #[error("line {line}: this is a xacro file; expand it with\n  xacro in.urdf.xacro > out.urdf")]
    Xacro {
        /// Where the first macro is.
        line: usize,
    },
    /// An element or attribute that has to be there.
    #[error("line {line}: <{element}> has no {missing}; add it")]
    Missing {
        /// Where the element is.
        line: usize,
        /// Name of the element.
        element: &'static str,
        /// What it lacks.
        missing: &'static str,
    },
    /// Text that is not the numbers wanted.
    #[error("line {line}: {attribute}=\"{found}\"; allowed: {allowed}")]
    Number {
        /// Where the element is.
        line: usize,
        /// Name of the attribute.
        attribute: &'static str,
        /// Its value.
        found: String,
        /// What is allowed.
        allowed: &'static str,
    },
    /// A name that two links or two joints have.
    #[error("line {line}: {what} \"{name}\" is already defined in line {first}; rename one")]
    Duplicate {
        /// Where the second is.
        line: usize,
        /// "link" or "joint".
        what: &'static str,
        /// Name.
        name: String,
        /// Line of the first.
        first: usize,
    },
    /// A joint type that URDF does not have.
    #[error(
        "line {line}: joint \"{joint}\" has type \"{found}\"; allowed: revolute, continuous, prismatic, fixed"
    )]
    JointType {
        /// Where the joint is.
        line: usize,
        /// Name of the joint.
        joint: String,
        /// Its type.
        found: String,
    },
    /// A floating or planar joint.
    #[error(
        "line {line}: joint \"{joint}\" is {found}, but the robot needs a fixed base; set type=\"fixed\" for the \
         stand the robot was identified on, or delete the joint and the link above it"
    )]
    FreeBase {
        /// Where the joint is.
        line: usize,
        /// Name of the joint.
        joint: String,
        /// "floating" or "planar".
        found: String,
    },
    /// A joint whose parent or child is not a link of the file.
    #[error(
        "line {line}: joint \"{joint}\" refers to link \"{link}\", which does not exist; add it or correct the name"
    )]
    UnknownLink {
        /// Where the joint is.
        line: usize,
        /// Name of the joint.
        joint: String,
        /// Name of the link.
        link: String,
    },
    /// A link that is the child of two joints.
    #[error(
        "line {line}: joint \"{joint}\" moves link \"{link}\", which joint \"{other}\" moves already; a closed chain \
         has to be cut: delete one of the joints"
    )]
    TwoParents {
        /// Where the second joint is.
        line: usize,
        /// Name of the second joint.
        joint: String,
        /// Name of the link.
        link: String,
        /// Name of the first joint.
        other: String,
    },
    /// Links that hang on one another in a ring.
    #[error("line {line}: link \"{link}\" is its own ancestor; delete one joint of that ring")]
    Cycle {
        /// Where the link is.
        line: usize,
        /// Name of the link.
        link: String,
    },
    /// Several links that no joint moves.
    #[error(
        "line {line}: links \"{first}\" and \"{second}\" both have no parent; connect one with a fixed joint or delete it"
    )]
    SeveralRoots {
        /// Where the second is.
        line: usize,
        /// Name of the first.
        first: String,
        /// Name of the second.
        second: String,
    },
    /// A joint axis of no direction.
    #[error("line {line}: joint \"{joint}\" has the axis 0 0 0; allowed: any other vector")]
    Axis {
        /// Where the axis is.
        line: usize,
        /// Name of the joint.
        joint: String,
    },
    /// A joint that follows one that it cannot follow.
    #[error(
        "line {line}: joint \"{joint}\" mimics \"{of}\"; allowed: another joint that mimics none itself"
    )]
    Mimic {
        /// Where the joint is.
        line: usize,
        /// Name of the joint.
        joint: String,
        /// Name of the joint it follows.
        of: String,
    },
    /// A robot of more moving joints than are computed.
    #[error("the robot has {found} moving joints; allowed: 1 to {most}")]
    Joints {
        /// Moving joints.
        found: usize,
        /// Most of them.
        most: usize,
    },
    /// A link that is not there or cannot be what it is asked for.
    #[error("link \"{name}\": {reason}")]
    Link {
        /// Name asked for.
        name: String,
        /// What is wrong.
        reason: &'static str,
    },
    /// A joint that is not there, or is asked for twice.
    #[error("joint \"{name}\": {reason}")]
    Joint {
        /// Name asked for.
        name: String,
        /// What is wrong.
        reason: &'static str,
    },
    /// A value given that is out of range.
    #[error("{what} = {found}; allowed: {allowed}")]
    Value {
        /// What value.
        what: &'static str,
        /// What was given.
        found: f64,
        /// What is allowed.
        allowed: &'static str,
    },
    /// A number of values given that does not fit the robot.
    #[error("{what}: {found} values; allowed: {wanted}")]
    Length {
        /// What values.
        what: &'static str,
        /// How many were given.
        found: usize,
        /// How many are needed.
        wanted: usize,
    },
}
