//! The HTML report: results enter, one self-contained page with plots leaves. No script, no font, no image and no
//! address of anything outside; no time of day, so the same results are the same bytes.
//!
//! ```text
//!
//! [`plot`] knows axes and shapes but nothing of vehicles; [`page`] knows HTML; [`run`] and [`evaluate`] say which figures
//! [`plot`] knows axes and shapes but nothing of vehicles; [`page`] knows HTML; [`run`] says which figures the report of
//! ```
//! one run has, [`sweep`] that of many. Everything is escaped in one place, [`markup`].
//! results -> run, evaluate -> plot (figures) -> page (tables, prose, style) -> String
//! results -> run, sweep -> plot (figures) -> page (tables, prose, style) -> String
//! the report of one run, or of one evaluation, has. Everything is escaped in one place, [`markup`].

pub mod evaluate;
pub mod markup;
pub mod page;
pub mod plot;
pub mod run;
pub mod sweep;

pub use evaluate::EvaluateReport;
pub use run::RunReport;
