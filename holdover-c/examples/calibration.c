/*
 * The configuration in a section of its own, which the linker script puts where a calibration tool can change it without
 * touching the program. It is that of holdover_default_config but for the station and the holdover.
 */
#include "calibration.h"

__attribute__((section(".calibration"))) const volatile holdover_config_t calibration = {
    .station = 2,
    .station_id = 2,
    .base_id = 0x480,
    .period_us = 10000,
    .length_mm = 4800,
    .lag_ms = 300,
    .limits = {
        .acceleration_mm_s2 = 2500,
        .braking_mm_s2 = 4000,
        .jerk_mm_s3 = 5000,
        .emergency_braking_mm_s2 = 8000,
    },
    .body = {
        .mass_kg = 1500,
        .ratio_milli = 3226,
        .drag_milli = 400,
        .friction_milli = 2000,
        .mechanical_n = 150,
    },
    .correction = 1,
    .passes = 1,
    .law = {
        .time_gap_ms = 1600,
        .standstill_mm = 2000,
        .gain_table = 1,
        .gain_milli = 500,
        .damping_ms = 2000,
        .free_road_acceleration_mm_s2 = 730,
        .target_speed_mm_s = 13400,
        .catch_up_milli = 0,
        .max_speed_mm_s = 50000,
    },
    .prediction = {
        .step_us = 30000,
        .horizon_us = 10710000,
        .model = {
            .lag = 1,
            .limits = 1,
            .last_demand = 1,
            .standstill = 1,
            .trapezoid = 1,
            .interpolate = 1,
            .stamped = 1,
            .endless = 1,
            .received = 1,
            .smooth = 1,
        },
    },
    .link = {
        .period_us = 100000,
        .tolerance_us = 150000,
        .stale_us = 10000000,
        .future_us = 5000,
        .clock_error_us = 500,
        .slot_reuse_us = 2000000,
        .holdover_us = 1000000,
        .ego_timeout_us = 50000,
        .request_timeout_us = 300000,
        .sync_timeout_us = 5000000,
        .assumed_delay_us = 40000,
    },
    .envelope = {
        .engaged = 1,
        .acceleration_mm_s2 = 3000,
        .braking_mm_s2 = 8000,
        .jerk_mm_s3 = 25000,
        .speed_mm_s = 50000,
        .margin_mm = 500,
        .delay_us = 30000,
        .lag_tolerance_milli = 250,
    },
};
