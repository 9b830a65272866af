//! The report of published experiments run again.

mod checks;
mod paper;

use checks::{table, verdict};
use stiction_files::reproduce_file::ReproduceFile;
use stiction_report::{Axis, Color, Document, Figure, Layer, Panel};
use stiction_servo::c95::Experiment;
use stiction_workflows::reproduce::{Body, Reproduction};

/// The report of published experiments that were run again.
pub fn reproduction(outcome: &Reproduction) -> Document {
    match &outcome.body {
        Body::Canudas1995(experiments) => canudas_1995(&outcome.file, experiments),
        Body::Zhang2025(paper) => paper::report(&outcome.file, paper),
    }
}

fn canudas_1995(file: &ReproduceFile, experiments: &[Experiment]) -> Document {
    let mut document = Document::new("The experiments of 1995")
        .subtitle(
            "Canudas de Wit, Olsson, Åström, Lischinsky 1995 (doi 10.1109/9.376053): a block of 1 kg, \
             σ₀ 10⁵ N/m, σ₁ √10⁵ N·s/m (constant), σ₂ 0.4 N·s/m, Fc 1 N, Fs 1.5 N, vs 1 mm/s",
        )
        .footer(format!("stiction {}", file.version))
        .block(verdict(file))
        .paragraph(
            "References: the equations integrated by an adaptive Radau method at a relative tolerance \
             of 10⁻⁹ to 10⁻¹⁰, not by stiction.",
        );
    for experiment in experiments {
        let letter = experiment.letter.to_string();
        let checks = file.checks.iter().filter(|c| c.experiment == letter);
        document = document
            .heading(2, format!("{letter}: {}", experiment.title))
            .block(table(checks));
        document = document.block(figure(experiment));
    }
    document
}

fn figure(experiment: &Experiment) -> Figure {
    let [x, y] = experiment.axes.map(|(name, unit)| Axis::new(name, unit));
    // Rates of break-away span three decades.
    let x = match experiment.letter {
        'D' => x.log(),
        _ => x,
    };
    let mut panel = Panel::new(x, y).height(260.0);
    let several = experiment.curves.len() > 1;
    for (curve, color) in experiment.curves.iter().zip(Color::CYCLE) {
        let mut line = Layer::line(curve.x.clone(), curve.y.clone()).color(color);
        if several {
            line = line.label(curve.label.as_str());
        }
        panel = panel.layer(line);
        if experiment.letter == 'D' {
            panel = panel.layer(
                Layer::points(curve.x.clone(), curve.y.clone())
                    .color(color)
                    .width(6.0)
                    .opacity(1.0),
            );
        }
    }
    Figure::new(experiment.title)
        .panel(panel)
        .caption(match experiment.letter {
            'B' => "Loaded to 95 % of the static level either way, the block returns to where it was.",
            'C' => "Friction is larger while the velocity grows than while it falls, the more so the \
                    quicker it changes.",
            'D' => "The faster the force grows, the less of the static level has time to build up.",
            'E' => "The spring is pulled at 0.1 m/s.",
            'F' => "The integral of a PID works against friction and never comes to rest; with the \
                    observer of friction it does.",
            _ => "A force of 0.9 N with 0.3 N at 1 Hz on it, below break-away: LuGre creeps, which a \
                  real block does not.",
        })
}
