//! The V2X channel: a message enters, its copies leave with delay, loss, duplication and reordering, seeded.
//!
//! Every link (one sender, one receiver) has random numbers of its own, so what happens on one link does not depend on
//! what is sent over another. Four numbers are drawn per message, always in this order and whatever becomes of the
//! message: loss, delay, duplication, delay of the duplicate. So a run with other outages or another loss rate has the
//! same delays.
//!
//! - *Delay* is a normal distribution truncated at 0 by drawing again. So its mean is a little above `delay_mean_s`:
//!   43.3 ms for the paper's 40 ms and 25.9 ms.
//! - *Loss* is independent per message. A message *sent* inside an outage `[from_s, to_s)` is lost. A message that is
//!   already on its way when the outage begins arrives.
//! - *Duplication* sends a second copy with a delay of its own.
//! - *Reordering* follows from the delays.
//! - A *recording* replaces all of that. [`ChannelTrace::delay_at`](crate::input::recording::ChannelTrace::delay_at)
//!   states how a recording is read.
//! - *Changes* during the run are in [`changes`].
//! - The receiving modem drops a message that is older than [`OLDEST_S`] on arrival. Stamps repeat after 13.1 s, so a
//!   message that is a whole period old would be taken for a new one.

use crate::input::impairment::{ChannelModel, Impairment, Link, Window};
use crate::input::scenario::Radio;
use crate::streams::{Purpose, stream, unit};
use crate::thinned::{Thinning, halve};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Normal};
use std::collections::BTreeMap;

pub mod changes;

use changes::Changes;

/// The age beyond which a receiving modem drops a message, in seconds.
pub const OLDEST_S: f64 = 10.0;

/// Arrival times of one message's copies, in seconds; none if it was lost.
pub type Arrivals = heapless::Vec<f64, 2>;

/// The counts of a link, by what became of its messages; `sent = delivered + lost + expired`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Messages sent.
    pub sent: u64,
    /// Messages of which at least one copy arrived.
    pub delivered: u64,
    /// Messages lost by chance, in an outage, or in the recording.
    pub lost: u64,
    /// Messages dropped by the receiving modem because they were older than [`OLDEST_S`].
    pub expired: u64,
    /// Second copies that arrived, beyond `delivered`.
    pub duplicates: u64,
}

/// Everything that happened on one link, for the report.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LinkRecord {
    /// The counts.
    pub counts: Counts,
    /// Per message, in the order of sending: its time of sending, and the delay of its first copy. `None`: no copy
    /// arrived.
    pub messages: Vec<(f64, Option<f64>)>,
    /// Which messages are kept: every one, unless the record is of bounded length.
    pub thinning: Thinning,
}

impl LinkRecord {
    /// The gaps longer than `longer_than_s` between `from_s` and `to_s` in which no message arrived.
    #[must_use]
    pub fn silences(&self, longer_than_s: f64, from_s: f64, to_s: f64) -> Vec<Window> {
        let mut arrivals: Vec<f64> = self.messages.iter().filter_map(|&(at, delay)| Some(at + delay?)).collect();
        arrivals.retain(|at| (from_s..to_s).contains(at));
        arrivals.sort_by(f64::total_cmp);
        let begins = std::iter::once(from_s).chain(arrivals.iter().copied());
        let ends = arrivals.iter().copied().chain(std::iter::once(to_s));
        begins
            .zip(ends)
            .map(|(from_s, to_s)| Window { from_s, to_s })
            .filter(|silence| silence.to_s - silence.from_s > longer_than_s)
            .collect()
    }
}

/// The channel of one run.
#[derive(Clone, Debug)]
pub struct Channel {
    model: ChannelModel,
    seed: u64,
    links: BTreeMap<Link, (ChaCha8Rng, LinkRecord)>,
    /// For a link on which nothing has been sent yet.
    thinning: Thinning,
    changes: Changes,
}

impl Channel {
    /// A channel on which nothing has been sent yet.
    #[must_use]
    pub fn new(model: &ChannelModel, seed: u64) -> Self {
        Self {
            model: model.clone(),
            seed,
            links: BTreeMap::new(),
            thinning: Thinning::default(),
            changes: Changes::default(),
        }
    }

    /// What happens to the links beside the model.
    pub fn changes(&mut self) -> &mut Changes {
        &mut self.changes
    }

    /// Of a vehicle or of all, the delay and the loss that were set since the start.
    #[must_use]
    pub fn radios(&self) -> &[(Option<usize>, Radio)] {
        self.changes.radios()
    }

    /// The same with at most this many messages in the record of a link. Of more every second, every fourth and so on is kept.
    #[must_use]
    pub fn of_at_most(self, messages: usize) -> Self {
        Self { thinning: Thinning::to(messages), ..self }
    }

    /// Sends a message over a link, at a time in seconds since the start of the run, and returns when its copies
    /// arrive.
    pub fn send(&mut self, link: Link, at_s: f64) -> Arrivals {
        let seed = self.seed;
        let (generator, record) = self.links.entry(link).or_insert_with(|| {
            let purpose = Purpose::Link { from: link.from as u16, to: link.to as u16 };
            (stream(seed, purpose), LinkRecord { thinning: self.thinning.clone(), ..LinkRecord::default() })
        });
        let is_impaired = self.model.impairs(link);
        let delays = match self.changes.radio(link) {
            Some(radio) => {
                let outages = Vec::new();
                let Radio { delay_mean_s, delay_std_s, loss } = radio;
                let changed = Impairment::Random { delay_mean_s, delay_std_s, loss, duplicate: 0.0, outages };
                changed.delays(at_s, generator)
            }
            None if is_impaired => self.model.impairment.delays(at_s, generator),
            None => [Some(0.0), None],
        };
        record.note(at_s, if self.changes.is_silent(link, at_s) { [None; 2] } else { delays })
    }

    /// Whether every message that is sent over a link now is lost.
    #[must_use]
    pub fn is_silent(&self, link: Link, at_s: f64) -> bool {
        let is_as_modelled = self.model.impairs(link) && self.changes.radio(link).is_none();
        let outages = self.model.outages().filter(|_| is_as_modelled).unwrap_or_default();
        let is_now = |outage: &Window| (outage.from_s..outage.to_s).contains(&at_s);
        self.changes.is_silent(link, at_s) || outages.iter().any(is_now)
    }

    /// Forgets all links of a vehicle that has gone.
    pub fn forget(&mut self, vehicle: usize) {
        self.changes.forget(vehicle);
        self.links.retain(|link, _| link.from != vehicle && link.to != vehicle);
    }

    /// The record of a link; `None` if nothing was ever sent over it.
    #[must_use]
    pub fn link(&self, link: Link) -> Option<&LinkRecord> {
        self.links.get(&link).map(|(_, record)| record)
    }

    /// Every link that was used, with its record, in the order of sender and receiver.
    pub fn links(&self) -> impl Iterator<Item = (Link, &LinkRecord)> {
        self.links.iter().map(|(&link, (_, record))| (link, record))
    }
}

impl Impairment {
    /// The delays of the first and of the second copy of a message.
    fn delays(&self, at_s: f64, generator: &mut ChaCha8Rng) -> [Option<f64>; 2] {
        match self {
            Self::Recorded(trace) => [trace.delay_at(at_s), None],
            Self::Random { delay_mean_s, delay_std_s, loss, duplicate, outages } => {
                let lost = unit(generator) < *loss;
                let first = truncated_normal(*delay_mean_s, *delay_std_s, generator);
                let twice = unit(generator) < *duplicate;
                let second = truncated_normal(*delay_mean_s, *delay_std_s, generator);
                let silent = outages.iter().any(|outage| (outage.from_s..outage.to_s).contains(&at_s));
                if lost || silent { [None, None] } else { [Some(first), twice.then_some(second)] }
            }
        }
    }
}

impl LinkRecord {
    fn note(&mut self, at_s: f64, delays: [Option<f64>; 2]) -> Arrivals {
        let in_time: heapless::Vec<f64, 2> =
            delays.into_iter().flatten().filter(|&delay_s| delay_s <= OLDEST_S).collect();
        self.counts.sent += 1;
        match (in_time.len(), delays[0]) {
            (0, None) => self.counts.lost += 1,
            (0, Some(_)) => self.counts.expired += 1,
            (copies, _) => {
                self.counts.delivered += 1;
                self.counts.duplicates += copies as u64 - 1;
            }
        }
        let place = self.thinning.place();
        if place.is_full {
            halve(&mut self.messages);
        }
        if place.is_kept {
            self.messages.push((at_s, in_time.iter().copied().reduce(f64::min)));
        }
        in_time.iter().map(|delay_s| at_s + delay_s).collect()
    }
}

/// A draw from the normal distribution, repeated until it is not negative. At least half of all draws are kept, because
/// the mean is not negative.
fn truncated_normal(mean: f64, std: f64, generator: &mut ChaCha8Rng) -> f64 {
    let Ok(normal) = Normal::new(mean, std) else { return mean.max(0.0) };
    loop {
        let delay = normal.sample(generator);
        if delay >= 0.0 {
            return delay;
        }
    }
}
