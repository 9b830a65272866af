//! The fourth step: how far the fitted law may be trusted, and what to beware of.

use super::compensation::rms;
use super::condition::Conditioned;
use super::contradictions;
use super::disagree;
use super::fit::Fitted;
use super::force_unit;
use super::load::{Asked, Loaded};
use super::logs::{log_warnings_but, path_of, validation_warnings};
use super::machine;
use super::time_offset;
use super::trust::{self, Judged};
use stiction_identify as engine;
use stiction_identify::{Delay, Mass, Record, Series, Source as Signal, Status};
use stiction_say::{Found, Notice};

/// Says what happened on the way, then judges the law.
pub(super) fn judge(
    asked: Asked,
    loaded: &Loaded,
    conditioned: &Conditioned,
    fitted: &Fitted,
    validation: &[(String, Series)],
) -> Judged {
    let law = &fitted.choice.estimate;
    // Of one cause one warning: a record that has timing noise states it by itself.
    let is_stated = |found: &Found| found.is_jitter() && conditioned.record.timing_noise != 0.0;
    let mut warnings = log_warnings_but(&loaded.sources, is_stated);
    warnings.extend(validation_warnings(&loaded.held_out, &loaded.sources));
    // A search by itself looks for no delay and compares no laws.
    let finishes = !asked.options.searching.no_finish;
    let asks_delay = asked.axis.terms.delay == Delay::Fitted && finishes;
    if asks_delay && law.terms.delay == Delay::NONE && loaded.contradicted.is_none() {
        warnings.push(Notice::DelayOutOfRange.into());
    }
    if let Some(error) = &fitted.not_kept {
        let error = error.to_string();
        warnings.push(Notice::CheckpointLost { error }.into());
    }
    let compares = asked.options.compare_laws && fitted.two_steps.is_none() && finishes;
    if compares && fitted.choice.laws.is_empty() && law.status != Status::Interrupted {
        warnings.push(Notice::ComparisonStopped.into());
    }
    time_offset::stated(asked, loaded, law, &mut warnings);
    let unused = unused(loaded, conditioned);
    let of_limits = contradictions::against_limits(asked, loaded, &law.parameters);
    let odd = machine::unlikely(asked, loaded, law);
    let stated = loaded.contradicted.as_ref().or(of_limits.as_ref());
    let contradicted = stated.or(odd.as_ref());
    let left = |record: &Record| {
        let laws = fitted.choice.simpler.iter();
        let each = laws.map(|law| rms(&engine::predict(record, law).residual()));
        each.reduce(f64::min)
    };
    let simpler: Vec<Option<f64>> = conditioned.unseen.iter().map(left).collect();
    let evidence = trust::Evidence {
        law,
        signal: "force",
        moves_both_ways: conditioned.record.moves_both_ways(),
        sources: &loaded.sources,
        laws: &fitted.choice.laws,
        motion: loaded.motion(),
        apart: loaded.apart.as_deref(),
        contradicted,
        unused: unused.as_deref(),
        chosen: fitted.choice.by != "user",
        better: fitted.choice.better.as_ref(),
        held_out_rmse: fitted.choice.held_out_rmse,
        validation,
        simpler: &simpler,
        held_out: &loaded.held_out,
        options: disagree::options(asked),
        unscaled: force_unit::cause(asked, &loaded.sources[0].log),
        can_be_simulated: can_be_simulated(asked, loaded),
    };
    match &fitted.two_steps {
        None => trust::of_force(&evidence, warnings),
        Some(both) => {
            let mut judged = trust::of_two_steps(&evidence, both.changed, warnings);
            judged.warnings.extend_from_slice(&both.warnings);
            judged
        }
    }
}

/// Which of several logs have no sample that is fitted, in words: nothing compares them with the others.
fn unused(loaded: &Loaded, conditioned: &Conditioned) -> Option<String> {
    let all = 0..loaded.sources.len();
    let idle = all.filter(|log| !conditioned.record.has_samples_of(*log));
    let names: Vec<String> = idle.map(|log| path_of(&loaded.sources, log)).collect();
    (!names.is_empty()).then(|| {
        format!(
            "no sample of {} is fitted: it is too short beside the ends that filters drop and the way after which what was before no \
             longer counts; leave it out, or record a longer one",
            names.join(", ")
        )
    })
}

/// Whether the position of every log can be compared with that of a simulated axis.
fn can_be_simulated(asked: Asked, loaded: &Loaded) -> bool {
    let Asked { axis, .. } = asked;
    let mut sources = loaded.sources.iter();
    axis.terms.mass != Mass::Absent
        && axis.conditioning.source != Some(Signal::Velocity)
        && sources.all(|source| source.log.position.is_some())
}
