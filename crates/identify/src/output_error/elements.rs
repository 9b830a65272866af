//! One step of a mass with Maxwell-slip elements under a force, with its derivatives.
//!
//! The implicit-midpoint step MID of `stiction_servo::plant` with a generalised Maxwell-slip law (Al-Bender, Lampaert and
//! Swevers 2005, doi 10.1109/TAC.2005.858676) held at the mean velocity w of the step. An element counts in units of the
//! force that it yields at at rest, `u = F/W`, and its limit is that of the fit of the force,
//! `L(w) = (1 + (r - 1) exp(-|w/vs|^delta))/r`, times the ratio of the directions in the negative one:
//!
//! ```text
//! sticks: u+ = u + h w/d                          up to the limit
//! slips:  u+ = L + (u - L) exp(-a h/L)            along the motion; at the limit without a Stribeck curve
//! 2 M (w - v)/h = force - sum W (u + u+)/2 - s2 w - offset - waves
//! ```
//!
//! An element slips until the velocity changes its sign. The derivatives are those of the computed step, by the implicit
//! function theorem. The step is continuous in every unknown, its derivatives jump where an element just begins to slip;
//! with a Stribeck curve the step itself jumps a little where an axis whose elements slip comes to rest.

use crate::output_error::plant::{Axis, Curve, State};
use crate::output_error::simulate::{Initial, Plant};
use crate::output_error::unknowns::{Layout, MOST, Unknown};
use libm::{exp, expm1, fabs, pow};

/// Most elements of a law.
pub(crate) const MOST_ELEMENTS: usize = crate::gms::MOST;

/// One element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Element {
    /// Deflection at which it yields at rest, d, m (rad).
    pub reach: f64,
    /// Force that it holds then, W, N (N m).
    pub force: f64,
}

/// The elements of an axis. The curves of the axis follow from them, see [`Axis::follow_elements`].
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Elements {
    pub all: Vec<Element>,
    /// Limit at rest in the negative direction over that in the positive one.
    pub ratio: f64,
    /// Rate at which a slipping element follows the curve, 1/s; infinite without a Stribeck curve.
    pub attraction: f64,
}

impl Elements {
    /// Sum of the yield forces, N (N m).
    pub fn force(&self) -> f64 {
        self.all.iter().map(|e| e.force).sum()
    }

    /// Stiffness while all stick, N/m (N m/rad).
    pub fn stiffness(&self) -> f64 {
        self.all.iter().map(|e| e.force / e.reach).sum()
    }

    /// Sets what an unknown stands for.
    pub fn set(&mut self, unknown: Unknown, value: f64) {
        match unknown {
            Unknown::Reach(i) => self.all[i].reach = value,
            Unknown::Yield(i) => self.all[i].force = value,
            Unknown::Ratio => self.ratio = value,
            Unknown::Attraction => self.attraction = value,
            _ => {}
        }
    }

    /// The element that yields last.
    pub fn last(&self) -> usize {
        let reach = |i: &usize| self.all[*i].reach;
        (0..self.all.len())
            .max_by(|a, b| reach(a).total_cmp(&reach(b)))
            .unwrap_or(0)
    }
}

/// Position, velocity and the elements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SlipState {
    pub x: f64,
    pub v: f64,
    /// Force over yield force of each.
    pub u: [f64; MOST_ELEMENTS],
    /// Which of them slip, one bit each, and whether they do so forwards.
    pub slips: u16,
    pub forward: bool,
}

/// Derivative of the state in one unknown.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SlipSlope {
    x: f64,
    v: f64,
    u: [f64; MOST_ELEMENTS],
}

/// An axis with elements, unpacked.
pub(crate) struct Slipping<'a> {
    axis: &'a Axis,
    many: usize,
    force: [f64; MOST_ELEMENTS],
    inverse_reach: [f64; MOST_ELEMENTS],
    reach: f64,
    last: usize,
    ratio: f64,
    attraction: f64,
    total: f64,
}

/// The limit in one direction at a mean velocity, and its derivatives.
struct Limit {
    value: f64,
    by_speed: f64,
    by_excess: f64,
    by_velocity: f64,
}

/// Everything after a step at one mean velocity.
struct Moved {
    side: usize,
    end: [f64; MOST_ELEMENTS],
    slips: u16,
    /// Derivatives of the ends: in u before, in w, in the limit, in `ln a`, in `ln d` of its own.
    keep: [f64; MOST_ELEMENTS],
    by_w: [f64; MOST_ELEMENTS],
    by_limit: [f64; MOST_ELEMENTS],
    by_attraction: [f64; MOST_ELEMENTS],
    by_reach: [f64; MOST_ELEMENTS],
    limit: Limit,
}

/// Bisection alone would need about sixty.
const MOST_EVALUATIONS: u32 = 200;
/// Width of the bracket at which it is closed, in velocities that count as standstill: there the force may jump.
const CLOSED_BRACKET: f64 = 1e-3;

impl<'a> Slipping<'a> {
    pub fn new(axis: &'a Axis, elements: &Elements) -> Self {
        let mut out = Self {
            axis,
            many: elements.all.len().min(MOST_ELEMENTS),
            force: [0.0; MOST_ELEMENTS],
            inverse_reach: [0.0; MOST_ELEMENTS],
            reach: 0.0,
            last: elements.last(),
            ratio: elements.ratio,
            attraction: elements.attraction,
            total: elements.force(),
        };
        for (i, element) in elements.all.iter().take(MOST_ELEMENTS).enumerate() {
            out.force[i] = element.force;
            out.inverse_reach[i] = 1.0 / element.reach;
        }
        out.reach = elements.all.get(out.last).map_or(0.0, |e| e.reach);
        out
    }

    #[inline]
    fn limit(&self, side: usize, speed: f64) -> Limit {
        let Curve {
            coulomb,
            fixed,
            velocity,
            ..
        } = self.axis.sides[side];
        let scale = if side == 1 { self.ratio } else { 1.0 };
        if fixed == coulomb {
            return Limit {
                value: scale,
                by_speed: 0.0,
                by_excess: 0.0,
                by_velocity: 0.0,
            };
        }
        let excess = fixed / coulomb - 1.0;
        let exponent = self.axis.exponent;
        let ratio = speed / velocity;
        let power = match exponent == 2.0 {
            true => ratio * ratio,
            false => pow(ratio, exponent),
        };
        let fall = exp(-power);
        let inverse = 1.0 / (1.0 + excess);
        let by_velocity = match fall == 0.0 {
            true => 0.0,
            false => scale * excess * fall * exponent * power * inverse,
        };
        Limit {
            value: scale * (1.0 + excess * fall) * inverse,
            by_speed: match speed == 0.0 {
                true => 0.0,
                false => -by_velocity / speed,
            },
            by_excess: scale * excess * (fall - 1.0) * inverse * inverse,
            by_velocity,
        }
    }

    /// The sum of the forces of the elements after `h` seconds at the mean velocity `w`, and its derivative.
    #[inline]
    fn ends(&self, from: &SlipState, h: f64, w: f64) -> (f64, f64) {
        let mut sum = 0.0;
        let mut slope = 0.0;
        if w == 0.0 {
            for i in 0..self.many {
                sum += self.force[i] * from.u[i];
                slope += self.force[i] * h * self.inverse_reach[i];
            }
            return (sum, slope);
        }
        let forward = w > 0.0;
        let sign = if forward { 1.0 } else { -1.0 };
        let limit = self.limit(usize::from(!forward), fabs(w));
        let path = h * fabs(w);
        let decay = expm1(-self.attraction * h / limit.value);
        let held = if from.forward == forward {
            from.slips
        } else {
            0
        };
        for i in 0..self.many {
            let along = sign * from.u[i];
            let reached = along + path * self.inverse_reach[i];
            if held & (1 << i) == 0 && along < limit.value {
                if reached < limit.value {
                    sum += sign * self.force[i] * reached;
                    slope += self.force[i] * h * self.inverse_reach[i];
                } else {
                    sum += sign * self.force[i] * limit.value;
                    slope += self.force[i] * limit.by_speed;
                }
            } else {
                let lag = along - limit.value;
                sum += sign * self.force[i] * (along + lag * decay);
                slope += self.force[i] * limit.by_speed * self.by_limit(lag, decay, h, limit.value);
            }
        }
        (sum, slope)
    }

    /// How the end of a slipping element changes with its limit.
    #[inline]
    fn by_limit(&self, lag: f64, decay: f64, h: f64, limit: f64) -> f64 {
        match self.attraction.is_finite() {
            true => -decay + lag * (1.0 + decay) * self.attraction * h / (limit * limit),
            false => 1.0,
        }
    }

    /// The same element by element, with all derivatives.
    fn moved(&self, from: &SlipState, h: f64, w: f64) -> Moved {
        let forward = w > 0.0 || (w == 0.0 && from.forward);
        let side = usize::from(!forward);
        let sign = if forward { 1.0 } else { -1.0 };
        let limit = self.limit(side, fabs(w));
        let path = h * fabs(w);
        let pull = self.attraction * h / limit.value;
        let decay = expm1(-pull);
        let held = match from.forward == forward && w != 0.0 {
            true => from.slips,
            false => 0,
        };
        let mut out = Moved {
            side,
            end: from.u,
            slips: 0,
            keep: [1.0; MOST_ELEMENTS],
            by_w: [0.0; MOST_ELEMENTS],
            by_limit: [0.0; MOST_ELEMENTS],
            by_attraction: [0.0; MOST_ELEMENTS],
            by_reach: [0.0; MOST_ELEMENTS],
            limit,
        };
        for i in 0..self.many {
            let along = sign * from.u[i];
            let inverse = self.inverse_reach[i];
            let reached = along + path * inverse;
            let sticks = w == 0.0 || (held & (1 << i) == 0 && along < out.limit.value);
            if sticks && (w == 0.0 || reached < out.limit.value) {
                out.end[i] = sign * reached;
                out.by_w[i] = h * inverse;
                out.by_reach[i] = -h * w * inverse;
                continue;
            }
            out.slips |= 1 << i;
            if sticks {
                out.end[i] = sign * out.limit.value;
                out.keep[i] = 0.0;
                out.by_limit[i] = sign;
            } else {
                let lag = along - out.limit.value;
                out.end[i] = sign * (along + lag * decay);
                out.keep[i] = 1.0 + decay;
                out.by_limit[i] = sign * self.by_limit(lag, decay, h, out.limit.value);
                if self.attraction.is_finite() {
                    out.by_attraction[i] = -sign * lag * (1.0 + decay) * pull;
                }
            }
            out.by_w[i] = sign * out.by_limit[i] * out.limit.by_speed;
        }
        out
    }

    /// The mean velocity of a step and the slope of the force balance there; infinite where the axis is held by a force
    /// that jumps at standstill.
    fn solve(&self, from: &SlipState, h: f64, force: f64) -> (f64, f64) {
        let axis = self.axis;
        let inertia = 2.0 * axis.mass / h;
        let begin: f64 = (0..self.many).map(|i| self.force[i] * from.u[i]).sum();
        let waves: f64 = axis.waves.iter().map(|w| fabs(w.factor)).sum();
        let most = self.total * self.ratio.max(1.0);
        let free = (inertia * from.v + force - axis.offset) / inertia;
        let reach =
            1.01 * (most.max(fabs(begin)) + waves) / inertia + 1e-6 * (fabs(free) + fabs(from.v));
        let (mut low, mut high) = (free.min(0.0) - reach, free.max(0.0) + reach);
        let balance = |w: f64| {
            let (end, end_slope) = self.ends(from, h, w);
            let viscous = axis.sides[usize::from(w < 0.0)].viscous;
            let (beside, beside_slope) = match axis.waves.is_empty() {
                true => (0.0, 0.0),
                false => axis.waves_at(from.x + 0.5 * h * w),
            };
            let excess =
                inertia * (w - from.v) + 0.5 * (begin + end) + viscous * w + axis.offset + beside
                    - force;
            let slope = inertia + 0.5 * end_slope + viscous + 0.5 * h * beside_slope;
            (excess, slope)
        };
        let negligible = 1e-12 * axis.sides[0].velocity.min(1.0);
        let mut w = from.v.max(low).min(high);
        let mut last_move = high - low;
        for _ in 0..MOST_EVALUATIONS {
            let (excess, slope) = balance(w);
            if excess > 0.0 {
                high = w;
            } else {
                low = w;
            }
            let newton = w - excess / slope;
            let moves = fabs(newton - w);
            if moves <= 1e-8 * fabs(w) + negligible {
                return (newton, balance(newton).1);
            }
            let width = (4.0 * f64::EPSILON * fabs(w)).max(CLOSED_BRACKET * negligible);
            if high - low <= width {
                return (w, f64::INFINITY);
            }
            let trusted = newton > low && newton < high && 2.0 * moves <= last_move;
            let next = if trusted { newton } else { 0.5 * (low + high) };
            last_move = fabs(next - w);
            w = next;
        }
        (w, f64::INFINITY)
    }

    fn after(&self, from: &SlipState, h: f64, w: f64, moved: &Moved) -> SlipState {
        SlipState {
            x: from.x + h * w,
            v: 2.0 * w - from.v,
            u: moved.end,
            slips: moved.slips,
            forward: moved.side == 0,
        }
    }

    /// Deflection of all elements at the start of a run, from the unloaded state.
    fn first(&self, part: f64, i: usize) -> (f64, bool) {
        let u = part * self.reach * self.inverse_reach[i];
        let inside = u < 1.0 && u > -self.ratio;
        (u.min(1.0).max(-self.ratio), inside)
    }
}

impl Plant for Slipping<'_> {
    type State = SlipState;
    type Slope = SlipSlope;

    fn start(&self, initial: &Initial) -> SlipState {
        let mut u = [0.0; MOST_ELEMENTS];
        for (i, u) in u.iter_mut().enumerate().take(self.many) {
            *u = self.first(initial.0[2], i).0;
        }
        SlipState {
            x: initial.0[0],
            v: initial.0[1],
            u,
            slips: 0,
            forward: initial.0[1] >= 0.0,
        }
    }

    fn start_slopes(&self, layout: &Layout, initial: &Initial) -> [SlipSlope; MOST] {
        let nothing = SlipSlope {
            x: 0.0,
            v: 0.0,
            u: [0.0; MOST_ELEMENTS],
        };
        let mut out = [nothing; MOST];
        let shared = layout.len();
        out[shared].x = 1.0;
        out[shared + 1].v = 1.0;
        for i in 0..self.many {
            let (u, inside) = self.first(initial.0[2], i);
            if inside {
                out[shared + 2].u[i] = self.reach * self.inverse_reach[i];
            }
            for (d, unknown) in out.iter_mut().zip(&layout.unknowns) {
                match *unknown {
                    Unknown::Reach(k) if inside => {
                        d.u[i] += u * (f64::from(k == self.last) - f64::from(k == i));
                    }
                    Unknown::Ratio if u < 0.0 && !inside => d.u[i] = u,
                    _ => {}
                }
            }
        }
        out
    }

    fn shown(&self, state: &SlipState) -> State {
        State {
            x: state.x,
            v: state.v,
            z: (0..self.many).map(|i| self.force[i] * state.u[i]).sum(),
        }
    }

    #[inline]
    fn position(state: &SlipState) -> f64 {
        state.x
    }

    #[inline]
    fn position_slope(slope: &SlipSlope) -> f64 {
        slope.x
    }

    fn step(&self, state: SlipState, h: f64, force: f64) -> SlipState {
        let (w, _) = self.solve(&state, h, force);
        self.after(&state, h, w, &self.moved(&state, h, w))
    }

    fn advance(
        &self,
        from: SlipState,
        h: f64,
        force: f64,
        layout: &Layout,
        force_slopes: &[f64; MOST],
        slopes: &mut [SlipSlope],
    ) -> SlipState {
        let (w, slope) = self.solve(&from, h, force);
        let moved = self.moved(&from, h, w);
        let gain = -1.0 / slope;
        let axis = self.axis;
        let inertia = 2.0 * axis.mass / h;
        let n = self.many;
        let middle = from.x + 0.5 * h * w;
        let (_, by_x) = match axis.waves.is_empty() {
            true => (0.0, 0.0),
            false => axis.waves_at(middle),
        };
        let through = |of: &[f64; MOST_ELEMENTS]| -> f64 {
            (0..n).map(|i| 0.5 * self.force[i] * of[i]).sum()
        };
        let (through_limit, through_attraction) =
            (through(&moved.by_limit), through(&moved.by_attraction));
        for (j, (d, du)) in slopes.iter_mut().zip(force_slopes).enumerate() {
            let mut balance = by_x * d.x - inertia * d.v - du;
            for i in 0..n {
                balance += 0.5 * self.force[i] * (1.0 + moved.keep[i]) * d.u[i];
            }
            // What the unknown does to the limit, to the attraction, and to one element.
            let (mut limit, mut attraction, mut own) = (0.0, 0.0, None);
            match layout.unknowns.get(j) {
                None | Some(Unknown::Delay) => {}
                Some(Unknown::Viscous(side)) if side.holds(moved.side) => balance += w,
                Some(Unknown::Excess(side)) if side.holds(moved.side) => {
                    limit = moved.limit.by_excess;
                }
                Some(Unknown::Velocity(side)) if side.holds(moved.side) => {
                    limit = moved.limit.by_velocity;
                }
                Some(Unknown::Ratio) if moved.side == 1 => limit = moved.limit.value,
                Some(Unknown::Attraction) => attraction = 1.0,
                Some(&Unknown::Reach(k)) => {
                    own = Some(k);
                    balance += 0.5 * self.force[k] * moved.by_reach[k];
                }
                Some(&Unknown::Yield(k)) => {
                    balance += 0.5 * self.force[k] * (from.u[k] + moved.end[k]);
                }
                Some(Unknown::Mass) => balance += inertia * (w - from.v),
                Some(Unknown::Offset) => balance += 1.0,
                Some(&Unknown::Wave(k)) => balance += axis.waves[k].shape(middle).0,
                Some(_) => {}
            }
            balance += limit * through_limit + attraction * through_attraction;
            let dw = gain * balance;
            d.x += h * dw;
            d.v = 2.0 * dw - d.v;
            for i in 0..n {
                d.u[i] = moved.keep[i] * d.u[i]
                    + moved.by_w[i] * dw
                    + moved.by_limit[i] * limit
                    + moved.by_attraction[i] * attraction;
            }
            if let Some(k) = own {
                d.u[k] += moved.by_reach[k];
            }
        }
        self.after(&from, h, w, &moved)
    }
}

impl Axis {
    /// An element by its place; one without force where there is none.
    pub fn element(&self, i: usize) -> Element {
        let element = self.elements.as_ref().and_then(|e| e.all.get(i));
        element.copied().unwrap_or(Element {
            reach: 1.0,
            force: 0.0,
        })
    }

    /// Sets the curves to what the elements say; the ratios of static to Coulomb friction stay.
    pub fn follow_elements(&mut self) {
        let Some(elements) = &self.elements else {
            return;
        };
        let total = elements.force();
        self.stiffness = elements.stiffness();
        for (side, scale) in self.sides.iter_mut().zip([1.0, elements.ratio]) {
            let ratio = side.fixed / side.coulomb;
            side.fixed = scale * total;
            side.coulomb = side.fixed / ratio;
        }
    }

    /// Scales the elements to what the curves say.
    pub fn follow_curves(&mut self) {
        let Some(elements) = &mut self.elements else {
            return;
        };
        let scale = self.sides[0].fixed / elements.force();
        for element in &mut elements.all {
            element.force *= scale;
        }
        elements.ratio = self.sides[1].fixed / self.sides[0].fixed;
        self.stiffness = elements.stiffness();
    }
}

/// Elements that share a force like a loading curve `1 - exp(-x/length)`, their yield deflections in equal ratios about that
/// length, `wide` from the first to the last.
pub(crate) fn spread(many: usize, force: f64, length: f64, wide: f64) -> Vec<Element> {
    let many = many.clamp(1, MOST_ELEMENTS);
    let reach = |i: usize| match many {
        1 => length,
        _ => length * pow(wide, i as f64 / (many - 1) as f64 - 0.5),
    };
    let loaded = |x: f64| -expm1(-x / length);
    // Slope of the loading curve up to each yield deflection.
    let slope = |i: usize| {
        let (from, to) = match i {
            0 => (0.0, reach(0)),
            _ if i < many => (reach(i - 1), reach(i)),
            _ => return 0.0,
        };
        (loaded(to) - loaded(from)) / (to - from)
    };
    let mut out: Vec<Element> = (0..many)
        .map(|i| Element {
            reach: reach(i),
            force: reach(i) * (slope(i) - slope(i + 1)),
        })
        .collect();
    let total: f64 = out.iter().map(|e| e.force).sum();
    for element in &mut out {
        element.force *= force / total;
    }
    out
}
