//! Two axes along a contour.

use crate::axis::{Axis, AxisSettings, Correction, Sample};
use crate::cross_coupling::{CouplingState, CrossCoupling};
use crate::integrator::{Integrator, Mid};
use crate::path::Reference;
use crate::plane::PlaneMotion;
use crate::run::sample_count;
use crate::trajectory::{Lookahead, Trajectory};
use stiction_friction::{Held, LuGre, ParamError};

/// Two axes to simulate, at the same rate.
#[derive(Clone, Debug, PartialEq)]
pub struct TwoAxes<L = LuGre<f64>> {
    /// x and y.
    pub axes: [AxisSettings<L>; 2],
    /// Cross-coupled control of the contour error.
    pub coupling: Option<CrossCoupling>,
}

/// Both axes at a sample.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PlaneSample {
    /// x and y.
    pub axes: [Sample; 2],
    /// Parameter of the curve at the reference.
    pub parameter: f64,
    /// True deviation from the contour, m, positive if the contour lies to the left.
    pub deviation: f64,
}

/// One axis of a contour.
struct Side<'a, M: ?Sized>(&'a M, usize);

impl<M: PlaneMotion + ?Sized> Trajectory for Side<'_, M> {
    fn duration(&self) -> f64 {
        self.0.duration()
    }

    fn at(&self, t: f64) -> Reference {
        self.0.at(t).axes[self.1]
    }
}

impl<L: Held<f64>> TwoAxes<L> {
    /// Runs both from rest over the whole contour, with MID in one step per substep.
    pub fn run(&self, motion: &impl PlaneMotion) -> Result<Vec<PlaneSample>, ParamError> {
        self.run_with(motion, Mid::new(1)?)
    }

    /// [`run`](Self::run) with another integrator, one for each axis.
    pub fn run_with<I: Integrator<L> + Clone>(
        &self,
        motion: &(impl PlaneMotion + ?Sized),
        integrator: I,
    ) -> Result<Vec<PlaneSample>, ParamError> {
        let [x, y] = &self.axes;
        let mut axes = [
            Axis::new(x.clone(), integrator.clone())?,
            Axis::new(y.clone(), integrator)?,
        ];
        follow(&mut axes, self.coupling.as_ref(), motion)
    }
}

/// Runs two axes over the whole contour from their present state, with or without cross-coupled control.
pub fn follow<L: Held<f64>, I: Integrator<L>>(
    axes: &mut [Axis<L, I>; 2],
    coupling: Option<&CrossCoupling>,
    motion: &(impl PlaneMotion + ?Sized),
) -> Result<Vec<PlaneSample>, ParamError> {
    let [x, y] = axes.each_ref().map(Axis::settings);
    if x.rate != y.rate {
        return Err(ParamError::new("rate", y.rate, "that of the other axis"));
    }
    if let Some(coupling) = coupling {
        coupling.validate()?;
    }
    let (rate, n) = (x.rate, sample_count(motion.duration(), x.rate)?);
    let sides = [Side(motion, 0), Side(motion, 1)];
    let mut references = [
        Lookahead::new(&sides[0], rate, x.feedforward.preview),
        Lookahead::new(&sides[1], rate, y.feedforward.preview),
    ];
    let mut state = CouplingState::default();
    let mut samples = Vec::with_capacity(n);
    for _ in 0..n {
        let station = motion.at(samples.len() as f64 / rate);
        let mut correction = [0.0; 2];
        if let Some(coupling) = coupling {
            let error = [0, 1].map(|i| station.axes[i].position - axes[i].measure());
            let deviation = motion.deviation(station.parameter, error);
            correction = coupling.correction(&mut state, 1.0 / rate, deviation);
        }
        let at = [0, 1].map(|i| {
            let (reference, ahead) = references[i].sample();
            let correction = Correction {
                velocity: correction[i],
                force: 0.0,
            };
            axes[i].step(reference, ahead, correction)
        });
        let position = at.map(|s| s.position);
        samples.push(PlaneSample {
            axes: at,
            parameter: station.parameter,
            deviation: motion.true_deviation(position, station.parameter).distance,
        });
    }
    Ok(samples)
}
