//! Scenario files: TOML enters, a checked scenario or an error with file, line, cause and remedy leaves.
