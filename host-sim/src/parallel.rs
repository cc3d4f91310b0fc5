//! Work on all cores: jobs, and what is to be done with each, enter; the results leave in the order of the jobs, so that the
//! number of threads decides nothing.
//!
//! Every thread takes the next job when it is done with its last. Nothing is split and nobody waits for a part while it
//! does another one, so a thread's stack never holds more than one job, however many jobs and threads there are.

use std::iter;
use std::sync::Mutex;

/// Does all jobs. No job hands out jobs of its own.
pub fn each<J, R: Send>(jobs: impl IntoIterator<Item = J, IntoIter: Send>, one: impl Fn(J) -> R + Sync) -> Vec<R> {
    debug_assert!(rayon::current_thread_index().is_none(), "a job hands out jobs");
    let jobs = Mutex::new(jobs.into_iter().enumerate());
    let next = || jobs.lock().ok()?.next(); // the lock ends before the job begins
    let share = || iter::from_fn(next).map(|(number, job)| (number, one(job))).collect::<Vec<_>>();
    let mut results: Vec<(usize, R)> = rayon::broadcast(|_| share()).into_iter().flatten().collect();
    results.sort_unstable_by_key(|(number, _)| *number);
    results.into_iter().map(|(_, result)| result).collect()
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    #[test]
    fn the_results_are_in_the_order_of_the_jobs_whichever_ends_first() {
        let squares = each(0..100_u64, |number| {
            std::thread::sleep(Duration::from_micros(100 - number));
            number * number
        });
        assert!(squares.into_iter().eq((0..100).map(|number| number * number)));
        assert!(each(Vec::<u8>::new(), |job| job).is_empty());
    }

    #[test]
    #[should_panic(expected = "the seventh")]
    fn a_job_that_panics_is_no_result() {
        each(0..20, |number| assert!(number != 7, "the seventh"));
    }
}
