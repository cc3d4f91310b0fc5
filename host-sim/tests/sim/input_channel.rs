//! Facts about the V2X channel, by seed and by recording.

use holdover_sim::input::impairment::{AppliesTo, ChannelModel, Impairment, Link, Window};
use holdover_sim::input::recording::ChannelTrace;
use holdover_sim::sim::channel::{Channel, OLDEST_S};
use std::path::Path;

const LINK: Link = Link { from: 1, to: 2 };

fn random(delay_mean_s: f64, delay_std_s: f64, loss: f64, duplicate: f64, outages: &[(f64, f64)]) -> ChannelModel {
    let outages = outages.iter().map(|&(from_s, to_s)| Window { from_s, to_s }).collect();
    ChannelModel {
        impairment: Impairment::Random { delay_mean_s, delay_std_s, loss, duplicate, outages },
        applies_to: AppliesTo::Vehicles(vec![2]),
    }
}

fn recorded(csv: &str) -> ChannelModel {
    let trace = ChannelTrace::parse(Path::new("c.csv"), csv.as_bytes()).unwrap();
    ChannelModel { impairment: Impairment::Recorded(trace), applies_to: AppliesTo::All }
}

/// Delays of the first copies of `n` messages at 10 Hz.
fn delays(channel: &mut Channel, link: Link, n: usize) -> Vec<Option<f64>> {
    for message in 0..n {
        channel.send(link, message as f64 / 10.0);
    }
    channel.link(link).unwrap().messages.iter().map(|&(_, delay)| delay).collect()
}

#[test]
fn the_papers_delay_is_a_truncated_normal_and_its_loss_a_tenth() {
    let mut channel = Channel::new(&random(0.040, 0.0259, 0.1, 0.0, &[]), 1);
    let n = 100_000;
    let arrived: Vec<f64> = delays(&mut channel, LINK, n).into_iter().flatten().collect();
    let lost = 1.0 - arrived.len() as f64 / n as f64;
    assert!((lost - 0.1).abs() < 0.004, "{lost}");
    assert!(arrived.iter().all(|&delay| delay >= 0.0));
    // Normal(µ, σ) on [0, ∞) with a = µ/σ = 1.5444 and λ = φ(a)/Φ(a) = 0.12895: µ + σλ, and σ sqrt(1 - aλ - λ²).
    let mean = arrived.iter().sum::<f64>() / arrived.len() as f64;
    let variance = arrived.iter().map(|delay| (delay - mean).powi(2)).sum::<f64>() / arrived.len() as f64;
    assert!((mean - 0.04334).abs() < 0.0004, "{mean}");
    assert!((variance.sqrt() - 0.02294).abs() < 0.0003, "{}", variance.sqrt());
}

#[test]
fn what_is_sent_inside_an_outage_is_lost_and_its_ends_are_half_open() {
    let mut channel = Channel::new(&random(0.0, 0.0, 0.0, 0.0, &[(4.0, 6.0), (6.0, 8.0)]), 1);
    for (at_s, arrives) in [(3.999, true), (4.0, false), (6.0, false), (7.999, false), (8.0, true)] {
        assert_eq!(!channel.send(LINK, at_s).is_empty(), arrives, "{at_s}");
    }
}

#[test]
fn a_message_on_its_way_when_the_outage_begins_still_arrives() {
    let mut channel = Channel::new(&random(0.5, 0.0, 0.0, 0.0, &[(4.0, 6.0)]), 1);
    assert_eq!(channel.send(LINK, 3.9).as_slice(), [4.4]);
}

#[test]
fn the_papers_two_outages_are_one_silence_of_about_four_seconds() {
    let mut channel = Channel::new(&random(0.040, 0.0259, 0.0, 0.0, &[(4.0, 6.0), (6.0, 8.0)]), 3);
    delays(&mut channel, LINK, 200);
    let silences = channel.link(LINK).unwrap().silences(0.5, 0.0, 20.0);
    assert_eq!(silences.len(), 1, "{silences:?}");
    assert!((3.9..4.1).contains(&silences[0].from_s) && (8.0..8.2).contains(&silences[0].to_s), "{silences:?}");
}

#[test]
fn a_link_over_which_nothing_arrives_is_one_silence_from_beginning_to_end() {
    let mut channel = Channel::new(&random(0.0, 0.0, 1.0, 0.0, &[]), 3);
    delays(&mut channel, LINK, 20);
    assert_eq!(channel.link(LINK).unwrap().silences(0.5, 0.0, 2.0), [Window { from_s: 0.0, to_s: 2.0 }]);
}

#[test]
fn what_happens_on_a_link_depends_neither_on_other_links_nor_on_the_order_of_calls() {
    let model = random(0.040, 0.0259, 0.1, 0.1, &[]);
    let other = Link { from: 2, to: 3 };
    let mut alone = Channel::new(&model, 9);
    let mut mixed = Channel::new(&model, 9);
    for message in 0..50 {
        let at_s = f64::from(message);
        mixed.send(other, at_s);
        mixed.send(Link { from: 2, to: 1 }, at_s);
        assert_eq!(alone.send(LINK, at_s), mixed.send(LINK, at_s));
    }
    assert_ne!(mixed.link(other), mixed.link(LINK));
}

#[test]
fn another_seed_is_another_channel_and_the_same_seed_the_same() {
    let model = random(0.040, 0.0259, 0.1, 0.1, &[]);
    let run = |seed| delays(&mut Channel::new(&model, seed), LINK, 50);
    assert_eq!(run(1), run(1));
    assert_ne!(run(1), run(2));
}

#[test]
fn outages_and_loss_leave_the_delays_of_the_other_messages_alone() {
    let clear = delays(&mut Channel::new(&random(0.040, 0.0259, 0.0, 0.0, &[]), 5), LINK, 100);
    let impaired = delays(&mut Channel::new(&random(0.040, 0.0259, 0.3, 0.0, &[(2.0, 4.0)]), 5), LINK, 100);
    let kept: Vec<_> = clear.iter().zip(&impaired).filter(|(_, after)| after.is_some()).collect();
    assert!((40..80).contains(&kept.len()), "{}", kept.len());
    assert!(kept.iter().all(|(before, after)| before == after));
}

#[test]
fn links_that_the_model_does_not_apply_to_are_clean() {
    let mut channel = Channel::new(&random(0.5, 0.0, 0.0, 0.0, &[(0.0, 1.0)]), 1);
    assert_eq!(channel.send(Link { from: 0, to: 1 }, 0.3).as_slice(), [0.3]);
    assert!(channel.send(Link { from: 2, to: 1 }, 0.3).is_empty(), "the ego's transmit link is impaired too");
}

#[test]
fn a_duplicate_is_a_second_copy_with_a_delay_of_its_own() {
    let mut channel = Channel::new(&random(0.040, 0.0259, 0.0, 1.0, &[]), 1);
    let arrivals = channel.send(LINK, 1.0);
    assert_eq!(arrivals.len(), 2);
    assert_ne!(arrivals[0], arrivals[1]);
    let counts = channel.link(LINK).unwrap().counts;
    assert_eq!((counts.sent, counts.delivered, counts.duplicates), (1, 1, 1));
}

#[test]
fn a_delay_longer_than_the_interval_reorders() {
    let mut channel = Channel::new(&recorded("t_s,delay_s\n0,0.5\n0.1,0.02\n"), 1);
    assert!(channel.send(LINK, 0.0)[0] > channel.send(LINK, 0.1)[0]);
}

#[test]
fn a_recording_is_followed_row_by_row_and_its_empty_delays_are_losses() {
    let mut channel = Channel::new(&recorded("t_s,delay_s\n0,0.036\n0.1,\n0.2,0.04\n"), 1);
    assert_eq!(delays(&mut channel, LINK, 3), [Some(0.036), None, Some(0.04)]);
    let counts = channel.link(LINK).unwrap().counts;
    assert_eq!((counts.sent, counts.delivered, counts.lost), (3, 2, 1));
}

#[test]
fn the_modem_drops_a_message_whose_stamp_could_soon_be_taken_for_a_new_one() {
    let mut channel = Channel::new(&recorded("t_s,delay_s\n0,10\n1,10.001\n2,0\n"), 1);
    assert_eq!(channel.send(LINK, 0.0).as_slice(), [OLDEST_S]);
    assert!(channel.send(LINK, 1.0).is_empty());
    assert_eq!(channel.link(LINK).unwrap().counts.expired, 1);
}
