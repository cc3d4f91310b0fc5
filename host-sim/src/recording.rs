//! Recorded motion and recorded channels: a CSV file enters, checked rows leave.
