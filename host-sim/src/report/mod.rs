//! The HTML report: results enter, one self-contained page with plots leaves. No script, no font, no image and no
//! address of anything outside; no time of day, so the same results are the same bytes.
//!
//! ```text
//! results -> run, evaluate, sweep -> plot (figures) -> page (tables, prose, style) -> String
//! ```
//!
//! [`plot`] knows axes and shapes but nothing of vehicles; [`page`] knows HTML; [`run`], [`evaluate`] and [`sweep`] say
//! which figures the report of each command has. Everything is escaped in one place, [`markup`].

pub mod evaluate;
pub mod markup;
pub mod page;
pub mod plot;
pub mod run;
pub mod sweep;

pub use evaluate::EvaluateReport;
pub use run::RunReport;
