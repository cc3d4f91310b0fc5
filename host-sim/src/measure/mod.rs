//! Evaluation of a run: a trace enters, figures leave. The other methods and the float64 reference are here too.

pub mod baseline;
pub mod bootstrap;
pub mod figures;
pub mod heard;
pub mod metrics;
pub mod observer;
pub mod paper_beside;
pub mod reference;
pub mod simulate;
pub mod trajectories;
