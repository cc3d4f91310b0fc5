//! How the structs lie in memory: their fields in Rust enter, and assertions of a C compiler leave.

use holdover_c::{
    Answer, Approach, Body, Command, Config, Crossing, Envelope, Estimate, Frame, Identifiers, Intersection, Itinerary,
    Law, Limits, Link, Model, Path, PeerIdentifiers, Prediction, Scale, Segment,
};
use std::mem::offset_of;

/// A struct, by its name in C.
pub struct Layout {
    pub name: &'static str,
    size: usize,
    pub fields: Vec<(&'static str, usize)>,
    /// Without pointers it is the same on every target.
    has_pointers: bool,
}

macro_rules! layouts {
    ($($kind:ident $type:ident $name:literal { $($field:ident),* $(,)? })*) => {
        vec![$(Layout {
            name: $name,
            size: size_of::<$type>(),
            fields: vec![$((stringify!($field), offset_of!($type, $field))),*],
            has_pointers: stringify!($kind) == "pointing",
        }),*]
    };
}

pub fn layouts() -> Vec<Layout> {
    layouts! {
        plain PeerIdentifiers "holdover_peer_identifiers_t" { first, stride }
        plain Identifiers "holdover_identifiers_t" {
            time_sync, time_follow_up, motion_command, actuator_state, ego_motion_a, ego_motion_b, driver_request, ego_position,
            range_sensor, peers_unserved, target_estimate_a, target_estimate_b, own_motion_a, own_motion_b, own_horizon,
            own_driving_parameters, own_position, own_route, own_pass, peer_pass, health, peer_motion_a, peer_motion_b,
            peer_horizon, peer_driving_parameters, peer_position, peer_route,
        }
        plain Limits "holdover_limits_t" {
            acceleration_mm_s2, braking_mm_s2, jerk_mm_s3, emergency_braking_mm_s2,
        }
        plain Body "holdover_body_t" { mass_kg, ratio_milli, drag_milli, friction_milli, mechanical_n }
        plain Law "holdover_law_t" {
            time_gap_ms, silent_time_gap_ms, standstill_mm, gain_table, gain_milli, damping_ms, feed_forward_milli, free_road_acceleration_mm_s2,
            target_speed_mm_s, catch_up_milli, max_speed_mm_s,
        }
        plain Model "holdover_model_t" {
            lag, limits, last_demand, standstill, trapezoid, interpolate, stamped, endless, received, smooth,
        }
        plain Prediction "holdover_prediction_t" { step_us, horizon_us, model }
        plain Link "holdover_link_t" {
            period_us, tolerance_us, stale_us, future_us, clock_error_us, slot_reuse_us, holdover_us, ego_timeout_us,
            request_timeout_us, sync_timeout_us, assumed_delay_us,
        }
        plain Envelope "holdover_envelope_t" {
            engaged, acceleration_mm_s2, braking_mm_s2, jerk_mm_s3, speed_mm_s, margin_mm, delay_us, lag_tolerance_milli,
        }
        plain Config "holdover_config_t" {
            station, range_sensor, base_id, station_id, identifiers, period_us, length_mm, lag_ms, limits, body, correction,
            passes, law, prediction, link, envelope,
        }
        plain Frame "holdover_frame_t" { id, extended, remote, length, data }
        plain Command "holdover_command_t" {
            acceleration_mm_s2, effort, mode, cause, limited, effort_value, tick, hold, time_ms,
        }
        plain Estimate "holdover_estimate_t" {
            position_mm, age_us, speed_mm_s, valid, link_on, bounded, lowest_position_mm, highest_position_mm,
            lowest_speed_mm_s, highest_speed_mm_s,
        }
        plain Answer "holdover_answer_t" { command, estimate, frame_count, frames }
        plain Scale "holdover_scale_t" { north, east }
        plain Segment "holdover_segment_t" { begins, length, latitude, longitude, along, across, heading }
        pointing Path "holdover_path_t" { segments, segment_count }
        pointing Approach "holdover_approach_t" { crossing, exits, conflicts, path, leg, exit }
        pointing Intersection "holdover_intersection_t" { half, approaches, approach_count, id }
        pointing Crossing "holdover_crossing_t" { at, intersection, leg, exit }
        pointing Itinerary "holdover_itinerary_t" { path, crossings, crossing_count }
    }
}

/// What a C compiler holds against its own layout, where it can: from C11 and C++11 on.
pub fn assertions() -> String {
    let mut text = String::from(
        "/* What the library takes the structs for. A compiler for C11 or C++11, or newer ones, refuses another layout. */\n\
         #if defined(__cplusplus) && (__cplusplus >= 201103L)\n\
         #define HOLDOVER_ASSERT(holds, text) static_assert(holds, text)\n\
         #elif defined(__STDC_VERSION__) && (__STDC_VERSION__ >= 201112L)\n\
         #define HOLDOVER_ASSERT(holds, text) _Static_assert(holds, text)\n\
         #endif\n\
         #ifdef HOLDOVER_ASSERT\n\
         HOLDOVER_ASSERT((HOLDOVER_UNIT_SIZE % HOLDOVER_UNIT_ALIGN) == 0U, \"a unit is an array of words\");\n",
    );
    for (capacity, size) in [("HOLDOVER_CAPACITY_16_8_1072", 180_000), ("HOLDOVER_CAPACITY_4_4_200", 20_000)] {
        text += &format!("#{} defined({capacity})\n", if size == 180_000 { "if" } else { "elif" });
        text += &format!("HOLDOVER_ASSERT(HOLDOVER_UNIT_SIZE == {size}, \"holdover_unit_size\");\n");
    }
    text += "#else\nHOLDOVER_ASSERT(HOLDOVER_UNIT_SIZE == 48000, \"holdover_unit_size\");\n#endif\n";
    let (pointing, plain): (Vec<_>, Vec<_>) = layouts().into_iter().partition(|layout| layout.has_pointers);
    plain.iter().for_each(|layout| text += &layout.assertions());
    text += "#if UINTPTR_MAX == 0xFFFFFFFFFFFFFFFFU\n";
    pointing.iter().for_each(|layout| text += &layout.assertions());
    text + "#endif\n#endif\n"
}

impl Layout {
    fn assertions(&self) -> String {
        let Self { name, size, fields, .. } = self;
        let mut text = format!("HOLDOVER_ASSERT(sizeof({name}) == {size}U, \"sizeof {name}\");\n");
        for (field, at) in fields {
            text += &format!("HOLDOVER_ASSERT(offsetof({name}, {field}) == {at}U, \"{name}.{field}\");\n");
        }
        text
    }
}
