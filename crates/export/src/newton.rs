//! Newton: friction, damping and armature of joints, set by their names.

use crate::domain::{self, Own};
use crate::joint::told;
use crate::template::Fill;
use crate::{Error, File, Model, header};

const SCRIPT: &str = include_str!("../templates/newton/newton.py.in");

/// What Newton calls the numbers of a joint.
const KEYS: [(&str, &str); 3] = [
    ("armature", "armature"),
    ("friction", "frictionloss"),
    ("damping", "damping"),
];

/// The file of one axis.
pub(crate) fn axis(model: &Model) -> Result<Vec<File>, Error> {
    let own = Own::axis(model);
    own.in_newtons("newton")?;
    let head = header::table_comment(&told(model), "# ");
    Ok(files(&model.identifier, head, &[own]))
}

pub(crate) fn files(name: &str, header: String, joints: &[Own]) -> Vec<File> {
    let mut fill = Fill::default();
    fill.set("header", header)
        .set("name", name)
        .set("joints", domain::entries(joints, &KEYS));
    vec![File::text(format!("{name}_newton.py"), fill.render(SCRIPT))]
}
