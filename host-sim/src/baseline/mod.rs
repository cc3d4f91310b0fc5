//! What others would do with the same decoded messages, in float64: messages enter, estimates leave.
