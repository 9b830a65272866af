//! What a URDF is read as, and why one is refused.

use crate::common::{ARM7, TREE, robot};
use stiction_rigid::urdf::Kind;
use stiction_rigid::{Document, Error, Finding, Robot};

fn read(urdf: &str) -> Result<Robot, Error> {
    Robot::new(&Document::parse(urdf)?)
}

/// The message of a refused URDF.
fn refused(urdf: &str) -> String {
    read(urdf).unwrap_err().to_string()
}

/// Two links and a joint of these attributes and elements, from line 4 on.
fn two(attributes: &str, elements: &str) -> String {
    format!(
        "<robot>\n<link name=\"a\"/>\n<link name=\"b\"/>\n<joint {attributes}>\n<parent link=\"a\"/>\n\
         <child link=\"b\"/>\n{elements}</joint>\n</robot>"
    )
}

#[test]
fn refusals_name_line_and_remedy() {
    let revolute = "name=\"j\" type=\"revolute\"";
    let inertial = |inside: &str| {
        format!("<robot>\n<link name=\"a\">\n<inertial>\n{inside}\n</inertial></link></robot>")
    };
    let moments = "<inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"/>";
    let cases = [
        (String::new(), "line 1: not XML: "),
        ("<robot>\n<link name=\"a\">\n</robot>".into(), "line 3: not XML: "),
        ("\n<sdf/>".into(), "line 2: the file starts with <sdf>; a URDF starts with <robot>"),
        (
            "<robot xmlns:xacro=\"http://www.ros.org/wiki/xacro\">\n<xacro:include filename=\"a\"/></robot>".into(),
            "line 2: this is a xacro file; expand it with\n  xacro in.urdf.xacro > out.urdf",
        ),
        ("<robot>\n<xacro:arm/></robot>".into(), "line 2: this is a xacro file"),
        (two(revolute, "<axis xyz=\"0 0 ${z}\"/>\n"), "line 7: this is a xacro file"),
        ("<robot/>".into(), "line 1: <robot> has no link; add it"),
        ("<robot>\n<link/></robot>".into(), "line 2: <link> has no name; add it"),
        (
            "<robot><link name=\"a\"/>\n<link name=\"a\"/></robot>".into(),
            "line 2: link \"a\" is already defined in line 1; rename one",
        ),
        (
            two("name=\"j\" type=\"ball\"", ""),
            "line 4: joint \"j\" has type \"ball\"; allowed: revolute, continuous, prismatic, fixed",
        ),
        (two("name=\"j\" type=\"floating\"", ""), "line 4: joint \"j\" is floating, but the robot needs a fixed base; set"),
        (two("name=\"j\" type=\"planar\"", ""), "line 4: joint \"j\" is planar, but"),
        (
            two(revolute, "").replace("link=\"b\"", "link=\"c\""),
            "line 4: joint \"j\" refers to link \"c\", which does not exist",
        ),
        (
            two(revolute, "</joint><joint name=\"k\" type=\"fixed\"><parent link=\"a\"/><child link=\"b\"/>"),
            "line 7: joint \"k\" moves link \"b\", which joint \"j\" moves already",
        ),
        (
            two(revolute, "</joint><joint name=\"k\" type=\"fixed\"><parent link=\"b\"/><child link=\"a\"/>"),
            "line 2: link \"a\" is its own ancestor",
        ),
        (
            two(revolute, "</joint><link name=\"c\"/><joint name=\"k\" type=\"fixed\"><parent link=\"c\"/><child link=\"c\"/>"),
            "line 7: link \"c\" is its own ancestor",
        ),
        (
            two(revolute, "</joint><link name=\"c\"/><joint name=\"k\" type=\"fixed\"><parent link=\"b\"/><child link=\"b\"/>"),
            "line 7: joint \"k\" moves link \"b\", which joint \"j\" moves already",
        ),
        (
            "<robot><link name=\"a\"/>\n<link name=\"b\"/></robot>".into(),
            "line 2: links \"a\" and \"b\" both have no parent",
        ),
        (two(revolute, "<axis xyz=\"0 0 0\"/>"), "line 7: joint \"j\" has the axis 0 0 0; allowed: any other vector"),
        (two(revolute, "<axis xyz=\"0 0\"/>"), "line 7: xyz=\"0 0\"; allowed: three numbers"),
        (two(revolute, "<origin rpy=\"0 0 inf\"/>"), "line 7: rpy=\"0 0 inf\"; allowed: three numbers, -1e50 to 1e50"),
        (two(revolute, "<limit effort=\"much\"/>"), "line 7: effort=\"much\"; allowed: a finite number"),
        (
            two(revolute, "<mimic joint=\"j\"/>"),
            "line 4: joint \"j\" mimics \"j\"; allowed: another joint that mimics none itself",
        ),
        (two("name=\"j\" type=\"fixed\"", ""), "the robot has 0 moving joints; allowed: 1 to 128"),
        (inertial(&format!("<mass value=\"-1\"/>{moments}")), "line 4: value=\"-1\"; allowed: 0 or more"),
        (inertial(&format!("<mass value=\"NaN\"/>{moments}")), "line 4: value=\"NaN\"; allowed: a finite number"),
        (inertial("<mass value=\"1\"/>"), "line 3: <inertial> has no inertia; add it"),
        (inertial(moments), "line 3: <inertial> has no mass; add it"),
    ];
    for (urdf, wanted) in cases {
        let message = refused(&urdf);
        assert!(message.starts_with(wanted), "{urdf}\n{message}\n{wanted}");
    }
}

#[test]
fn too_much_text_is_refused() {
    let long = " ".repeat((16 << 20) + 1);
    let many = format!("<robot>{}</robot>", "<link/>".repeat(10_000));
    let deep = format!("<robot>{}", "<a>".repeat(1_000_000));
    let wide: String = (0..2000).map(|i| format!("a{i} = '' ")).collect();
    for urdf in [long, many, deep, format!("<robot {wide}/>")] {
        assert!(matches!(Document::parse(&urdf), Err(Error::Large { .. })));
    }
}

#[test]
fn chain_of_links_to_the_limit_is_read() {
    let mut urdf = String::from("<robot><link name=\"l0\"/>");
    for i in 1..2000 {
        let kind = if i % 20 == 1 { "prismatic" } else { "fixed" };
        urdf += &format!(
            "<link name=\"l{i}\"/><joint name=\"j{i}\" type=\"{kind}\"><parent link=\"l{}\"/><child link=\"l{i}\"/></joint>",
            i - 1
        );
    }
    let robot = robot(&(urdf + "</robot>"));
    assert_eq!(robot.len(), 100);
    assert_eq!(robot.findings().len(), 100);
}

#[test]
fn joints_are_depth_first_in_the_order_of_the_file() {
    let robot = robot(TREE);
    let names: Vec<&str> = robot.joints().iter().map(|j| j.name.as_str()).collect();
    let wanted = [
        "rail",
        "left_shoulder",
        "left_elbow",
        "left_finger",
        "left_thumb",
        "right_shoulder",
        "right_slide",
        "right_wrist",
    ];
    assert_eq!(names, wanted);
    let ends: Vec<usize> = robot.bodies().iter().map(|b| b.end).collect();
    assert_eq!(ends, [8, 5, 5, 4, 5, 8, 8, 8]);
    assert_eq!(robot.joints()[4].mimic.unwrap().of, 3);
    assert_eq!(robot.joints()[5].kind, Kind::Continuous);
    let rail = &robot.joints()[0];
    assert_eq!((rail.damping, rail.friction), (0.5, 0.2));
    assert_eq!(
        (rail.limit.lower, rail.limit.velocity),
        (Some(-3.0), Some(3.0))
    );
}

#[test]
fn heaviest_fixed_link_carries_where_the_moved_one_has_no_mass() {
    let robot = robot(ARM7);
    let carrier = |i: usize| robot.links()[robot.bodies()[i].carrier].name.as_str();
    assert_eq!([carrier(3), carrier(6)], ["link4", "hand"]);
    assert_eq!(robot.findings(), []);
}

#[test]
fn impossible_inertias_are_found() {
    let heavy = |moments: [f64; 3]| {
        let [x, y, z] = moments;
        let inertial = format!(
            "<link name=\"b\"><inertial>\n<mass value=\"1\"/><inertia ixx=\"{x}\" ixy=\"0\" ixz=\"0\" iyy=\"{y}\" \
             iyz=\"0\" izz=\"{z}\"/></inertial></link>"
        );
        let urdf = two("name=\"j\" type=\"revolute\"", "").replace("<link name=\"b\"/>", &inertial);
        robot(&urdf).findings().to_vec()
    };
    assert_eq!(heavy([1.0, 2.0, 3.0]), []);
    let unphysical = |principal| {
        vec![Finding::NotPhysical {
            link: "b".into(),
            line: 3,
            principal,
        }]
    };
    assert_eq!(heavy([1.0, 3.1, 2.0]), unphysical([1.0, 2.0, 3.1]));
    assert_eq!(heavy([0.0, 1.0, 1.0]), unphysical([0.0, 1.0, 1.0]));
    let bare = robot(&two("name=\"j\" type=\"revolute\"", ""));
    let none = Finding::NoInertia {
        link: "b".into(),
        line: 3,
    };
    assert_eq!(bare.findings(), [none]);
}

#[test]
fn joint_that_mimics_none_that_moves_is_independent() {
    let robot = robot(&two("name=\"j\" type=\"revolute\"", "<mimic joint=\"k\"/>"));
    assert_eq!(robot.joints()[0].mimic, None);
    let found = Finding::NoLeader {
        joint: "j".into(),
        line: 4,
        of: "k".into(),
    };
    assert_eq!(robot.findings()[0], found);
}
