//! `holdover-sim evaluate` as its user meets it: files and arguments enter, results, files and exit codes leave.

mod bench;
mod input;
mod link;
mod pages;
mod predecessor;
mod silence;
