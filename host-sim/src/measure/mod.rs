//! What is made of a run: a trace enters, figures leave; and the other methods and the reference that ours is compared with.

pub mod baseline;
pub mod figures;
pub mod heard;
pub mod metrics;
pub mod observer;
pub mod paper_beside;
pub mod reference;
pub mod simulate;
