//! The predictor that a user would otherwise take: a Kalman filter of position, speed and constant acceleration in `f32`, from
//! the crate `minikalman`. Steps enter, predictions of the state and its deviation leave; the root of the variance is `micromath`'s.
#![allow(non_snake_case)] // the crate's names of matrices

use micromath::F32Ext;
use minikalman::prelude::*;
use minikalman::regular::RegularKalmanBuilder;

/// So many predictions; the position at the last, and its standard deviation, so that the covariance is computed too.
#[inline(never)]
pub fn predict(steps: usize) -> (f32, f32) {
    impl_buffer_x!(mut x, 3, f32, 0.0);
    impl_buffer_A!(mut A, 3, f32, 0.0);
    impl_buffer_P!(mut P, 3, f32, 0.0);
    impl_buffer_Q_direct!(mut Q, 3, f32, 0.0);
    impl_buffer_temp_x!(mut predicted, 3, f32, 0.0);
    impl_buffer_temp_P!(mut scratch, 3, f32, 0.0);
    let mut filter = RegularKalmanBuilder::new::<3, f32>(A, x, P, Q, predicted, scratch);
    filter.state_vector_mut().apply(|x| {
        x.set_row(1, 11.0);
        x.set_row(2, 0.1);
    });
    filter.state_transition_mut().apply(|A| {
        A.make_identity();
        A.set_at(0, 1, 0.01);
        A.set_at(0, 2, 0.000_05);
        A.set_at(1, 2, 0.01);
    });
    filter.estimate_covariance_mut().apply(|P| P.make_identity());
    filter.direct_process_noise_mut().apply(|Q| Q.make_scalar(0.001));
    for _ in 0..steps {
        filter.predict();
    }
    (filter.state_vector().get_row(0), filter.estimate_covariance().get_at(0, 0).sqrt())
}
