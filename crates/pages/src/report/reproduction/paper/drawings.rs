//! Drawings of what the experiments are about, made for this report.

use stiction_report::{Block, Drawing};

/// The law, and the axis in presliding.
pub(super) fn law() -> Block {
    Block::Columns(vec![
        Drawing::new(
            "The LuGre law (FIG. 2)",
            include_str!("drawings/bristles.svg"),
        )
        .half()
        .caption(
            "Bristles of mean deflection z carry the force and slip as they reach their limit.",
        )
        .into(),
        Drawing::new(
            "The axis below break-away (FIG. 8)",
            include_str!("drawings/presliding.svg"),
        )
        .half()
        .caption("A system of second order, as long as the bristles do not slip.")
        .into(),
    ])
}

/// The steps of the search.
pub(super) fn search() -> Drawing {
    Drawing::new(
        "The annealing genetic search (FIG. 3)",
        include_str!("drawings/search.svg"),
    )
}

/// The axis under control.
pub(super) fn control() -> Drawing {
    Drawing::new(
        "The axis under control with compensation (FIG. 18)",
        include_str!("drawings/loop.svg"),
    )
}
