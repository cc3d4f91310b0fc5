//! The follower's step of the prediction in floating point, line by line what the core computes in fixed point: a state, a
//! predecessor's steps and a law enter, the vehicle's steps leave. For comparison only; the core has no float.
//!
//! The exponential of a lag is `micromath`'s in `f32`, as the crate is made for an FPU without one, and `libm`'s in `f64`.

use micromath::F32Ext;

macro_rules! follower {
    ($name:ident, $float:ty, $exp:expr) => {
        /// One follower with its steps.
        pub mod $name {
            #[allow(unused_imports)] // one of the two has it
            use super::F32Ext;

            /// Position and speed at one step.
            #[derive(Clone, Copy, Default)]
            pub struct Step {
                /// In metres.
                pub position: $float,
                /// In m/s.
                pub speed: $float,
            }

            /// The constants of a step; times in s, accelerations in m/s².
            #[derive(Clone, Copy)]
            pub struct Law {
                /// `K` of the semi-implicit step.
                pub gain: $float,
                /// `t_g + δt`.
                pub gap: $float,
                /// `γ`.
                pub damping: $float,
                /// `l + s_0`.
                pub spacing: $float,
                /// `-(t_g + δt) v_c`.
                pub farthest: $float,
                /// `δt`.
                pub step: $float,
                /// `e^(-δt/T)`.
                pub keep: $float,
                /// `T (1 - e^(-δt/T))`.
                pub slip: $float,
                /// Limit on braking, negative.
                pub floor: $float,
                /// Limit on acceleration.
                pub ceiling: $float,
                /// Limit on jerk times `δt`.
                pub slew: $float,
            }

            impl Law {
                /// This one, with the lag `T` of the actuators of another vehicle.
                #[inline(never)]
                pub fn with_lag(self, lag: $float) -> Self {
                    let exp: fn($float) -> $float = $exp;
                    let keep = exp(-self.step / lag);
                    Self { keep, slip: lag * (1.0 - keep), ..self }
                }
            }

            /// Of a whole number.
            pub fn from(number: u16) -> $float {
                number.into()
            }

            /// As many steps as there is room for.
            #[inline(never)]
            pub fn run(law: &Law, ahead: &[Step], out: &mut [Step]) {
                let Some(first) = ahead.first() else { return };
                let (mut position, mut speed) = (first.position - 18.11, first.speed);
                let (mut acceleration, mut demand): ($float, $float) = (0.0, 0.0);
                for (out, ahead) in out.iter_mut().zip(ahead) {
                    let behind = position - ahead.position + law.spacing + law.damping * (speed - ahead.speed);
                    let request = -law.gain * (larger(behind, law.farthest) + law.gap * speed);
                    let low = larger(demand - law.slew, law.floor);
                    let high = smaller(demand + law.slew, law.ceiling);
                    demand = larger(smaller(request, high), low);
                    let behind = acceleration - demand;
                    acceleration = demand + law.keep * behind;
                    let mut after = speed + demand * law.step + behind * law.slip;
                    if after < 0.0 {
                        after = 0.0;
                        acceleration = larger(acceleration, 0.0);
                    }
                    position += (speed + after) / 2.0 * law.step;
                    speed = after;
                    *out = Step { position, speed };
                }
            }

            // By comparison, because `max` and `min` are calls that look after what is not a number.
            #[inline(always)]
            fn larger(a: $float, b: $float) -> $float {
                if a > b { a } else { b }
            }

            #[inline(always)]
            fn smaller(a: $float, b: $float) -> $float {
                if a < b { a } else { b }
            }

            /// The law of the road's followers.
            pub const LAW: Law = Law {
                gain: 0.492_6,
                gap: 1.01,
                damping: 2.0,
                spacing: 6.8,
                farthest: -16.24,
                step: 0.01,
                keep: 0.967_2,
                slip: 0.009_835,
                floor: -4.0,
                ceiling: 2.5,
                slew: 0.05,
            };
        }
    };
}

follower!(single, f32, |x| x.exp());
follower!(double, f64, libm::exp);
