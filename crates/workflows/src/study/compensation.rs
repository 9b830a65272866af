//! The compensation of an axis, from a scheme and the parameters that the compensator assumes (the belief).

use stiction_files::study::{Belief, Machine, ModelKind, ModelScheme, Scheme};
use stiction_friction::compensator::{
    Adaptation, Compensator, DisturbanceObserver, Friction, Levels, Settings, Source, Terms, Watch,
};
use stiction_friction::{CoulombViscous, Direction, ParamError, Stribeck};
use stiction_servo::controller::Controller;
use stiction_servo::feedforward::Feedforward;
use stiction_servo::law::AxisLaw;
use stiction_servo::trajectory::MAX_PREVIEW;

/// The controller with its mass feedforward scaled from the true mass to the mass that is believed.
pub(super) fn believing(controller: Controller, machine: &Machine, belief: Belief) -> Controller {
    let fed = controller.mass_feedforward() / machine.mass * belief.mass;
    controller.with_mass_feedforward(fed)
}

/// The compensation of an axis whose parameters are assumed to be `belief`, on since the axis stands, with what its watchdog has
/// learnt before.
pub(super) fn feedforward(
    scheme: &Scheme,
    machine: &Machine,
    controller: &Controller,
    belief: Belief,
    watch: &Watch<f64>,
) -> Result<Feedforward, ParamError> {
    let limit = controller.force_limit();
    let observer = |bandwidth: f64| {
        DisturbanceObserver::new(belief.mass, bandwidth, 1.0 / machine.rate, limit)
    };
    match scheme {
        Scheme::None | Scheme::Learning(..) => Ok(Feedforward::default()),
        Scheme::Observer(bandwidth) => Ok(Feedforward::observer(observer(*bandwidth)?)),
        Scheme::Model(model) => Ok(Feedforward {
            observer: model.observer.map(observer).transpose()?,
            ..from_law(model, machine, limit, belief, watch)?
        }),
    }
}

/// A force from the law.
fn from_law(
    model: &ModelScheme,
    machine: &Machine,
    limit: f64,
    belief: Belief,
    watch: &Watch<f64>,
) -> Result<Feedforward, ParamError> {
    let law = &belief.law;
    let curve = law.curve();
    let sides = [curve.positive(), curve.negative()];
    let friction = match model.kind {
        ModelKind::Coulomb => Friction::Coulomb(CoulombViscous::new(
            sides.map(|s| s.coulomb),
            sides.map(|s| s.viscous),
            curve.offset(),
        )?),
        ModelKind::Stribeck => Friction::Stribeck(*curve),
        ModelKind::Simplified => without_stribeck(law)?.friction(),
        ModelKind::Whole => law.friction(),
    };
    let period = 1.0 / machine.rate;
    let limit = model.limit.unwrap_or(limit);
    let usual = Settings::for_law(&friction, period);
    let dead_zone = match model.kind {
        // The law has a Stribeck velocity, although what is made of it has none.
        ModelKind::Coulomb => Settings::for_law(&Friction::Stribeck(*curve), period).dead_zone,
        _ => usual.dead_zone,
    };
    let settings = Settings {
        gain: model.gain,
        dead_zone: model.dead_zone.unwrap_or(dead_zone),
        limit,
        slew: model.slew.unwrap_or(usual.slew),
        ramp: model.ramp,
        adaptation: model.adaptation.map(|adaptation| Adaptation {
            mass: belief.mass,
            ..adaptation
        }),
        watchdog: model.watchdog,
        ..usual
    };
    let preview = model.preview.unwrap_or(match model.source {
        Source::Reference => machine.drive.preview(period).min(MAX_PREVIEW),
        _ => 0.0,
    });
    let mut compensator = Compensator::new(friction, model.source, settings)?;
    let told = machine.depends.as_ref().filter(|_| model.inputs);
    if let Some(depends) = &machine.depends {
        let terms = match told {
            Some(_) => Terms {
                channels: depends.channels,
                levels: Some(depends.levels),
                ..Terms::default()
            },
            // The speed needs no telling.
            None => Terms {
                levels: Some(Levels {
                    quadratic: depends.levels.quadratic,
                    top_speed: depends.levels.top_speed,
                    ..Levels::default()
                }),
                ..Terms::default()
            },
        };
        compensator = compensator.with_terms(terms)?;
    }
    Ok(Feedforward {
        surroundings: told.map(|depends| depends.surroundings),
        ..Feedforward::compensator(compensator.running(watch), preview)
    })
}

/// The law with Coulomb friction for static friction.
pub(crate) fn without_stribeck(law: &AxisLaw) -> Result<AxisLaw, ParamError> {
    let curve = law.curve();
    let [positive, negative] = [curve.positive(), curve.negative()].map(|side| Direction {
        static_friction: side.coulomb,
        ..*side
    });
    let curve = Stribeck::new(curve.shape(), positive, negative, curve.offset())?;
    law.with_curve(curve)
}
