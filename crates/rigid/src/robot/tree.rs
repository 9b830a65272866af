//! Links and joints of a URDF as a tree of bodies.

use super::{Body, Finding, Follows, GRAVITY, Joint, MOST_JOINTS, PlacedLink, Robot};
use crate::Error;
use crate::inertia::{self, Parameters};
use crate::space::{Frame, IDENTITY, Matrix, product};
use crate::urdf::{self, Document, Kind};
use std::array::from_fn;
use std::collections::HashMap;

/// Rotation of a joint's frame in its parent body at position q: `still + sin q · sine + cos q · cosine` (Rodrigues).
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Turn {
    pub still: Matrix<f64>,
    pub sine: Matrix<f64>,
    pub cosine: Matrix<f64>,
    /// False for a prismatic joint.
    pub revolute: bool,
}

impl Turn {
    fn of(joint: &Joint) -> Self {
        let [x, y, z] = joint.axis;
        let outer: Matrix<f64> = from_fn(|i| from_fn(|j| joint.axis[i] * joint.axis[j]));
        let rest = from_fn(|i| from_fn(|j| IDENTITY[i][j] - outer[i][j]));
        let skew = [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]];
        let fixed = &joint.frame.rotation;
        Self {
            still: product(fixed, &outer),
            sine: product(fixed, &skew),
            cosine: product(fixed, &rest),
            revolute: joint.kind != Kind::Prismatic,
        }
    }
}

/// How the links hang on one another.
struct Tree {
    /// Index of the root link.
    root: usize,
    /// Joints on each link with the link they move, in the order of the file.
    children: Vec<Vec<(usize, usize)>>,
}

impl Tree {
    fn of(document: &Document) -> Result<Self, Error> {
        let numbered = document.links.iter().enumerate();
        let index: HashMap<&str, usize> =
            numbered.map(|(i, link)| (link.name.as_str(), i)).collect();
        let mut children = vec![Vec::new(); document.links.len()];
        let mut mover: Vec<Option<usize>> = vec![None; document.links.len()];
        for (number, joint) in document.joints.iter().enumerate() {
            let find = |name: &str| {
                index.get(name).copied().ok_or_else(|| Error::UnknownLink {
                    line: joint.line,
                    joint: joint.name.clone(),
                    link: name.to_string(),
                })
            };
            let (parent, child) = (find(&joint.parent)?, find(&joint.child)?);
            if let Some(other) = mover[child].replace(number) {
                return Err(Error::TwoParents {
                    line: joint.line,
                    joint: joint.name.clone(),
                    link: joint.child.clone(),
                    other: document.joints[other].name.clone(),
                });
            }
            children[parent].push((number, child));
        }
        let link = |i: usize| &document.links[i];
        let mut roots = (0..mover.len()).filter(|i| mover[*i].is_none());
        let Some(root) = roots.next() else {
            return Err(match document.links.first() {
                Some(link) => Error::Cycle {
                    line: link.line,
                    link: link.name.clone(),
                },
                None => too_few_or_many(0),
            });
        };
        if let Some(second) = roots.next() {
            return Err(Error::SeveralRoots {
                line: link(second).line,
                first: link(root).name.clone(),
                second: link(second).name.clone(),
            });
        }
        Ok(Self { root, children })
    }

    /// Link, joint and moved link of the joints on a link, last first.
    fn hanging(&self, link: usize) -> impl Iterator<Item = (usize, usize, usize)> + use<'_> {
        let joints = self.children[link].iter().rev();
        joints.map(move |(joint, child)| (link, *joint, *child))
    }
}

pub(super) fn build(document: &Document) -> Result<Robot, Error> {
    let tree = Tree::of(document)?;
    let at_root = |link: &urdf::Link| PlacedLink {
        name: link.name.clone(),
        line: link.line,
        body: None,
        frame: Frame::IDENTITY,
    };
    let mut links: Vec<PlacedLink> = document.links.iter().map(at_root).collect();
    let mut seen = vec![false; links.len()];
    let mut joints: Vec<Joint> = Vec::new();
    // Index of each joint of the document among the moving ones.
    let mut moving = vec![None; document.joints.len()];
    // The link that each joint moves, then those fixed to it.
    let mut members: Vec<Vec<usize>> = Vec::new();
    seen[tree.root] = true;
    let mut stack: Vec<(usize, usize, usize)> = tree.hanging(tree.root).collect();
    while let Some((parent, number, child)) = stack.pop() {
        seen[child] = true;
        let stated = &document.joints[number];
        let (body, inner) = (links[parent].body, Frame::of(&stated.origin));
        let frame = links[parent].frame.of_inner(&inner);
        if stated.kind == Kind::Fixed {
            (links[child].body, links[child].frame) = (body, frame);
            if let Some(body) = body {
                members[body].push(child);
            }
        } else {
            links[child].body = Some(joints.len());
            moving[number] = Some(joints.len());
            members.push(vec![child]);
            joints.push(joint(stated, body, frame));
        }
        stack.extend(tree.hanging(child));
    }
    if let Some(link) = document.links.iter().zip(&seen).find(|(_, seen)| !**seen) {
        return Err(Error::Cycle {
            line: link.0.line,
            link: link.0.name.clone(),
        });
    }
    if joints.is_empty() || joints.len() > MOST_JOINTS {
        return Err(too_few_or_many(joints.len()));
    }
    let mut findings = Vec::new();
    follow(document, &moving, &mut joints, &mut findings)?;
    let parts = members
        .iter()
        .map(|m| body(document, &links, m, &mut findings));
    let mut bodies: Vec<Body> = parts.collect();
    for i in (0..bodies.len()).rev() {
        bodies[i].end = bodies[i].end.max(i + 1);
        if let Some(parent) = joints[i].parent {
            bodies[parent].end = bodies[parent].end.max(bodies[i].end);
        }
    }
    Ok(Robot {
        turns: joints.iter().map(Turn::of).collect(),
        joints,
        bodies,
        links,
        findings,
        gravity: GRAVITY,
    })
}

fn too_few_or_many(found: usize) -> Error {
    let most = MOST_JOINTS;
    Error::Joints { found, most }
}

/// A joint that moves, as yet following none.
fn joint(stated: &urdf::Joint, parent: Option<usize>, frame: Frame) -> Joint {
    Joint {
        name: stated.name.clone(),
        line: stated.line,
        kind: stated.kind,
        parent,
        frame,
        axis: stated.axis,
        limit: stated.limit,
        damping: stated.damping,
        friction: stated.friction,
        mimic: None,
    }
}

/// Resolves which joints follow which.
fn follow(
    document: &Document,
    moving: &[Option<usize>],
    joints: &mut [Joint],
    findings: &mut Vec<Finding>,
) -> Result<(), Error> {
    let numbered = document.joints.iter().enumerate();
    let index: HashMap<&str, usize> = numbered
        .map(|(i, joint)| (joint.name.as_str(), i))
        .collect();
    for (number, stated) in document.joints.iter().enumerate() {
        let (Some(i), Some(mimic)) = (moving[number], &stated.mimic) else {
            continue;
        };
        let leader = index.get(mimic.of.as_str()).copied();
        let Some((leader, of)) = leader.and_then(|leader| Some((leader, moving[leader]?))) else {
            findings.push(Finding::NoLeader {
                joint: stated.name.clone(),
                line: stated.line,
                of: mimic.of.clone(),
            });
            continue;
        };
        if document.joints[leader].mimic.is_some() {
            return Err(Error::Mimic {
                line: stated.line,
                joint: stated.name.clone(),
                of: mimic.of.clone(),
            });
        }
        joints[i].mimic = Some(Follows {
            of,
            multiplier: mimic.multiplier,
            offset: mimic.offset,
        });
    }
    Ok(())
}

/// The body of the links that one joint moves.
fn body(
    document: &Document,
    links: &[PlacedLink],
    members: &[usize],
    findings: &mut Vec<Finding>,
) -> Body {
    let mass = |link: &usize| document.links[*link].inertial.map_or(0.0, |i| i.mass);
    let first = members[0];
    // The first of those of equal mass.
    let heaviest = members
        .iter()
        .rev()
        .max_by(|a, b| mass(a).total_cmp(&mass(b)));
    let carrier = if mass(&first) > 0.0 {
        first
    } else {
        *heaviest.unwrap_or(&first)
    };
    let (mut own, mut attached): (Parameters, Parameters) = ([0.0; 10], [0.0; 10]);
    for &member in members {
        let link = &document.links[member];
        let Some(inertial) = &link.inertial else {
            continue;
        };
        let parameters = inertia::moved(&inertia::of_inertial(inertial), &links[member].frame);
        let part = if member == carrier {
            &mut own
        } else {
            &mut attached
        };
        *part = inertia::sum(part, &parameters);
        let principal = inertia::principal_moments(&inertial.inertia);
        let nothing = inertial.mass == 0.0 && inertial.inertia == [0.0; 6];
        if !nothing && (inertial.mass == 0.0 || !inertia::possible(principal)) {
            findings.push(Finding::NotPhysical {
                link: link.name.clone(),
                line: inertial.line,
                principal,
            });
        }
    }
    if mass(&carrier) == 0.0 {
        findings.push(Finding::NoInertia {
            link: document.links[first].name.clone(),
            line: document.links[first].line,
        });
    }
    Body {
        carrier,
        own,
        attached,
        end: 0,
    }
}
