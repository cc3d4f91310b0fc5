//! What the exponential and the root of a float's prediction cost, and how far they are off: nothing enters, a line per measurement
//! leaves (`name peers steps count`). Errors are in thousandths of a millionth; of a place, in micrometres.
#![no_std]
#![no_main]

use core::hint::black_box;
use cortex_m_rt::entry;
use holdover::model::Decay;
use holdover::time::Duration;
use holdover_image::counter::Counter;
use holdover_image::float::double;
use holdover_image::float::single::{self, LAW};
use holdover_image::output::say;
use holdover_image::semihosting::end;
use micromath::F32Ext;

const STEPS: usize = 400;
const STEP: Duration = Duration::from_millis(10);

/// The core's, whose fraction is within 4e-9 of the true one.
#[inline(never)]
fn decay(lag_ms: i64) -> Decay {
    Decay::over(STEP, Duration::from_millis(lag_ms))
}

fn exact(lag_ms: i64) -> f64 {
    libm::exp(-10.0 / lag_ms as f64)
}

fn of_the_core(lag_ms: i64) -> f64 {
    f64::from(decay(lag_ms).keep.to_bits()) / f64::from(1u32 << 30)
}

fn of_micromath(lag_ms: i64) -> f64 {
    LAW.with_lag(lag_ms as f32 / 1000.0).keep.into()
}

/// The largest error of a fraction over the lags that a vehicle may publish, in parts of 1e9.
fn largest(fraction: fn(i64) -> f64) -> u32 {
    (20..2_000).map(|lag_ms| (libm::fabs(fraction(lag_ms) - exact(lag_ms)) * 1e9) as u32).max().unwrap_or(0)
}

/// Of roots of 0.01 to 100, relative.
fn largest_of_roots() -> u32 {
    let error = |hundredths: u32| {
        let square = hundredths as f32 / 100.0;
        (libm::fabs(f64::from(square.sqrt()) / libm::sqrt(square.into()) - 1.0) * 1e9) as u32
    };
    (1..10_000).map(error).max().unwrap_or(0)
}

/// Where a follower is after four seconds behind a vehicle that drives faster and faster, this far from the origin, in metres.
macro_rules! place {
    ($module:ident, $law:expr, $origin:expr, $memory:expr) => {{
        let [ahead, out] = $memory;
        for (number, step) in (0u16..).zip(ahead.iter_mut()) {
            let time = $module::from(number) / 100.0;
            *step = $module::Step { position: $origin + 18.11 + (11.0 + time) * time, speed: 11.0 + 2.0 * time };
        }
        $module::run($law, ahead, out);
        out.last().map_or(0.0, |step| f64::from(step.position))
    }};
}

#[entry]
fn main() -> ! {
    static mut SINGLE: [[single::Step; STEPS]; 2] = [[single::Step { position: 0.0, speed: 0.0 }; STEPS]; 2];
    static mut DOUBLE: [[double::Step; STEPS]; 2] = [[double::Step { position: 0.0, speed: 0.0 }; STEPS]; 2];
    let counter = Counter::start();
    let (_, fixed) = counter.count(|| black_box(decay(black_box(300))));
    let (_, single) = counter.count(|| black_box(LAW.with_lag(black_box(0.3))).slip);
    let (_, root) = counter.count(|| black_box(black_box(0.3f32).sqrt()));
    let (law, truth) = (LAW.with_lag(0.3), double::LAW.with_lag(0.3));
    let off = |metres: f64| (libm::fabs(metres) * 1e6) as u32;
    let near = off(place!(single, &law, 0.0, &mut *SINGLE) - place!(double, &truth, 0.0, &mut *DOUBLE));
    let far = off(place!(single, &law, 5_000.0, &mut *SINGLE) - place!(double, &truth, 5_000.0, &mut *DOUBLE));
    for (name, count) in [
        ("exp-fixed", fixed),
        ("exp-micromath", single),
        ("sqrt-micromath", root),
        ("exp-fixed-error", largest(of_the_core)),
        ("exp-micromath-error", largest(of_micromath)),
        ("sqrt-micromath-error", largest_of_roots()),
        ("place-f32-near", near),
        ("place-f32-far", far),
    ] {
        say(format_args!("{name} 1 {STEPS} {count}"));
    }
    end(true)
}
