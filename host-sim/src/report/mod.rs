//! The HTML report: results enter, one self-contained page with plots leaves.
