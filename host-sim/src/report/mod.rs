//! The HTML report: results enter; one self-contained page with plots leaves. The page has no script, no font, no image
//! and no external address. It has no time of day, so the same results give the same bytes.
//!
//! ```text
//! results -> run, evaluate, sweep -> plot (figures) -> page (tables, prose, style) -> String
//! ```
//!
//! [`plot`] draws axes and shapes and does not depend on vehicles. [`page`] writes HTML. [`run`], [`evaluate`] and
//! [`sweep`] choose the figures of each command's report. [`markup`] is the only place where text is escaped.

pub mod evaluate;
pub mod markup;
pub mod page;
pub mod plot;
pub mod run;
pub mod sweep;

pub use evaluate::EvaluateReport;
pub use run::RunReport;
