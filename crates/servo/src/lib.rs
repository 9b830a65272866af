//! The simulated axis: plant, controller, encoder, and known axes with their parameters.
