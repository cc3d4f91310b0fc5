//! A unit on this host lives through a log: what it sends leaves, and what the log has led it through.

use std::collections::BTreeSet;
use std::error::Error;
use std::fmt;

use holdover::wire::catalogue::{Content, Speaker};
use holdover_replay::{Event, RECORD, Unit, decode, live, refusals};

use crate::{Log, line};

/// What became of a unit.
#[derive(Default)]
pub struct Life {
    /// The records of all frames that it sent, and at the end those of what it refused.
    pub sent: Vec<u8>,
    /// The modes that it was in.
    pub modes: BTreeSet<String>,
    /// Frames that it refused.
    pub refused: u64,
    /// Ticks in which the envelope changed the command.
    pub limited: usize,
    /// `OwnPass` that it sent.
    pub own_passes: usize,
    /// `PeerPass` that it took in.
    pub peer_passes: usize,
    /// The intersections that it has left behind, one after the other.
    pub passed: Vec<u8>,
}

impl Life {
    /// Of a unit of this log.
    pub fn through(log: &Log) -> Result<Self, Box<dyn Error>> {
        let mut unit = Box::new(Unit::idle());
        log.head.start(&mut unit).ok_or("the unit refuses the head of the log")?;
        let mut life = Self::default();
        let mut next = None;
        for (at, event) in &log.events {
            let answer = live(&mut unit, *at, event, |record| {
                life.own_passes += usize::from(decode(&record).is_some_and(|(_, sent)| is_pass(&sent, Speaker::Own)));
                life.sent.extend(record);
            });
            life.peer_passes += usize::from(answer.is_ok() && is_pass(event, Speaker::Peer));
            life.limited += usize::from(answer.is_ok_and(|tick| tick.is_some_and(|answer| answer.command.limited)));
            life.modes.insert(format!("{:?}", unit.mode().code()));
            let crossing = unit.coordination().crossing().map(|crossing| crossing.intersection.id);
            if crossing != next {
                life.passed.extend(next);
                next = crossing;
            }
        }
        life.refused = unit.health().total().into();
        life.sent.extend(refusals(&unit).flatten());
        Ok(life)
    }
}

fn is_pass(event: &Event, speaker: Speaker) -> bool {
    let Event::Frame(frame) = event else { return false };
    line(frame.id).is_some_and(|line| line.content == Content::Pass(speaker))
}

impl fmt::Display for Life {
    fn fmt(&self, to: &mut fmt::Formatter) -> fmt::Result {
        let Self { sent, modes, refused, limited, own_passes, peer_passes, passed } = self;
        let modes: Vec<&str> = modes.iter().map(String::as_str).collect();
        write!(to, "{} records sent, {refused} frames refused; {}; ", sent.len() / RECORD, modes.join(", "))?;
        write!(to, "{limited} ticks limited; {own_passes} OwnPass, {peer_passes} PeerPass, passed {passed:?}")
    }
}
