//! What a parameter measures.

/// What a parameter measures; with the units of force and motion this gives its unit, see [`Units`](crate::Units).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Dimension {
    /// Force per length (or torque per angle).
    Stiffness,
    /// Force per speed.
    Damping,
    /// Force, torque, or what stands for it (current, voltage).
    Force,
    /// Length or angle.
    Length,
    /// Length (or angle) per time.
    Speed,
    /// Per time.
    Rate,
    /// Force per acceleration: mass or inertia.
    Inertia,
    /// Time, s.
    Time,
    /// Force per squared speed.
    QuadraticDamping,
    /// Force per normal load; a pure number where both are in one unit.
    ForcePerLoad,
    /// Force per temperature.
    ForcePerTemperature,
    /// Force per speed and temperature.
    DampingPerTemperature,
    /// Normal load, in the unit of its channel.
    Load,
    /// Temperature, K.
    Temperature,
    /// A pure number.
    One,
}
