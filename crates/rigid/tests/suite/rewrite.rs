//! Rewriting a URDF: what changes, what stays byte for byte.

use crate::common::{ALL, ARM7, Dice, apart};
use proptest::prelude::*;
use stiction_rigid::urdf::{Inertial, Pose};
use stiction_rigid::{Document, NewDynamics, NewInertial, Robot, inertia, rewrite};

fn inertial(mass: f64) -> Inertial {
    Inertial {
        mass,
        origin: Pose {
            xyz: [0.25, 0.0, -1e-7],
            rpy: [0.0; 3],
        },
        inertia: [0.1, -0.02, 0.3, 0.04, 0.05, 0.6],
        line: 0,
    }
}

fn new(link: &str) -> NewInertial<'_> {
    let inertial = inertial(1.5);
    NewInertial { link, inertial }
}

fn friction(joint: &str) -> NewDynamics<'_> {
    NewDynamics {
        joint,
        damping: 0.125,
        friction: 3.0,
    }
}

#[test]
fn values_are_replaced_between_their_quotes() {
    let text = "<?xml version=\"1.0\"?>\r\n<robot name='r'>\r\n\t<link name='a' />\r\n\t<link name=\"b\"><!-- <mass/> -->\r\n\
        \t\t<inertial>\r\n\t\t\t<mass  value = '9' extra='é'/>\r\n\t\t\t<inertia ixx='1' ixy='0.04' ixz='0.040' iyy='1' \
        iyz='0' izz='1'/><!--x-->\r\n\t\t</inertial>\r\n\t</link>\r\n\t<joint name='j' type='revolute'>\r\n\
        \t\t<parent link='a'/>\r\n\t\t<child link='b'/>\r\n\t</joint>\r\n</robot>\r\n";
    let wanted = text
        .replace("'9'", "'1.5'")
        .replace("ixx='1' ixy='0.04'", "ixx='0.1' ixy='-0.02'")
        .replace("iyy='1' iyz='0' izz='1'/>", "iyy='0.3' iyz='0.05' izz='0.6'/>\r\n\t\t\t<origin xyz=\"0.25 0.0 -1e-7\" rpy=\"0 0 0\"/>")
        .replace("<child link='b'/>", "<child link='b'/>\r\n\t\t<dynamics damping=\"0.125\" friction=\"3.0\"/>");
    let found = rewrite(text, &[new("b")], &[friction("j")]).unwrap();
    assert_eq!(found, wanted);
    let document = Document::parse(&found).unwrap();
    let read = document.links[1].inertial.unwrap();
    assert_eq!(Inertial { line: 0, ..read }, inertial(1.5));
    assert_eq!(
        (document.joints[0].damping, document.joints[0].friction),
        (0.125, 3.0)
    );
    assert_eq!(
        rewrite(&found, &[new("b")], &[friction("j")]).unwrap(),
        found
    );
}

#[test]
fn missing_inertias_are_inserted_with_indentation() {
    let inserted = |text: &str| {
        let found = rewrite(text, &[new("a")], &[]).unwrap();
        let read = Document::parse(&found).unwrap().links[0].inertial.unwrap();
        assert_eq!(Inertial { line: 0, ..read }, inertial(1.5));
        assert_eq!(rewrite(&found, &[new("a")], &[]).unwrap(), found);
        found
    };
    let block = |indent: &str, unit: &str| {
        format!(
            "\n{indent}<inertial>\n{indent}{unit}<origin xyz=\"0.25 0.0 -1e-7\" rpy=\"0 0 0\"/>\n{indent}{unit}<mass \
             value=\"1.5\"/>\n{indent}{unit}<inertia ixx=\"0.1\" ixy=\"-0.02\" ixz=\"0.04\" iyy=\"0.3\" iyz=\"0.05\" \
             izz=\"0.6\"/>\n{indent}</inertial>"
        )
    };
    for empty in [
        "<link name=\"a\" />",
        "<link name=\"a\"></link>",
        "<link name=\"a\">\n   </link>",
    ] {
        let found = inserted(&format!("<robot>\n   {empty}\n</robot>"));
        let wanted = format!(
            "<robot>\n   <link name=\"a\">{}\n   </link>\n</robot>",
            block("      ", "   ")
        );
        assert_eq!(found, wanted);
    }
    // After the other children.
    let text = "<robot>\n <link name=\"a\">\n  <visual/>\n </link>\n</robot>";
    let wanted = text.replace("<visual/>", &format!("<visual/>{}", block("  ", " ")));
    assert_eq!(inserted(text), wanted);
    // In one line, and with a prefix.
    let line = inserted("<robot><link name='a'/></robot>");
    assert!(!line.contains('\n'));
    let prefixed = inserted("<u:robot xmlns:u='urdf'>\n<u:link name='a'/></u:robot>");
    assert!(prefixed.contains("<u:mass value"));
}

#[test]
fn attributes_that_are_missing_are_added() {
    let joint = |dynamics: &str| {
        format!(
            "<robot><link name='a'/><link name='b'/><joint name='j' type='revolute'><parent link='a'/><child \
             link='b'/>{dynamics}</joint></robot>"
        )
    };
    for (before, after) in [
        (
            "<dynamics />",
            "<dynamics damping=\"0.125\" friction=\"3.0\" />",
        ),
        (
            "<dynamics friction='1'/>",
            "<dynamics friction='3.0' damping='0.125'/>",
        ),
        (
            "<dynamics damping='0.1250' friction=' 3 '/>",
            "<dynamics damping='0.1250' friction=' 3 '/>",
        ),
    ] {
        let found = rewrite(&joint(before), &[], &[friction("j")]).unwrap();
        assert_eq!(found, joint(after));
    }
}

#[test]
fn impossible_changes_are_refused() {
    let refused = |inertials: &[NewInertial], dynamics: &[NewDynamics]| {
        rewrite(ARM7, inertials, dynamics).unwrap_err().to_string()
    };
    assert_eq!(
        refused(&[new("x")], &[]),
        "link \"x\": no such link; correct the name"
    );
    assert_eq!(
        refused(&[], &[friction("x")]),
        "joint \"x\": no such joint; correct the name"
    );
    assert!(refused(&[new("hand"), new("hand")], &[]).contains("two inertias"));
    assert!(refused(&[], &[friction("joint1"), friction("joint1")]).contains("twice"));
    let mut bad = new("hand");
    bad.inertial.origin.rpy[1] = 1.0;
    assert!(refused(&[bad.clone()], &[]).starts_with("rpy of an inertia = 1; allowed: 0"));
    bad.inertial.mass = f64::NAN;
    assert_eq!(refused(&[bad], &[]), "mass = NaN; allowed: finite");
    rewrite("<robot", &[], &[]).unwrap_err();
}

/// All parameters of a robot written and read back: the same to rounding, and nothing else changes.
#[test]
fn parameters_come_back_from_the_file() {
    let mut dice = Dice::new();
    for urdf in ALL {
        let document = Document::parse(urdf).unwrap();
        let robot = Robot::new(&document).unwrap();
        let factor: Vec<f64> = robot
            .parameters()
            .iter()
            .map(|x| x * (1.0 + 0.1 * dice.unit()))
            .collect();
        let bodies = factor.as_chunks::<10>().0;
        // With what is attached as it is.
        let wanted: Vec<inertia::Parameters> = robot
            .bodies()
            .iter()
            .zip(bodies)
            .map(|(body, p)| {
                if p[0] > body.attached[0] {
                    *p
                } else {
                    inertia::sum(&body.own, &body.attached)
                }
            })
            .collect();
        let inertials: Vec<NewInertial> = wanted
            .iter()
            .enumerate()
            .map(|(i, p)| NewInertial {
                link: &robot.links()[robot.bodies()[i].carrier].name,
                inertial: robot.carrier_inertial(i, p).unwrap(),
            })
            .collect();
        let dynamics: Vec<NewDynamics> = robot.joints().iter().map(|j| friction(&j.name)).collect();
        let text = rewrite(urdf, &inertials, &dynamics).unwrap();
        let again = Robot::new(&Document::parse(&text).unwrap()).unwrap();
        assert!(apart(&again.parameters(), &wanted.concat()) < 1e-13);
        assert!(
            again
                .joints()
                .iter()
                .all(|j| (j.damping, j.friction) == (0.125, 3.0))
        );
        assert_eq!(text.lines().count(), urdf.lines().count());
        for (before, after) in urdf.lines().zip(text.lines()) {
            let may_change = ["<origin", "<mass", "<inertia ", "<dynamics"];
            let changes = may_change
                .iter()
                .any(|tag| before.trim_start().starts_with(tag));
            assert!(changes || before == after);
        }
        assert_eq!(rewrite(&text, &inertials, &dynamics).unwrap(), text);
    }
}

proptest! {
    /// Whatever is in and between the elements.
    #[test]
    fn result_can_be_read(between in "[ \t\r\n]{0,6}", inside in "(<!-- -->|<visual/>|[ \t\r\n])*", tail in "[ \n]{0,2}") {
        let text = format!(
            "<robot>{between}<link name='a'{tail}/>{between}<link name='b'>{inside}</link{tail}>{between}<joint name='j' \
             type='prismatic'>{between}<parent link='a'/>{between}<child link='b'/>{inside}</joint>{tail}</robot>{between}"
        );
        let found = rewrite(&text, &[new("b"), new("a")], &[friction("j")]).unwrap();
        let document = Document::parse(&found).unwrap();
        for link in &document.links {
            prop_assert_eq!(link.inertial.map(|i| Inertial { line: 0, ..i }), Some(inertial(1.5)));
        }
        prop_assert_eq!(document.joints[0].damping, 0.125);
        prop_assert_eq!(rewrite(&found, &[new("b"), new("a")], &[friction("j")]).unwrap(), found);
    }
}
