//! The ring of steps, its readings, and its end.

use super::*;

const GRID: Grid = Grid { origin: Instant::from_micros(5_000), step: Duration::from_millis(10) };

fn state(mm: i64) -> State {
    State { position: Position::from_mm(mm).ring(), speed: Speed::from_mm_per_s(10_000), ..State::default() }
}

fn at_ten_metres_per_second<const N: usize>(first: i64, count: i64) -> Horizon<N> {
    let mut horizon = Horizon::empty();
    let time = GRID.time_of(first);
    let place = |index: i64| 100_000 + (index - first) * 100;
    let speed = Speed::from_mm_per_s(10_000);
    let anchor = Anchor {
        at: time.minus(Duration::from_millis(5)),
        position: Position::from_mm(99_950),
        speed,
        ..Anchor::default()
    };
    horizon.start(anchor, first, Position::from_mm(100_000), state(100_000));
    for index in first + 1..first + count {
        horizon.push(state(place(index)));
    }
    horizon
}

#[test]
fn a_reading_between_steps_lies_on_the_line_of_a_constant_speed() {
    let horizon = at_ten_metres_per_second::<8>(3, 8);
    for micros in (-30_000..=70_000i64).step_by(700) {
        let at = GRID.time_of(3).plus(Duration::from_micros(micros));
        let reading = horizon.read(at, &GRID, true).unwrap();
        let exact = 100.0 + micros as f64 * 1e-5;
        assert!((reading.position.get().to_num::<f64>() - exact).abs() < 5e-6, "{micros} {reading:?}");
        assert_eq!(reading.speed.to_mm_per_s(), 10_000);
    }
}

#[test]
fn beyond_its_end_the_last_value_is_held() {
    let horizon = at_ten_metres_per_second::<8>(0, 4);
    let reading = horizon.read(GRID.time_of(1000), &GRID, true).unwrap();
    assert_eq!(reading.position.to_mm(), 100_300);
}

#[test]
fn a_full_ring_drops_its_first_step_and_keeps_absolute_positions() {
    let mut horizon = at_ten_metres_per_second::<8>(0, 8);
    for n in 8..100_000 {
        horizon.push(state(100_000 + n * 100));
        assert_eq!((horizon.first(), horizon.last(), horizon.len()), (n - 7, n, 8));
    }
    let reading = horizon.read(GRID.time_of(99_999), &GRID, true).unwrap();
    assert_eq!(reading.position.to_mm(), 100_000 + 9_999_900);
}

#[test]
fn without_interpolation_the_nearest_step_is_read() {
    let horizon = at_ten_metres_per_second::<8>(0, 8);
    let read = |micros| horizon.read(GRID.time_of(2).plus(Duration::from_micros(micros)), &GRID, false).unwrap();
    assert_eq!(read(4_999).position.to_mm(), 100_200);
    assert_eq!(read(5_000).position.to_mm(), 100_300);
}

#[test]
fn an_empty_horizon_has_nothing_to_read() {
    assert_eq!(Horizon::<8>::empty().read(GRID.time_of(0), &GRID, true), None);
    assert_eq!(Horizon::<8>::empty().read(GRID.time_of(0), &GRID, false), None);
}

#[test]
fn a_horizon_goes_back_to_where_it_ended() {
    let mut horizon = at_ten_metres_per_second::<8>(0, 4);
    let (end, last) = (horizon.mark(), horizon.last());
    horizon.push(state(123_456));
    horizon.push(state(234_567));
    horizon.cut(&end);
    assert_eq!((horizon.last(), horizon.tip()), (last, state(100_300)));
    let reading = horizon.read(GRID.time_of(1000), &GRID, true).unwrap();
    assert_eq!(reading.position.to_mm(), 100_300);
}
