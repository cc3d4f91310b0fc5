//! The world of `live`: what is driven and changed while it goes on is, saved and run, the same to the last bit.

mod heard;

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

use heard::Heard;
use holdover_sim::commands::live::order::Order;
use holdover_sim::commands::live::scene::Pulse;
use holdover_sim::commands::live::stage::{Play, Stage};
use holdover_sim::error::Error;
use holdover_sim::input::scenario::{Event, Overrides, Part, Scenario, saved};
use holdover_sim::measure::simulate::simulate;
use holdover_sim::sim::world::Tick;

fn read(text: &str, overrides: &Overrides) -> Scenario {
    Scenario::parse(Path::new("live.toml"), text, overrides).unwrap()
}

/// Everything of a tick, bit by bit.
fn bits(tick: &Tick) -> Vec<u64> {
    let target = tick.target.map(|target| (target.position_m, target.speed_mps, target.age_s));
    let (position_m, speed_mps, age_s) = target.unwrap_or_default();
    let bound = tick.target.and_then(|target| target.bound);
    let ends = bound.map_or((0.0, 0.0), |bound| (bound.lowest_position_m, bound.highest_position_m));
    [
        tick.position_m,
        tick.speed_mps,
        tick.acceleration_mps2,
        tick.command_mps2,
        position_m,
        speed_mps,
        age_s,
        ends.0,
        ends.1,
        f64::from(u8::from(tick.limited)),
    ]
    .map(f64::to_bits)
    .to_vec()
}

/// What is ordered after so many ticks.
fn orders() -> Vec<(u64, Order)> {
    vec![
        (120, Order::Drive { vehicle: 0, mps2: -2.35 }),
        (121, Order::Links { vehicle: None, delay_mean_s: 0.1 + 0.2, delay_std_s: 0.05, loss: 0.3 }),
        (300, Order::Outage { vehicle: Some(2), seconds: 1.7 }),
        (333, Order::Drive { vehicle: 0, mps2: 1.2 }),
        (400, Order::Release { vehicle: 0 }),
        (400, Order::Switch { vehicle: Some(3), part: Part::Holdover, on: false }),
        (450, Order::Switch { vehicle: None, part: Part::RangeSensor, on: false }),
        (480, Order::Switch { vehicle: Some(1), part: Part::Envelope, on: false }),
    ]
}

const TICKS: u64 = 700;

/// A scenario that counts how often it begins.
struct Counted(Scenario, Arc<AtomicU32>);

impl Play for Counted {
    type Stage<'a> = <Scenario as Play>::Stage<'a>;

    fn begin(&self, events: &[Event]) -> std::io::Result<Self::Stage<'_>> {
        self.1.fetch_add(1, Ordering::Relaxed);
        self.0.begin(events)
    }

    fn events(&self) -> &[Event] {
        self.0.events()
    }

    fn period_s(&self) -> f64 {
        Play::period_s(&self.0)
    }

    fn check(&self, event: &Event) -> Result<(), Error> {
        self.0.check(event)
    }
}

#[test]
fn a_drive_that_is_saved_and_run_is_the_same_to_the_last_bit() {
    let overrides = Overrides { seed: Some(7), set: vec!["vehicle.1.time_gap_s=0.8".into()], ..Overrides::default() };
    let text = "ego = 1\n[[vehicle]]\n[[vehicle]]\ngap_m = 17.3\n[[vehicle]]\n[[vehicle]]\n[bus]\nkind = \"fd\"\n";
    let scenario = read(text, &overrides);
    let mut stage = scenario.begin(&scenario.events).unwrap();
    let (mut live, mut events, mut orders) = (Vec::new(), Vec::new(), orders().into_iter().peekable());
    while stage.ticks() < TICKS {
        while let Some((_, order)) = orders.next_if(|(tick, _)| *tick == stage.ticks()) {
            let event = order.event(stage.next_s()).unwrap();
            event.check(&scenario.fleet()).unwrap();
            stage.add(event);
            events.push(event);
        }
        stage.step().unwrap();
        live.push(stage.latest().iter().map(bits).collect::<Vec<_>>());
        let _ = stage.scene(&Pulse::default()); // to look changes nothing
        if stage.ticks().is_multiple_of(97) {
            stage = stage.clone(); // a copy goes on in the same way
        }
    }
    let duration_s = TICKS as f64 * scenario.period_s;
    let saved = saved::text((Path::new("live.toml"), text), &overrides, &events, duration_s).unwrap();
    let again = read(&saved, &Overrides::default());
    assert_eq!(again, Scenario { events, duration_s, ..scenario });
    let (trace, _) = simulate(&again, again.seed, None, |_| {}).unwrap();
    assert_eq!(trace.times_s.len(), live.len());
    for (tick, ticks) in live.iter().enumerate() {
        let run: Vec<_> = trace.vehicles.iter().map(|vehicle| bits(&vehicle[tick])).collect();
        assert_eq!(&run, ticks, "tick {tick}");
    }
    let speed = |tick: usize| trace.vehicles[0][tick].speed_mps;
    assert!(speed(300) < speed(120) - 2.0 && speed(399) > speed(370), "what was driven was driven");
}

#[test]
fn ten_seconds_back_and_on_the_same_is_seen_again_until_somebody_intervenes() {
    let heard = Heard::begin(read("", &Overrides::default()));
    for (tick, order) in orders() {
        if heard.journal().1 < tick {
            heard.step_to(tick);
        }
        heard.order(order).unwrap();
    }
    heard.step_to(1500);
    let (first, journal) = (heard.vehicles(1500), heard.journal().0);
    assert_eq!(journal.len(), orders().len());
    heard.order(Order::Back { seconds: 10.0 }).unwrap();
    assert_eq!(heard.journal(), (journal, 500));
    heard.step_to(1500);
    assert_eq!(heard.vehicles(1500), first);
    // After a way back to before the last four orders, another order takes their place.
    heard.order(Order::Back { seconds: 11.05 }).unwrap();
    heard.order(Order::Outage { vehicle: None, seconds: 1.0 }).unwrap();
    let (events, ticks) = heard.journal();
    assert_eq!((events.len(), ticks), (5, 395));
    heard.step_to(1500);
    assert_ne!(heard.vehicles(1500), first);
    assert_eq!(heard.end(), (events, 1500));
}

#[test]
fn an_envelope_is_switched_at_once_in_the_middle_of_a_run_that_stays_the_same_up_to_then() {
    let begun = Arc::default();
    let heard = Heard::begin(Counted(read("", &Overrides::default()), Arc::clone(&begun)));
    heard.step_to(600);
    let begun_before = begun.load(Ordering::Relaxed);
    let before = heard.vehicles(600);
    heard.order(Order::Switch { vehicle: None, part: Part::Envelope, on: false }).unwrap();
    assert_eq!(heard.journal().1, 600);
    assert_eq!(heard.vehicles(600), before);
    heard.step_to(700);
    let after = heard.vehicles(700);
    let engaged = |scene: &serde_json::Value| scene.as_array().unwrap().iter().all(|seen| seen["has_envelope"] == true);
    assert!(engaged(&before) && !engaged(&after));
    assert_eq!(begun.load(Ordering::Relaxed), begun_before, "it is not played again from the beginning");
    heard.order(Order::Switch { vehicle: None, part: Part::Envelope, on: true }).unwrap();
    heard.step_to(701);
    assert!(engaged(&heard.vehicles(701)));
    heard.order(Order::Back { seconds: 0.01 }).unwrap();
    heard.order(Order::Links { vehicle: None, delay_mean_s: 0.1, delay_std_s: 0.0, loss: 0.0 }).unwrap();
    let (events, ticks) = heard.end();
    assert_eq!((events.len(), ticks), (3, 700));
}

#[test]
fn a_new_start_forgets_what_was_driven() {
    let heard = Heard::begin(read("", &Overrides::default()));
    heard.step_to(300);
    let first = heard.vehicles(300);
    heard.order(Order::Restart {}).unwrap();
    heard.step_to(100);
    heard.order(Order::Drive { vehicle: 0, mps2: -3.0 }).unwrap();
    heard.step_to(300);
    assert_ne!(heard.vehicles(300), first);
    heard.order(Order::Restart {}).unwrap();
    heard.step_to(300);
    assert_eq!(heard.vehicles(300), first);
    assert_eq!(heard.end().0, []);
}
