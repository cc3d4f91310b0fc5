/*
 * The C interface of holdover. Made from the sources by cbindgen; changes by hand are lost.
 *
 *     static uint64_t unit[HOLDOVER_UNIT_SIZE / sizeof(uint64_t)];
 *
 *     holdover_default_config(&config);                once; then fill in what is different
 *     holdover_init(unit, sizeof unit, &config);       once
 *     holdover_receive(unit, at_us, &frame);           for every CAN frame
 *     holdover_tick(unit, now_us, &answer);            every period; answer.frames are to be sent
 *
 * Every function checks what it is given. The functions of one unit have to take turns; several units do not disturb one
 * another.
 */

#ifndef HOLDOVER_H
#define HOLDOVER_H

#include <stddef.h>
#include <stdint.h>

// The most frames that one tick sends.
#define HOLDOVER_MAX_FRAMES 20

// In front of an identifier of 11 bits: `HOLDOVER_STANDARD | 0x123`.
#define HOLDOVER_STANDARD 1073741824

// In front of an identifier of 29 bits: `HOLDOVER_EXTENDED | 0x0CFF0210`.
#define HOLDOVER_EXTENDED 2147483648

// The version of the header: major in bits 16 and up, minor in bits 8 to 15, patch in bits 0 to 7.
#define HOLDOVER_VERSION 256

// Bytes of memory that a unit needs, on every target.
#define HOLDOVER_UNIT_SIZE 48000

// What the address of that memory has to be a multiple of.
#define HOLDOVER_UNIT_ALIGN 8

// What became of a call. Negative: it was refused, for the cause that the code names. A refused call changes nothing; a
// refused frame changes its cause's count and the end-to-end state of its identifier.
enum holdover_status_t
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // Done; of a frame: a message was taken in.
  HOLDOVER_OK = 0,
  // A good frame of a message whose other frames are still to come.
  HOLDOVER_PENDING = 1,
  // A frame that is not one of the catalogue's, or not for this unit.
  HOLDOVER_FOREIGN = 2,
  // A pointer is null.
  HOLDOVER_NULL = -1,
  // An address is not a multiple of what its type needs.
  HOLDOVER_MISALIGNED = -2,
  // The memory is smaller than `HOLDOVER_UNIT_SIZE`.
  HOLDOVER_TOO_SMALL = -3,
  // There is no unit in the memory.
  HOLDOVER_NOT_INITIALISED = -4,
  // There is a unit in the memory already; `holdover_release` makes it free.
  HOLDOVER_ALREADY_INITIALISED = -5,
  // Something wrote past the end of the unit. It is not used any more; `holdover_init` makes a new one.
  HOLDOVER_OVERRUN = -6,
  // Another call is in this unit: receive and tick have to take turns.
  HOLDOVER_BUSY = -7,
  // A frame has more than 8 bytes.
  HOLDOVER_FRAME_LENGTH = -8,
  // An identifier has more than 11 bits, or more than 29 if it is an extended one.
  HOLDOVER_FRAME_ID = -9,
  // The code is not that of a refusal (`HOLDOVER_REFUSED_...`).
  HOLDOVER_NO_CAUSE = -10,
  // `base_id` is above 0x740.
  HOLDOVER_CONFIG_BASE_ID = -32,
  // A switch is neither 0 nor 1.
  HOLDOVER_CONFIG_SWITCH = -33,
  // `period` is outside 1 to 100 ms.
  HOLDOVER_CONFIG_PERIOD = -34,
  // `step` is outside 1 ms to 1 s.
  HOLDOVER_CONFIG_STEP = -35,
  // `horizon` is shorter than two steps, longer than 25.5 s, or needs more steps than the capacity.
  HOLDOVER_CONFIG_HORIZON = -36,
  // `length` is outside 0 to 40.95 m.
  HOLDOVER_CONFIG_LENGTH = -37,
  // `lag` is outside 0 to 1.998 s.
  HOLDOVER_CONFIG_LAG = -38,
  // A limit is zero, negative or beyond the wire's range, or normal braking is harder than 6 m/s^2 or than emergency
  // braking.
  HOLDOVER_CONFIG_LIMITS = -39,
  // `time_gap` is outside 0.1 to 3.995 s.
  HOLDOVER_CONFIG_TIME_GAP = -40,
  // `standstill` is outside 0 to 10.23 m.
  HOLDOVER_CONFIG_STANDSTILL = -41,
  // A gain is out of range.
  HOLDOVER_CONFIG_GAIN = -42,
  // The semi-implicit step is unstable: `k dt^2 >= 4 + 2 k dt (t_g + gamma)`.
  HOLDOVER_CONFIG_UNSTABLE = -43,
  // A speed is outside 0 to 65.534 m/s.
  HOLDOVER_CONFIG_SPEED = -44,
  // `a_max` of the free road is below 0.1 m/s^2 or above the limit on acceleration.
  HOLDOVER_CONFIG_FREE_ROAD = -45,
  // A time of the link is zero where it must not be, or beyond 10 s for stamps; or the clock may be off by more than what
  // is refused as future.
  HOLDOVER_CONFIG_LINK = -46,
  // The vehicle of eqs 1-3 has no mass or no brakes.
  HOLDOVER_CONFIG_BODY = -47,
  // A limit of the envelope is zero, or it brakes harder than emergency braking.
  HOLDOVER_CONFIG_ENVELOPE = -48,
  // `catch_up` is outside 0 to 0.75, or no multiple of 0.05.
  HOLDOVER_CONFIG_CATCH_UP = -49,
  // `transport` is CAN FD, which this library is built without.
  HOLDOVER_CONFIG_TRANSPORT = -50,
  // An identifier that was placed has more than its 11 or 29 bits, with all its 16 slots, or no kind.
  HOLDOVER_CONFIG_IDENTIFIER_RANGE = -51,
  // Two messages have the same identifier, all 16 slots counted. `holdover-sim dbc --place` names them.
  HOLDOVER_CONFIG_IDENTIFIER_SHARED = -52,
  // A frame of ours that is not exactly 8 data bytes long, or a remote frame.
  HOLDOVER_REFUSED_LENGTH = -64,
  // The E2E checksum does not fit.
  HOLDOVER_REFUSED_CHECKSUM = -65,
  // The E2E counter repeats the last one: the same frame twice.
  HOLDOVER_REFUSED_REPEATED = -66,
  // More E2E counters are missing than the message tolerates.
  HOLDOVER_REFUSED_COUNTER_GAP = -67,
  // The E2E counter is outside 0 to 14.
  HOLDOVER_REFUSED_COUNTER_RANGE = -68,
  // The E2E state machine has not seen enough good frames of this identifier yet.
  HOLDOVER_REFUSED_NOT_YET_TRUSTED = -69,
  // A field holds a value outside its range, or a reserved one.
  HOLDOVER_REFUSED_RANGE = -70,
  // The parts of a message do not belong together, or one of them is missing.
  HOLDOVER_REFUSED_TORN = -71,
  // The stamp is older than the unit uses.
  HOLDOVER_REFUSED_STALE = -72,
  // The stamp lies in the future by more than the clock's error.
  HOLDOVER_REFUSED_FUTURE = -73,
  // A sample with this stamp is held already.
  HOLDOVER_REFUSED_DUPLICATE = -74,
  // A sample that is newer than this one is held already, and this one no longer fits the history.
  HOLDOVER_REFUSED_OUT_OF_ORDER = -75,
  // A slot beyond the unit's capacity.
  HOLDOVER_REFUSED_UNKNOWN_SLOT = -76,
  // Another station claims a slot whose station is still alive.
  HOLDOVER_REFUSED_STATION_CONFLICT = -77,
  // A peer too far away to have anything to do with the unit.
  HOLDOVER_REFUSED_TOO_FAR = -78,
  // A follow-up without its sync message, or out of sequence.
  HOLDOVER_REFUSED_SYNC_SEQUENCE = -79,
  // A position that cannot be reached from the sample before it.
  HOLDOVER_REFUSED_JUMP = -80,
  // A speed that does not fit the positions.
  HOLDOVER_REFUSED_IMPLAUSIBLE = -81,
  // A value that does not change though it has to.
  HOLDOVER_REFUSED_STUCK = -82,
  // A time before one that the unit was given already.
  HOLDOVER_REFUSED_CLOCK_BACKWARDS = -83,
  // Not a refusal, but counted like one: the platform's receive queue was full.
  HOLDOVER_REFUSED_RECEIVE_OVERFLOW = -84,
  // Likewise: the bus controller lost a frame.
  HOLDOVER_REFUSED_OVERRUN = -85,
  // Likewise: frames to be sent were lost before the bus.
  HOLDOVER_REFUSED_TRANSMIT_OVERFLOW = -86,
  // Likewise: the bus controller left the bus.
  HOLDOVER_REFUSED_BUS_OFF = -87,
  // Likewise: the watchdog restarted the unit.
  HOLDOVER_REFUSED_RESTART = -88,
  // A place on the globe that is not on the ego's path.
  HOLDOVER_REFUSED_OFF_ROUTE = -89,
  // Not a refusal of a frame: a station went on not heeding the ego.
  HOLDOVER_REFUSED_OVERLOOKED = -90,
  // A synchronisation that came later than the unit's own clock allows.
  HOLDOVER_REFUSED_SYNC_LATE = -91,
  // A synchronisation that came earlier than the unit's own clock allows.
  HOLDOVER_REFUSED_SYNC_EARLY = -92,
  // Not a refusal of a frame: a peer's clock is off.
  HOLDOVER_REFUSED_PEER_CLOCK = -93,
  // Not a refusal of a frame: what the range sensor sees began to contradict what is heard of the target.
  HOLDOVER_REFUSED_RANGE_DISAGREES = -94,
  // A horizon that its sender cannot drive.
  HOLDOVER_REFUSED_UNREACHABLE = -95,
  // Not a refusal of a frame: the driver's request stopped coming while the unit drove.
  HOLDOVER_REFUSED_REQUEST_LOST = -96,
  // Not a refusal of a frame: an `EgoMotion` of another station than the unit's own.
  HOLDOVER_REFUSED_EGO_STATION = -97,
  // Not a refusal of a frame: the driver took over by a pedal.
  HOLDOVER_REFUSED_DRIVER_OVERRIDE = -98,
  // Not a refusal of a frame: the actuators acknowledge no command in force.
  HOLDOVER_REFUSED_COMMAND_UNHEEDED = -99,
  // Not a refusal of a frame: no room for the passes of one more station.
  HOLDOVER_REFUSED_PASSES_FULL = -100,
  // Not a refusal of a frame: the platform did not tick the unit for a period.
  HOLDOVER_REFUSED_MISSED_PERIOD = -101,
  // Not a refusal of a frame: the platform's crystal did not start.
  HOLDOVER_REFUSED_CLOCK_FAILED = -102,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum holdover_status_t holdover_status_t;
#else
typedef int32_t holdover_status_t;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// What brings the acceleration about.
enum holdover_effort_t
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint8_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // Net engine force in N.
  HOLDOVER_EFFORT_FORCE = 0,
  // Brake torque in N m.
  HOLDOVER_EFFORT_BRAKE_TORQUE = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum holdover_effort_t holdover_effort_t;
#else
typedef uint8_t holdover_effort_t;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// In which mode a command was computed.
enum holdover_mode_t
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint8_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // Not engaged: the command is not to be used.
  HOLDOVER_MODE_STANDBY = 0,
  // Driving by fresh messages, or leading.
  HOLDOVER_MODE_COOPERATIVE = 1,
  // Driving by the estimate, the link being off.
  HOLDOVER_MODE_HOLDOVER = 2,
  // No target to drive by: behind what is seen or still certain of it, else braking that grows slowly.
  HOLDOVER_MODE_FALLBACK = 3,
  // The own motion is unknown, or what is heard and what is seen exclude one another: braking as configured.
  HOLDOVER_MODE_FAULT = 4,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum holdover_mode_t holdover_mode_t;
#else
typedef uint8_t holdover_mode_t;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Why it is in a fallback or a fault.
enum holdover_cause_t
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint8_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // It is in neither.
  HOLDOVER_CAUSE_NONE = 0,
  // Nobody said whom to follow.
  HOLDOVER_CAUSE_NOT_ASSOCIATED = 1,
  // The target was never heard.
  HOLDOVER_CAUSE_NEVER_HEARD = 2,
  // The target has been silent for longer than a holdover lasts.
  HOLDOVER_CAUSE_SILENT = 3,
  // The own motion never came.
  HOLDOVER_CAUSE_EGO_MISSING = 4,
  // The own motion has stopped coming.
  HOLDOVER_CAUSE_EGO_STALE = 5,
  // What the range sensor sees and what is heard of the target exclude one another.
  HOLDOVER_CAUSE_RANGE_DISAGREES = 6,
  // The driver's request has stopped coming: the unit hands back.
  HOLDOVER_CAUSE_REQUEST_LOST = 7,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum holdover_cause_t holdover_cause_t;
#else
typedef uint8_t holdover_cause_t;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// The identifiers of one message of all peers.
typedef struct holdover_peer_identifiers_t {
  // Of slot 0; 0: in the block.
  uint32_t first;
  // How far one slot's is from the next; there are 16.
  uint32_t stride;
} holdover_peer_identifiers_t;

// Messages that lie outside the block, by their names in the DBC. 0, as everything is that an initialiser does not name: in the
// block.
typedef struct holdover_identifiers_t {
  // `TimeSync`.
  uint32_t time_sync;
  // `TimeFollowUp`.
  uint32_t time_follow_up;
  // `MotionCommand`.
  uint32_t motion_command;
  // `ActuatorState`.
  uint32_t actuator_state;
  // `EgoMotionA`.
  uint32_t ego_motion_a;
  // `EgoMotionB`.
  uint32_t ego_motion_b;
  // `DriverRequest`.
  uint32_t driver_request;
  // `EgoPosition`.
  uint32_t ego_position;
  // `RangeSensor`.
  uint32_t range_sensor;
  // `PeersUnserved`.
  uint32_t peers_unserved;
  // `TargetEstimateA`.
  uint32_t target_estimate_a;
  // `TargetEstimateB`.
  uint32_t target_estimate_b;
  // `OwnMotionA`.
  uint32_t own_motion_a;
  // `OwnMotionB`.
  uint32_t own_motion_b;
  // `OwnHorizon`.
  uint32_t own_horizon;
  // `OwnDrivingParameters`.
  uint32_t own_driving_parameters;
  // `OwnPosition`.
  uint32_t own_position;
  // `OwnRoute`.
  uint32_t own_route;
  // `OwnPass`.
  uint32_t own_pass;
  // `PeerPass`.
  uint32_t peer_pass;
  // `Health`.
  uint32_t health;
  // `Peer{slot}MotionA`.
  struct holdover_peer_identifiers_t peer_motion_a;
  // `Peer{slot}MotionB`.
  struct holdover_peer_identifiers_t peer_motion_b;
  // `Peer{slot}Horizon`.
  struct holdover_peer_identifiers_t peer_horizon;
  // `Peer{slot}DrivingParameters`.
  struct holdover_peer_identifiers_t peer_driving_parameters;
  // `Peer{slot}Position`.
  struct holdover_peer_identifiers_t peer_position;
  // `Peer{slot}Route`.
  struct holdover_peer_identifiers_t peer_route;
} holdover_identifiers_t;

// Limits of the controller, and of the vehicle.
typedef struct holdover_limits_t {
  // Largest acceleration in mm/s2.
  uint32_t acceleration_mm_s2;
  // Hardest braking in normal driving in mm/s2.
  uint32_t braking_mm_s2;
  // Fastest change of acceleration in mm/s3.
  uint32_t jerk_mm_s3;
  // Hardest braking in an emergency in mm/s2.
  uint32_t emergency_braking_mm_s2;
} holdover_limits_t;

// The vehicle of eqs 1 to 3.
typedef struct holdover_body_t {
  // Mass in kg.
  uint32_t mass_kg;
  // Brake force per brake torque in 1/(1000 m).
  uint32_t ratio_milli;
  // Aerodynamic drag in mN/(m/s)^2.
  uint32_t drag_milli;
  // Friction in mN/(m/s).
  uint32_t friction_milli;
  // Mechanical drag in N.
  uint32_t mechanical_n;
} holdover_body_t;

// The law of eqs 5 and 7.
typedef struct holdover_law_t {
  // Desired time gap in ms.
  uint32_t time_gap_ms;
  // Distance kept at standstill in mm.
  uint32_t standstill_mm;
  // 1: the gains come from the table of eq. 6; 0: they are the following two.
  uint8_t gain_table;
  // Gain in 1/(1000 s^2).
  uint32_t gain_milli;
  // Damping in ms.
  uint32_t damping_ms;
  // Largest acceleration on a free road in mm/s2.
  uint32_t free_road_acceleration_mm_s2;
  // Speed wanted on a free road until `DriverRequest` says otherwise, in mm/s.
  uint32_t target_speed_mm_s;
  // Share by which the ego may exceed that speed to catch up with the vehicle that it follows, in thousandths: 0 (the speed is
  // a cap) to 750 by 50.
  uint32_t catch_up_milli;
  // Speed never demanded beyond, in mm/s.
  uint32_t max_speed_mm_s;
} holdover_law_t;

// What is in the prediction model; each is 1 (as it should be) or 0 (as in the paper).
typedef struct holdover_model_t {
  // The actuators' lag.
  uint8_t lag;
  // The controller's limits on acceleration and jerk.
  uint8_t limits;
  // The sender's last demand as the start of the jerk limit.
  uint8_t last_demand;
  // The standstill distance.
  uint8_t standstill;
  // Trapezoidal positions; otherwise forward Euler.
  uint8_t trapezoid;
  // Read-out between steps; otherwise the nearest step.
  uint8_t interpolate;
  // Samples are brought from their stamp to now by the model; otherwise by eqs 10 to 12.
  uint8_t stamped;
  // A horizon never runs out; otherwise its last value is held.
  uint8_t endless;
  // A horizon that the peer computed itself is used in preference.
  uint8_t received;
  // After a silence the controller is led from the old estimate to the new one.
  uint8_t smooth;
} holdover_model_t;

// The prediction.
typedef struct holdover_prediction_t {
  // Prediction step in us.
  uint32_t step_us;
  // How far ahead, in us.
  uint32_t horizon_us;
  // What is in the model.
  struct holdover_model_t model;
} holdover_prediction_t;

// What counts as a link.
typedef struct holdover_link_t {
  // Period with which the own messages are sent, and a peer's until its own is measured; in us.
  uint32_t period_us;
  // The link is off when no valid message came for a period and this; in us.
  uint32_t tolerance_us;
  // Older stamps are refused; in us.
  uint32_t stale_us;
  // Stamps further in the future are refused; in us.
  uint32_t future_us;
  // Largest error between a sender's stamp and the own clock while synchronised; in us.
  uint32_t clock_error_us;
  // A slot may be taken over by another station after this much silence; in us.
  uint32_t slot_reuse_us;
  // Silence up to which a target's estimate is driven by; in us.
  uint32_t holdover_us;
  // Age up to which the own motion is usable; in us.
  uint32_t ego_timeout_us;
  // Age up to which the request of the driver holds, in us.
  uint32_t request_timeout_us;
  // Age up to which a time synchronisation holds; in us.
  uint32_t sync_timeout_us;
  // Delay assumed while there is no synchronisation; in us.
  uint32_t assumed_delay_us;
} holdover_link_t;

// The limits of the last gate.
typedef struct holdover_envelope_t {
  // 1: the gate is there; 0: it is not, and the rest is ignored.
  uint8_t engaged;
  // Largest acceleration ever commanded in mm/s2.
  uint32_t acceleration_mm_s2;
  // Hardest braking ever commanded in mm/s2.
  uint32_t braking_mm_s2;
  // Fastest change ever commanded in mm/s3, that of emergency braking.
  uint32_t jerk_mm_s3;
  // No acceleration at or beyond this speed in mm/s.
  uint32_t speed_mm_s;
  // What is left between the bumpers when both have come to rest, in mm.
  uint32_t margin_mm;
  // How long a command may stay in force beyond its period: the next one's way to the actuators, and ticks missed in a row; in us.
  uint32_t delay_us;
  // Share of the lag by which the real one may be longer or shorter, in thousandths.
  uint32_t lag_tolerance_milli;
} holdover_envelope_t;

// Everything that the unit has to be told. Times that are compared with the clock are in us, as the clock is; all else is
// in thousandths of its unit. `docs/INTEGRATION.md` has ranges and defaults.
typedef struct holdover_config_t {
  // The own station's 8-bit hash.
  uint8_t station;
  // Whether a range sensor is fitted: 0 or 1. With one, the gate trusts other vehicles' passes.
  uint8_t range_sensor;
  // First CAN identifier of the block in which all messages lie.
  uint16_t base_id;
  // The whole identity of the own station, of which `station` is the low 8 bits. At intersections no two vehicles have the same.
  uint32_t station_id;
  // Messages that lie elsewhere.
  struct holdover_identifiers_t identifiers;
  // Period of the task that calls `holdover_tick`, in us.
  uint32_t period_us;
  // Bumper to bumper, in mm.
  uint32_t length_mm;
  // Time constant of the actuators, in ms.
  uint32_t lag_ms;
  // Limits of the controller, and of the vehicle.
  struct holdover_limits_t limits;
  // The vehicle of eqs 1 to 3.
  struct holdover_body_t body;
  // 1: what the body does not say, such as a grade, is measured and made up for; 0: it is not.
  uint8_t correction;
  // 1: passes are kept at intersections while the envelope is engaged; 0: they are not, for studies and where the modem does not relay
  // them.
  uint8_t passes;
  // The law.
  struct holdover_law_t law;
  // The prediction.
  struct holdover_prediction_t prediction;
  // The link.
  struct holdover_link_t link;
  // The last gate.
  struct holdover_envelope_t envelope;
} holdover_config_t;

// A classic CAN frame. The library sends frames with 8 bytes only.
typedef struct holdover_frame_t {
  // The identifier; up to 0x7FF, or 0x1FFFFFFF if it is an extended one.
  uint32_t id;
  // Not 0: the identifier has 29 bits.
  uint8_t extended;
  // Not 0: a remote frame.
  uint8_t remote;
  // Bytes of data; up to 8.
  uint8_t length;
  // The data; what lies behind its length is ignored.
  uint8_t data[8];
} holdover_frame_t;

// The command to the actuators.
typedef struct holdover_command_t {
  // Demanded acceleration in mm/s2, rounded to nearest; negative: braking.
  int32_t acceleration_mm_s2;
  // What brings it about by the configured vehicle model.
  holdover_effort_t effort;
  // In which mode it was computed.
  holdover_mode_t mode;
  // Why it is in a fallback or a fault.
  holdover_cause_t cause;
  // 1: the envelope changed it; else 0.
  uint8_t limited;
  // How much of the effort, in N or N m; up to 65,534.
  uint16_t effort_value;
  // Counts ticks; modulo 64.
  uint8_t tick;
  // 1: the brakes are to hold the vehicle, which stands; else 0.
  uint8_t hold;
  // Time since the first tick in ms; modulo 1024.
  uint16_t time_ms;
} holdover_command_t;

// Where the target is now, as the unit believes.
typedef struct holdover_estimate_t {
  // Front bumper of the target along the lane in mm, rounded to nearest.
  int64_t position_mm;
  // Age of the newest sample that it rests on in us; negative: its stamp lies ahead of the clock.
  int64_t age_us;
  // Its speed in mm/s, rounded to nearest.
  int32_t speed_mm_s;
  // 1: there is an estimate; 0: there is none, and all the rest is 0.
  uint8_t valid;
  // 1: the link to the target is on; else 0.
  uint8_t link_on;
  // 1: the four ends below are certain; 0: there is no bound, and they are 0.
  uint8_t bounded;
  // It is not behind this, in mm, rounded down.
  int64_t lowest_position_mm;
  // It is not ahead of this, in mm, rounded up.
  int64_t highest_position_mm;
  // It is not slower, in mm/s, rounded down.
  int32_t lowest_speed_mm_s;
  // It is not faster, in mm/s, rounded up.
  int32_t highest_speed_mm_s;
} holdover_estimate_t;

// The answer of one tick.
typedef struct holdover_answer_t {
  // The command to the actuators.
  struct holdover_command_t command;
  // The estimate of the target.
  struct holdover_estimate_t estimate;
  // How many frames there are to send.
  uint32_t frame_count;
  // The frames, in the order in which they are to be sent; the rest is 0.
  struct holdover_frame_t frames[HOLDOVER_MAX_FRAMES];
} holdover_answer_t;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// The version of the library; to be compared with `HOLDOVER_VERSION` once at start, since structs of another version may
// be laid out differently.
uint32_t holdover_version(void);

// The name of a code, as a string in ASCII that is there for good; `"unknown"` if there is no such code.
const char *holdover_status_name(int32_t status);

// Fills in the configuration of a car: 1,500 kg, 4.8 m, 100 Hz, time gap 1 s, station 0, no envelope.
//
// # Safety
// `config` has to point to memory for a configuration that nobody else uses during the call.
holdover_status_t holdover_default_config(struct holdover_config_t *config);

// Makes a unit in `memory`, of which there are `size` bytes: at least `HOLDOVER_UNIT_SIZE`, at an address that is a multiple
// of `HOLDOVER_UNIT_ALIGN`. The configuration is copied. What is refused leaves the memory as it was.
//
// The memory should be zero; if it may still hold the unit of a program that ran before (a section that a reset does not
// clear), call `holdover_after_reset` before.
//
// # Safety
// `memory` has to be the caller's for as long as the unit is used, and nobody else may write to it. `config` has to
// point to a configuration.
holdover_status_t holdover_init(void *memory, size_t size, const struct holdover_config_t *config);

// Ends the use of a unit; its memory may be used for anything then, also for another unit.
//
// # Safety
// As `holdover_tick`.
holdover_status_t holdover_release(void *unit);

// Takes out of memory that a reset does not clear what the program before the reset has left there, also a unit that it was in the
// middle of a call into, which every other function would refuse as busy for ever. To be called once after a reset, before
// `holdover_init` and before anything calls into the unit. There need not be a unit.
//
// # Safety
// `memory` has to be memory as in `holdover_init`, and no call into a unit there may be under way.
holdover_status_t holdover_after_reset(void *memory);

// Takes in one frame, received at `at_us` microseconds of a clock that never goes back. Frames may come in any order and at
// any time. Positive or zero: what became of it; else the cause for which it was refused.
//
// # Safety
// `frame` has to point to a frame; `unit` as in `holdover_tick`.
holdover_status_t holdover_receive(void *unit, uint64_t at_us, const struct holdover_frame_t *frame);

// The task of one period, at `now_us` microseconds of the same clock; the frames of the answer are then to be sent. If the
// call is refused, the answer is mode standby (the command is not to be used) without frames.
//
// # Safety
// `unit` has to be memory in which `holdover_init` was called, or that is at least as large; `answer` has to point to
// memory for an answer, outside of the unit, that nobody else uses during the call.
holdover_status_t holdover_tick(void *unit, uint64_t now_us, struct holdover_answer_t *answer);

// How often frames were refused for a cause since the unit was made; `cause` is one of `HOLDOVER_REFUSED_...`. 0 if
// the call is refused.
//
// # Safety
// `count` has to point to memory for a number that nobody else uses during the call; `unit` as in `holdover_tick`.
holdover_status_t holdover_count(void *unit, int32_t cause, uint32_t *count);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* HOLDOVER_H */
