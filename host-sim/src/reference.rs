//! The discrete equations of the core in float64: the reference that the fixed-point core is held against.
