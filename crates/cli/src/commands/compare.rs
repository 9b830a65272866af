//! `stiction compare`: searches side by side.

use super::put;
use crate::arguments::{self, Common};
use crate::exit::Exit;
use crate::large;
use crate::output;
use crate::progress::Bar;
use stiction_files::{check_folder_of, check_inputs, compare_file};
use stiction_identify::candidates::Scheme;
use stiction_pages::bundle;
use stiction_workflows::Error;
use stiction_workflows::compare::{CompareOptions, Comparison, Cost, Excitation, Input};

/// Runs the searches and writes how they fared.
pub fn run(compare: &arguments::Compare, common: &Common) -> Result<Exit, Error> {
    check_folder_of(&compare.out, compare_file::SCHEMA, compare.force)?;
    check_inputs(&compare.out, compare.logs.iter().chain(&compare.axis))?;
    let options = CompareOptions {
        input: match &compare.problem {
            Some(name) => Input::Named(name.clone()),
            None => Input::Log {
                logs: compare.logs.clone(),
            },
        },
        axis: compare.axis.clone(),
        methods: compare.methods.clone(),
        seeds: compare.seeds,
        evaluations: compare.evaluations,
        noise: compare.noise,
        excitation: compare.excitation.map(|motion| match motion {
            arguments::Excitation::Sine => Excitation::Sine,
            arguments::Excitation::MultiSine => Excitation::MultiSine,
            arguments::Excitation::ThreeSegments => Excitation::ThreeSegments,
            arguments::Excitation::BreakAway => Excitation::BreakAway,
        }),
        rate: compare.rate,
        other_law: compare.other_law,
        decades: compare.decades,
        integrator: match compare.integrator {
            arguments::Integrator::Explin => Scheme::Explin,
            arguments::Integrator::Euler => Scheme::Euler,
            arguments::Integrator::Rk4 => Scheme::RungeKutta,
        },
        cost: compare.cost.map(|cost| match cost {
            arguments::CompareCost::Six => Cost::Six,
            arguments::CompareCost::Separable => Cost::Separable,
            arguments::CompareCost::Position => Cost::Position,
            arguments::CompareCost::Curve => Cost::Curve,
            arguments::CompareCost::Dynamic => Cost::Dynamic,
        }),
        max_samples: compare.max_samples,
    };
    let mut bar = Bar::new(common.json || common.quiet);
    let comparison = Comparison::new(&options, &mut bar)?;
    large::announce(
        stiction_pages::text::announced_comparison(comparison.size()),
        common,
    );
    let runs = large::keeping(&compare.out, compare.resume, |dir, resume| {
        comparison.keep(dir, resume)
    })?;
    let found = comparison.run_keeping(&runs, &mut bar);
    bar.finish();
    let found = found?;
    let bundle = bundle::comparison(&found);
    let (out, _) = put(&bundle, &compare.out, compare_file::SCHEMA)?;
    large::kept(runs, found.status == "done");
    if common.json {
        output::json(&found)?;
    } else if !common.quiet {
        output::print(&format!(
            "{}\nwritten to {}: report.html, compare.json\n",
            stiction_pages::text::comparison(&found),
            out.display()
        ))?;
    }
    Ok(stiction_workflows::verdict::of_comparison(&found).into())
}
