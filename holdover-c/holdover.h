/*
 * The C interface of holdover. Made from the sources by cbindgen; changes by hand are lost.
 *
 *     static uint64_t unit[HOLDOVER_UNIT_SIZE / sizeof(uint64_t)];
 *
 *     holdover_default_config(&config);                once; then fill in what is different
 *     holdover_init(unit, sizeof unit, &config);       once
 *     holdover_receive(unit, at_us, &frame);           for every CAN frame
 *     holdover_tick(unit, now_us, &answer);            every period; answer.frames are to be sent
 *     holdover_note(unit, incident, times);            what the platform around the unit met with
 *     holdover_set_out(unit, &way, map, sizeof map);   on a way through intersections
 *
 * Every function checks what it is given. The functions of one unit have to take turns; several units do not disturb one
 * another.
 */

#ifndef HOLDOVER_H
#define HOLDOVER_H

#include <stddef.h>
#include <stdint.h>

/* Define the one that the library was built with, if any; the names are those of its features. */
/* #define HOLDOVER_CAPACITY_16_8_1072 */
/* #define HOLDOVER_CAPACITY_4_4_200 */

/* A constant in mm as a place or a length of a map, in units of 2^-20 m, rounded to nearest. */
#define HOLDOVER_MM(mm) ((((int64_t)(mm) * 1048576) + (((mm) < 0) ? -500 : 500)) / 1000)

/*
 * Bytes of memory that holdover_set_out needs for the copy of a way with so many segments, paths, approaches, intersections and
 * crossings. What is pointed to from several places counts as often.
 */
#define HOLDOVER_MAP_SIZE(segments, paths, approaches, intersections, crossings) \
    ((40U * (segments)) + (16U * (paths)) + (40U * (approaches)) + (24U * (intersections)) + (24U * (crossings)) + 32U)

// The most frames that one tick sends.
#define HOLDOVER_MAX_FRAMES 20U

// In front of an identifier of 11 bits: `HOLDOVER_STANDARD | 0x123`.
#define HOLDOVER_STANDARD 1073741824U

// In front of an identifier of 29 bits: `HOLDOVER_EXTENDED | 0x0CFF0210`.
#define HOLDOVER_EXTENDED 2147483648U

// The version of the header: major in bits 16 and up, minor in bits 8 to 15, patch in bits 0 to 7.
#define HOLDOVER_VERSION 512U

#if !(defined(HOLDOVER_CAPACITY_16_8_1072) || defined(HOLDOVER_CAPACITY_4_4_200))
// Vehicles that a unit of this library keeps track of.
#define HOLDOVER_PEERS 8U
#endif

#if defined(HOLDOVER_CAPACITY_16_8_1072)
// Vehicles that a unit of this library keeps track of.
#define HOLDOVER_PEERS 16U
#endif

#if defined(HOLDOVER_CAPACITY_4_4_200)
// Vehicles that a unit of this library keeps track of.
#define HOLDOVER_PEERS 4U
#endif

#if !(defined(HOLDOVER_CAPACITY_16_8_1072) || defined(HOLDOVER_CAPACITY_4_4_200))
// Samples of the past that it keeps of each.
#define HOLDOVER_HISTORY 8U
#endif

#if defined(HOLDOVER_CAPACITY_16_8_1072)
// Samples of the past that it keeps of each.
#define HOLDOVER_HISTORY 8U
#endif

#if defined(HOLDOVER_CAPACITY_4_4_200)
// Samples of the past that it keeps of each.
#define HOLDOVER_HISTORY 4U
#endif

#if !(defined(HOLDOVER_CAPACITY_16_8_1072) || defined(HOLDOVER_CAPACITY_4_4_200))
// Steps of a horizon.
#define HOLDOVER_STEPS 400U
#endif

#if defined(HOLDOVER_CAPACITY_16_8_1072)
// Steps of a horizon.
#define HOLDOVER_STEPS 1072U
#endif

#if defined(HOLDOVER_CAPACITY_4_4_200)
// Steps of a horizon.
#define HOLDOVER_STEPS 200U
#endif

#if !(defined(HOLDOVER_CAPACITY_16_8_1072) || defined(HOLDOVER_CAPACITY_4_4_200))
// Bytes of memory that a unit needs, on every target.
#define HOLDOVER_UNIT_SIZE 48000U
#endif

#if defined(HOLDOVER_CAPACITY_16_8_1072)
// Bytes of memory that a unit needs, on every target.
#define HOLDOVER_UNIT_SIZE 180000U
#endif

#if defined(HOLDOVER_CAPACITY_4_4_200)
// Bytes of memory that a unit needs, on every target.
#define HOLDOVER_UNIT_SIZE 20000U
#endif

// What the address of that memory has to be a multiple of.
#define HOLDOVER_UNIT_ALIGN 8U

// What became of a call. Negative: it was refused, for the cause that the code names. A refused call changes nothing; a
// refused frame changes its cause's count and the end-to-end state of its identifier.
typedef int32_t holdover_status_t;
// Done; of a frame: a message was taken in.
#define HOLDOVER_OK ((holdover_status_t)0)
// A good frame of a message whose other frames are still to come.
#define HOLDOVER_PENDING ((holdover_status_t)1)
// A frame that is not one of the catalogue's, or not for this unit.
#define HOLDOVER_FOREIGN ((holdover_status_t)2)
// A pointer is null.
#define HOLDOVER_NULL ((holdover_status_t)-1)
// An address is not a multiple of what its type needs.
#define HOLDOVER_MISALIGNED ((holdover_status_t)-2)
// The memory is smaller than `HOLDOVER_UNIT_SIZE`.
#define HOLDOVER_TOO_SMALL ((holdover_status_t)-3)
// There is no unit in the memory.
#define HOLDOVER_NOT_INITIALISED ((holdover_status_t)-4)
// There is a unit in the memory already; `holdover_release` makes it free.
#define HOLDOVER_ALREADY_INITIALISED ((holdover_status_t)-5)
// Something wrote past the end of the unit. It is not used any more; `holdover_init` makes a new one.
#define HOLDOVER_OVERRUN ((holdover_status_t)-6)
// Another call is in this unit: receive and tick have to take turns.
#define HOLDOVER_BUSY ((holdover_status_t)-7)
// A frame has more than 8 bytes.
#define HOLDOVER_FRAME_LENGTH ((holdover_status_t)-8)
// An identifier has more than 11 bits, or more than 29 if it is an extended one.
#define HOLDOVER_FRAME_ID ((holdover_status_t)-9)
// The code is not that of a refusal (`HOLDOVER_REFUSED_...`).
#define HOLDOVER_NO_CAUSE ((holdover_status_t)-10)
// The number is not that of an incident (`HOLDOVER_INCIDENT_...`).
#define HOLDOVER_NO_INCIDENT ((holdover_status_t)-11)
// The memory for a map is smaller than `HOLDOVER_MAP_SIZE` says.
#define HOLDOVER_MAP_TOO_SMALL ((holdover_status_t)-12)
// The unit's present map lies in this memory; a new way needs other memory.
#define HOLDOVER_MAP_IN_USE ((holdover_status_t)-13)
// A way has no crossing, or more than 65,535.
#define HOLDOVER_MAP_CROSSINGS ((holdover_status_t)-16)
// An intersection is met twice, or the crossings are not in the order in which they are met.
#define HOLDOVER_MAP_ORDER ((holdover_status_t)-17)
// A leg or an exit is numbered 8 or more.
#define HOLDOVER_MAP_LEG ((holdover_status_t)-18)
// Half a conflict area is negative, or longer than 5.115 m.
#define HOLDOVER_MAP_AREA ((holdover_status_t)-19)
// A path has no segment.
#define HOLDOVER_MAP_PATH ((holdover_status_t)-20)
// Between two conflict areas there is no room for the ego, which waits before each of them.
#define HOLDOVER_MAP_CLOSE ((holdover_status_t)-21)
// Of two movements only one conflicts with the other, two of one leg conflict, or two to one exit do not.
#define HOLDOVER_MAP_CONFLICTS ((holdover_status_t)-22)
// `base_id` is above 0x740.
#define HOLDOVER_CONFIG_BASE_ID ((holdover_status_t)-32)
// A switch is neither 0 nor 1.
#define HOLDOVER_CONFIG_SWITCH ((holdover_status_t)-33)
// `period` is outside 1 to 100 ms.
#define HOLDOVER_CONFIG_PERIOD ((holdover_status_t)-34)
// `step` is outside 1 ms to 1 s.
#define HOLDOVER_CONFIG_STEP ((holdover_status_t)-35)
// `horizon` is shorter than two steps, longer than 25.5 s, or needs more steps than the capacity.
#define HOLDOVER_CONFIG_HORIZON ((holdover_status_t)-36)
// `length` is outside 0 to 40.95 m.
#define HOLDOVER_CONFIG_LENGTH ((holdover_status_t)-37)
// `lag` is outside 0 to 1.998 s.
#define HOLDOVER_CONFIG_LAG ((holdover_status_t)-38)
// A limit is zero, negative or beyond the wire's range, or normal braking is harder than 6 m/s^2 or than emergency
// braking.
#define HOLDOVER_CONFIG_LIMITS ((holdover_status_t)-39)
// `time_gap` or `silent_time_gap` is outside 0.1 to 3.995 s.
#define HOLDOVER_CONFIG_TIME_GAP ((holdover_status_t)-40)
// `standstill` is outside 0 to 10.23 m.
#define HOLDOVER_CONFIG_STANDSTILL ((holdover_status_t)-41)
// A gain is out of range.
#define HOLDOVER_CONFIG_GAIN ((holdover_status_t)-42)
// The semi-implicit step is unstable: `k dt^2 >= 4 + 2 k dt (t_g + gamma)`.
#define HOLDOVER_CONFIG_UNSTABLE ((holdover_status_t)-43)
// A speed is outside 0 to 65.534 m/s.
#define HOLDOVER_CONFIG_SPEED ((holdover_status_t)-44)
// `a_max` of the free road is below 0.1 m/s^2 or above the limit on acceleration.
#define HOLDOVER_CONFIG_FREE_ROAD ((holdover_status_t)-45)
// A time of the link is zero where it must not be, or beyond 10 s for stamps; or the clock may be off by more than what
// is refused as future.
#define HOLDOVER_CONFIG_LINK ((holdover_status_t)-46)
// The vehicle of eqs 1-3 has no mass or no brakes.
#define HOLDOVER_CONFIG_BODY ((holdover_status_t)-47)
// A limit of the envelope is zero, or it brakes harder than emergency braking.
#define HOLDOVER_CONFIG_ENVELOPE ((holdover_status_t)-48)
// `catch_up` is outside 0 to 0.75, or no multiple of 0.05.
#define HOLDOVER_CONFIG_CATCH_UP ((holdover_status_t)-49)
// `transport` is CAN FD, which this library is built without.
#define HOLDOVER_CONFIG_TRANSPORT ((holdover_status_t)-50)
// An identifier that was placed has more than its 11 or 29 bits, with all its 16 slots, or no kind.
#define HOLDOVER_CONFIG_IDENTIFIER_RANGE ((holdover_status_t)-51)
// Two messages have the same identifier, all 16 slots counted. `holdover-sim dbc --place` names them.
#define HOLDOVER_CONFIG_IDENTIFIER_SHARED ((holdover_status_t)-52)
// `feed_forward_milli` is neither 0 nor 500, or is 500 with a step or a period below 7.813 ms.
#define HOLDOVER_CONFIG_FEED_FORWARD ((holdover_status_t)-53)
// A frame of ours that is not exactly 8 data bytes long, or a remote frame.
#define HOLDOVER_REFUSED_LENGTH ((holdover_status_t)-64)
// The E2E checksum does not fit.
#define HOLDOVER_REFUSED_CHECKSUM ((holdover_status_t)-65)
// The E2E counter repeats the last one: the same frame twice.
#define HOLDOVER_REFUSED_REPEATED ((holdover_status_t)-66)
// More E2E counters are missing than the message tolerates.
#define HOLDOVER_REFUSED_COUNTER_GAP ((holdover_status_t)-67)
// The E2E counter is outside 0 to 14.
#define HOLDOVER_REFUSED_COUNTER_RANGE ((holdover_status_t)-68)
// The E2E state machine has not seen enough good frames of this identifier yet.
#define HOLDOVER_REFUSED_NOT_YET_TRUSTED ((holdover_status_t)-69)
// A field holds a value outside its range, or a reserved one.
#define HOLDOVER_REFUSED_RANGE ((holdover_status_t)-70)
// The parts of a message do not belong together, or one of them is missing.
#define HOLDOVER_REFUSED_TORN ((holdover_status_t)-71)
// The stamp is older than the unit uses.
#define HOLDOVER_REFUSED_STALE ((holdover_status_t)-72)
// The stamp lies in the future by more than the clock's error.
#define HOLDOVER_REFUSED_FUTURE ((holdover_status_t)-73)
// A sample with this stamp is held already.
#define HOLDOVER_REFUSED_DUPLICATE ((holdover_status_t)-74)
// A sample that is newer than this one is held already, and this one no longer fits the history.
#define HOLDOVER_REFUSED_OUT_OF_ORDER ((holdover_status_t)-75)
// A slot beyond the unit's capacity.
#define HOLDOVER_REFUSED_UNKNOWN_SLOT ((holdover_status_t)-76)
// Another station claims a slot whose station is still alive.
#define HOLDOVER_REFUSED_STATION_CONFLICT ((holdover_status_t)-77)
// A peer too far away to have anything to do with the unit.
#define HOLDOVER_REFUSED_TOO_FAR ((holdover_status_t)-78)
// A follow-up without its sync message, or out of sequence.
#define HOLDOVER_REFUSED_SYNC_SEQUENCE ((holdover_status_t)-79)
// A position that cannot be reached from the sample before it.
#define HOLDOVER_REFUSED_JUMP ((holdover_status_t)-80)
// A speed that does not fit the positions.
#define HOLDOVER_REFUSED_IMPLAUSIBLE ((holdover_status_t)-81)
// A value that does not change though it has to.
#define HOLDOVER_REFUSED_STUCK ((holdover_status_t)-82)
// A time before one that the unit was given already.
#define HOLDOVER_REFUSED_CLOCK_BACKWARDS ((holdover_status_t)-83)
// Not a refusal, but counted like one: the platform's receive queue was full.
#define HOLDOVER_REFUSED_RECEIVE_OVERFLOW ((holdover_status_t)-84)
// Likewise: the bus controller lost a frame.
#define HOLDOVER_REFUSED_OVERRUN ((holdover_status_t)-85)
// Likewise: frames to be sent were lost before the bus.
#define HOLDOVER_REFUSED_TRANSMIT_OVERFLOW ((holdover_status_t)-86)
// Likewise: the bus controller left the bus.
#define HOLDOVER_REFUSED_BUS_OFF ((holdover_status_t)-87)
// Likewise: the watchdog restarted the unit.
#define HOLDOVER_REFUSED_RESTART ((holdover_status_t)-88)
// A place on the globe that is not on the ego's path.
#define HOLDOVER_REFUSED_OFF_ROUTE ((holdover_status_t)-89)
// Not a refusal of a frame: a station went on not heeding the ego.
#define HOLDOVER_REFUSED_OVERLOOKED ((holdover_status_t)-90)
// A synchronisation that came later than the unit's own clock allows.
#define HOLDOVER_REFUSED_SYNC_LATE ((holdover_status_t)-91)
// A synchronisation that came earlier than the unit's own clock allows.
#define HOLDOVER_REFUSED_SYNC_EARLY ((holdover_status_t)-92)
// Not a refusal of a frame: a peer's clock is off.
#define HOLDOVER_REFUSED_PEER_CLOCK ((holdover_status_t)-93)
// Not a refusal of a frame: what the range sensor sees began to contradict what is heard of the target.
#define HOLDOVER_REFUSED_RANGE_DISAGREES ((holdover_status_t)-94)
// A horizon that its sender cannot drive.
#define HOLDOVER_REFUSED_UNREACHABLE ((holdover_status_t)-95)
// Not a refusal of a frame: the driver's request stopped coming while the unit drove.
#define HOLDOVER_REFUSED_REQUEST_LOST ((holdover_status_t)-96)
// Not a refusal of a frame: an `EgoMotion` of another station than the unit's own.
#define HOLDOVER_REFUSED_EGO_STATION ((holdover_status_t)-97)
// Not a refusal of a frame: the driver took over by a pedal.
#define HOLDOVER_REFUSED_DRIVER_OVERRIDE ((holdover_status_t)-98)
// Not a refusal of a frame: the actuators acknowledge no command in force.
#define HOLDOVER_REFUSED_COMMAND_UNHEEDED ((holdover_status_t)-99)
// Not a refusal of a frame: no room for the passes of one more station.
#define HOLDOVER_REFUSED_PASSES_FULL ((holdover_status_t)-100)
// Not a refusal of a frame: the platform did not tick the unit for a period.
#define HOLDOVER_REFUSED_MISSED_PERIOD ((holdover_status_t)-101)
// Not a refusal of a frame: the platform's crystal did not start.
#define HOLDOVER_REFUSED_CLOCK_FAILED ((holdover_status_t)-102)

// What brings the acceleration about.
typedef uint8_t holdover_effort_t;
// Net engine force in N.
#define HOLDOVER_EFFORT_FORCE ((holdover_effort_t)0U)
// Brake torque in N m.
#define HOLDOVER_EFFORT_BRAKE_TORQUE ((holdover_effort_t)1U)

// In which mode a command was computed.
typedef uint8_t holdover_mode_t;
// Not engaged: the command is not to be used.
#define HOLDOVER_MODE_STANDBY ((holdover_mode_t)0U)
// Driving by fresh messages, or leading.
#define HOLDOVER_MODE_COOPERATIVE ((holdover_mode_t)1U)
// Driving by the estimate, the link being off.
#define HOLDOVER_MODE_HOLDOVER ((holdover_mode_t)2U)
// No target to drive by: behind what is seen or still certain of it, else braking that grows slowly.
#define HOLDOVER_MODE_FALLBACK ((holdover_mode_t)3U)
// The own motion is unknown, or what is heard and what is seen exclude one another: braking as configured.
#define HOLDOVER_MODE_FAULT ((holdover_mode_t)4U)

// Why it is in a fallback or a fault.
typedef uint8_t holdover_cause_t;
// It is in neither.
#define HOLDOVER_CAUSE_NONE ((holdover_cause_t)0U)
// Nobody said whom to follow.
#define HOLDOVER_CAUSE_NOT_ASSOCIATED ((holdover_cause_t)1U)
// The target was never heard.
#define HOLDOVER_CAUSE_NEVER_HEARD ((holdover_cause_t)2U)
// The target has been silent for longer than a holdover lasts.
#define HOLDOVER_CAUSE_SILENT ((holdover_cause_t)3U)
// The own motion never came.
#define HOLDOVER_CAUSE_EGO_MISSING ((holdover_cause_t)4U)
// The own motion has stopped coming.
#define HOLDOVER_CAUSE_EGO_STALE ((holdover_cause_t)5U)
// What the range sensor sees and what is heard of the target exclude one another.
#define HOLDOVER_CAUSE_RANGE_DISAGREES ((holdover_cause_t)6U)
// The driver's request has stopped coming: the unit hands back.
#define HOLDOVER_CAUSE_REQUEST_LOST ((holdover_cause_t)7U)

// What the platform around the unit has met with.
typedef int32_t holdover_incident_t;
// The receive queue was full.
#define HOLDOVER_INCIDENT_RECEIVE_OVERFLOW ((holdover_incident_t)0)
// The bus controller lost a frame.
#define HOLDOVER_INCIDENT_OVERRUN ((holdover_incident_t)1)
// A frame was lost before the bus: the transmit queue was full, or it waited until it was too old or a newer one was there.
#define HOLDOVER_INCIDENT_TRANSMIT_OVERFLOW ((holdover_incident_t)2)
// The bus controller left the bus, or could not be put onto it.
#define HOLDOVER_INCIDENT_BUS_OFF ((holdover_incident_t)3)
// The watchdog restarted the unit.
#define HOLDOVER_INCIDENT_RESTART ((holdover_incident_t)4)
// A period has passed without a tick; one for each, so that the count has the length of a gap.
#define HOLDOVER_INCIDENT_MISSED_PERIOD ((holdover_incident_t)5)
// The crystal did not start, and a less accurate clock is in its place.
#define HOLDOVER_INCIDENT_CLOCK_FAILED ((holdover_incident_t)6)

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
  // Desired time gap in ms; 1600 by default. With a range sensor 800 will do in a car (`range_sensor`, and
  // `feed_forward_milli` of 500), 1000 in a van, and 1400 in a bus, with a `feed_forward_milli` of 0.
  uint32_t time_gap_ms;
  // Time gap in ms to which that opens, by 100 ms a second, while the vehicle ahead is neither heard nor seen; 1800 by default. If it
  // is no larger than the gap in force, the gap does not open.
  uint32_t silent_time_gap_ms;
  // Distance kept at standstill in mm.
  uint32_t standstill_mm;
  // 1: the gains come from the tables of eq. 6; 0: they are the following two.
  uint8_t gain_table;
  // Gain in 1/(1000 s^2).
  uint32_t gain_milli;
  // Damping in ms.
  uint32_t damping_ms;
  // Share of the predecessor's acceleration that is passed on, in thousandths: 0 or 500. The latter needs a step and a period of at
  // least 7.813 ms.
  uint32_t feed_forward_milli;
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

// What a step of 1e-7 degrees is worth in some direction, in units of 2^-36 m.
typedef struct holdover_scale_t {
  // A step to the north.
  int32_t north;
  // A step to the east.
  int32_t east;
} holdover_scale_t;

// A straight piece of a path.
typedef struct holdover_segment_t {
  // The way along the path up to its beginning, in units of 2^-20 m.
  int64_t begins;
  // Its length in units of 2^-20 m; up to 500 m.
  int64_t length;
  // Latitude of its beginning, degrees north in steps of 1e-7.
  int32_t latitude;
  // Longitude of its beginning, degrees east in steps of 1e-7.
  int32_t longitude;
  // What a step is worth along it.
  struct holdover_scale_t along;
  // What a step is worth across it, positive to the right.
  struct holdover_scale_t across;
  // Its direction, degrees clockwise from north in steps of 0.0125; 0 to 28,799.
  uint16_t heading;
} holdover_segment_t;

// A path: segments, each beginning where the one before it ends.
typedef struct holdover_path_t {
  // The segments in the direction of travel.
  const struct holdover_segment_t *segments;
  // How many there are.
  size_t segment_count;
} holdover_path_t;

// A way through an intersection.
typedef struct holdover_approach_t {
  // Where the crossing point lies on the path, in units of 2^-20 m. For all ways of a leg it is the same distance beyond a place that
  // all of them pass.
  int64_t crossing;
  // The distance from there to a place that all ways of the exit have in common, in units of 2^-20 m; 0 where ways do not join.
  int64_t exits;
  // The ways that it conflicts with: bit `8 leg + exit`. Those of its own leg are not among them.
  uint64_t conflicts;
  // The path of the vehicles that go this way.
  const struct holdover_path_t *path;
  // The number of its leg in messages; 0 to 7.
  uint8_t leg;
  // The number of its exit; 0 to 7. The exit straight on has the number of the leg.
  uint8_t exit;
} holdover_approach_t;

// An intersection.
typedef struct holdover_intersection_t {
  // The conflict area on every way is this far before and behind the crossing point, in units of 2^-20 m; up to 5.115 m.
  int64_t half;
  // The ways through it.
  const struct holdover_approach_t *approaches;
  // How many there are.
  size_t approach_count;
  // Its number in messages.
  uint8_t id;
} holdover_intersection_t;

// An intersection on the ego's way.
typedef struct holdover_crossing_t {
  // Where the crossing point lies on the ego's path, in units of 2^-20 m.
  int64_t at;
  // The intersection.
  const struct holdover_intersection_t *intersection;
  // The leg by which the ego comes.
  uint8_t leg;
  // The exit by which it leaves.
  uint8_t exit;
} holdover_crossing_t;

// The ego's way.
typedef struct holdover_itinerary_t {
  // Its path.
  const struct holdover_path_t *path;
  // The intersections on it, in the order in which they are met: at least one, and no intersection twice.
  const struct holdover_crossing_t *crossings;
  // How many there are.
  size_t crossing_count;
} holdover_itinerary_t;

/* What the library takes the structs for. A compiler for C11 or C++11, or newer ones, refuses another layout. */
#if defined(__cplusplus) && (__cplusplus >= 201103L)
#define HOLDOVER_ASSERT(holds, text) static_assert(holds, text)
#elif defined(__STDC_VERSION__) && (__STDC_VERSION__ >= 201112L)
#define HOLDOVER_ASSERT(holds, text) _Static_assert(holds, text)
#endif
#ifdef HOLDOVER_ASSERT
HOLDOVER_ASSERT((HOLDOVER_UNIT_SIZE % HOLDOVER_UNIT_ALIGN) == 0U, "a unit is an array of words");
#if defined(HOLDOVER_CAPACITY_16_8_1072)
HOLDOVER_ASSERT(HOLDOVER_UNIT_SIZE == 180000, "holdover_unit_size");
#elif defined(HOLDOVER_CAPACITY_4_4_200)
HOLDOVER_ASSERT(HOLDOVER_UNIT_SIZE == 20000, "holdover_unit_size");
#else
HOLDOVER_ASSERT(HOLDOVER_UNIT_SIZE == 48000, "holdover_unit_size");
#endif
HOLDOVER_ASSERT(sizeof(holdover_peer_identifiers_t) == 8U, "sizeof holdover_peer_identifiers_t");
HOLDOVER_ASSERT(offsetof(holdover_peer_identifiers_t, first) == 0U, "holdover_peer_identifiers_t.first");
HOLDOVER_ASSERT(offsetof(holdover_peer_identifiers_t, stride) == 4U, "holdover_peer_identifiers_t.stride");
HOLDOVER_ASSERT(sizeof(holdover_identifiers_t) == 132U, "sizeof holdover_identifiers_t");
HOLDOVER_ASSERT(offsetof(holdover_identifiers_t, time_sync) == 0U, "holdover_identifiers_t.time_sync");
HOLDOVER_ASSERT(offsetof(holdover_identifiers_t, time_follow_up) == 4U, "holdover_identifiers_t.time_follow_up");
HOLDOVER_ASSERT(offsetof(holdover_identifiers_t, motion_command) == 8U, "holdover_identifiers_t.motion_command");
HOLDOVER_ASSERT(offsetof(holdover_identifiers_t, actuator_state) == 12U, "holdover_identifiers_t.actuator_state");
HOLDOVER_ASSERT(offsetof(holdover_identifiers_t, ego_motion_a) == 16U, "holdover_identifiers_t.ego_motion_a");
HOLDOVER_ASSERT(offsetof(holdover_identifiers_t, ego_motion_b) == 20U, "holdover_identifiers_t.ego_motion_b");
HOLDOVER_ASSERT(offsetof(holdover_identifiers_t, driver_request) == 24U, "holdover_identifiers_t.driver_request");
HOLDOVER_ASSERT(offsetof(holdover_identifiers_t, ego_position) == 28U, "holdover_identifiers_t.ego_position");
HOLDOVER_ASSERT(offsetof(holdover_identifiers_t, range_sensor) == 32U, "holdover_identifiers_t.range_sensor");
HOLDOVER_ASSERT(offsetof(holdover_identifiers_t, peers_unserved) == 36U, "holdover_identifiers_t.peers_unserved");
HOLDOVER_ASSERT(offsetof(holdover_identifiers_t, target_estimate_a) == 40U, "holdover_identifiers_t.target_estimate_a");
HOLDOVER_ASSERT(offsetof(holdover_identifiers_t, target_estimate_b) == 44U, "holdover_identifiers_t.target_estimate_b");
HOLDOVER_ASSERT(offsetof(holdover_identifiers_t, own_motion_a) == 48U, "holdover_identifiers_t.own_motion_a");
HOLDOVER_ASSERT(offsetof(holdover_identifiers_t, own_motion_b) == 52U, "holdover_identifiers_t.own_motion_b");
HOLDOVER_ASSERT(offsetof(holdover_identifiers_t, own_horizon) == 56U, "holdover_identifiers_t.own_horizon");
HOLDOVER_ASSERT(offsetof(holdover_identifiers_t, own_driving_parameters) == 60U, "holdover_identifiers_t.own_driving_parameters");
HOLDOVER_ASSERT(offsetof(holdover_identifiers_t, own_position) == 64U, "holdover_identifiers_t.own_position");
HOLDOVER_ASSERT(offsetof(holdover_identifiers_t, own_route) == 68U, "holdover_identifiers_t.own_route");
HOLDOVER_ASSERT(offsetof(holdover_identifiers_t, own_pass) == 72U, "holdover_identifiers_t.own_pass");
HOLDOVER_ASSERT(offsetof(holdover_identifiers_t, peer_pass) == 76U, "holdover_identifiers_t.peer_pass");
HOLDOVER_ASSERT(offsetof(holdover_identifiers_t, health) == 80U, "holdover_identifiers_t.health");
HOLDOVER_ASSERT(offsetof(holdover_identifiers_t, peer_motion_a) == 84U, "holdover_identifiers_t.peer_motion_a");
HOLDOVER_ASSERT(offsetof(holdover_identifiers_t, peer_motion_b) == 92U, "holdover_identifiers_t.peer_motion_b");
HOLDOVER_ASSERT(offsetof(holdover_identifiers_t, peer_horizon) == 100U, "holdover_identifiers_t.peer_horizon");
HOLDOVER_ASSERT(offsetof(holdover_identifiers_t, peer_driving_parameters) == 108U, "holdover_identifiers_t.peer_driving_parameters");
HOLDOVER_ASSERT(offsetof(holdover_identifiers_t, peer_position) == 116U, "holdover_identifiers_t.peer_position");
HOLDOVER_ASSERT(offsetof(holdover_identifiers_t, peer_route) == 124U, "holdover_identifiers_t.peer_route");
HOLDOVER_ASSERT(sizeof(holdover_limits_t) == 16U, "sizeof holdover_limits_t");
HOLDOVER_ASSERT(offsetof(holdover_limits_t, acceleration_mm_s2) == 0U, "holdover_limits_t.acceleration_mm_s2");
HOLDOVER_ASSERT(offsetof(holdover_limits_t, braking_mm_s2) == 4U, "holdover_limits_t.braking_mm_s2");
HOLDOVER_ASSERT(offsetof(holdover_limits_t, jerk_mm_s3) == 8U, "holdover_limits_t.jerk_mm_s3");
HOLDOVER_ASSERT(offsetof(holdover_limits_t, emergency_braking_mm_s2) == 12U, "holdover_limits_t.emergency_braking_mm_s2");
HOLDOVER_ASSERT(sizeof(holdover_body_t) == 20U, "sizeof holdover_body_t");
HOLDOVER_ASSERT(offsetof(holdover_body_t, mass_kg) == 0U, "holdover_body_t.mass_kg");
HOLDOVER_ASSERT(offsetof(holdover_body_t, ratio_milli) == 4U, "holdover_body_t.ratio_milli");
HOLDOVER_ASSERT(offsetof(holdover_body_t, drag_milli) == 8U, "holdover_body_t.drag_milli");
HOLDOVER_ASSERT(offsetof(holdover_body_t, friction_milli) == 12U, "holdover_body_t.friction_milli");
HOLDOVER_ASSERT(offsetof(holdover_body_t, mechanical_n) == 16U, "holdover_body_t.mechanical_n");
HOLDOVER_ASSERT(sizeof(holdover_law_t) == 44U, "sizeof holdover_law_t");
HOLDOVER_ASSERT(offsetof(holdover_law_t, time_gap_ms) == 0U, "holdover_law_t.time_gap_ms");
HOLDOVER_ASSERT(offsetof(holdover_law_t, silent_time_gap_ms) == 4U, "holdover_law_t.silent_time_gap_ms");
HOLDOVER_ASSERT(offsetof(holdover_law_t, standstill_mm) == 8U, "holdover_law_t.standstill_mm");
HOLDOVER_ASSERT(offsetof(holdover_law_t, gain_table) == 12U, "holdover_law_t.gain_table");
HOLDOVER_ASSERT(offsetof(holdover_law_t, gain_milli) == 16U, "holdover_law_t.gain_milli");
HOLDOVER_ASSERT(offsetof(holdover_law_t, damping_ms) == 20U, "holdover_law_t.damping_ms");
HOLDOVER_ASSERT(offsetof(holdover_law_t, feed_forward_milli) == 24U, "holdover_law_t.feed_forward_milli");
HOLDOVER_ASSERT(offsetof(holdover_law_t, free_road_acceleration_mm_s2) == 28U, "holdover_law_t.free_road_acceleration_mm_s2");
HOLDOVER_ASSERT(offsetof(holdover_law_t, target_speed_mm_s) == 32U, "holdover_law_t.target_speed_mm_s");
HOLDOVER_ASSERT(offsetof(holdover_law_t, catch_up_milli) == 36U, "holdover_law_t.catch_up_milli");
HOLDOVER_ASSERT(offsetof(holdover_law_t, max_speed_mm_s) == 40U, "holdover_law_t.max_speed_mm_s");
HOLDOVER_ASSERT(sizeof(holdover_model_t) == 10U, "sizeof holdover_model_t");
HOLDOVER_ASSERT(offsetof(holdover_model_t, lag) == 0U, "holdover_model_t.lag");
HOLDOVER_ASSERT(offsetof(holdover_model_t, limits) == 1U, "holdover_model_t.limits");
HOLDOVER_ASSERT(offsetof(holdover_model_t, last_demand) == 2U, "holdover_model_t.last_demand");
HOLDOVER_ASSERT(offsetof(holdover_model_t, standstill) == 3U, "holdover_model_t.standstill");
HOLDOVER_ASSERT(offsetof(holdover_model_t, trapezoid) == 4U, "holdover_model_t.trapezoid");
HOLDOVER_ASSERT(offsetof(holdover_model_t, interpolate) == 5U, "holdover_model_t.interpolate");
HOLDOVER_ASSERT(offsetof(holdover_model_t, stamped) == 6U, "holdover_model_t.stamped");
HOLDOVER_ASSERT(offsetof(holdover_model_t, endless) == 7U, "holdover_model_t.endless");
HOLDOVER_ASSERT(offsetof(holdover_model_t, received) == 8U, "holdover_model_t.received");
HOLDOVER_ASSERT(offsetof(holdover_model_t, smooth) == 9U, "holdover_model_t.smooth");
HOLDOVER_ASSERT(sizeof(holdover_prediction_t) == 20U, "sizeof holdover_prediction_t");
HOLDOVER_ASSERT(offsetof(holdover_prediction_t, step_us) == 0U, "holdover_prediction_t.step_us");
HOLDOVER_ASSERT(offsetof(holdover_prediction_t, horizon_us) == 4U, "holdover_prediction_t.horizon_us");
HOLDOVER_ASSERT(offsetof(holdover_prediction_t, model) == 8U, "holdover_prediction_t.model");
HOLDOVER_ASSERT(sizeof(holdover_link_t) == 44U, "sizeof holdover_link_t");
HOLDOVER_ASSERT(offsetof(holdover_link_t, period_us) == 0U, "holdover_link_t.period_us");
HOLDOVER_ASSERT(offsetof(holdover_link_t, tolerance_us) == 4U, "holdover_link_t.tolerance_us");
HOLDOVER_ASSERT(offsetof(holdover_link_t, stale_us) == 8U, "holdover_link_t.stale_us");
HOLDOVER_ASSERT(offsetof(holdover_link_t, future_us) == 12U, "holdover_link_t.future_us");
HOLDOVER_ASSERT(offsetof(holdover_link_t, clock_error_us) == 16U, "holdover_link_t.clock_error_us");
HOLDOVER_ASSERT(offsetof(holdover_link_t, slot_reuse_us) == 20U, "holdover_link_t.slot_reuse_us");
HOLDOVER_ASSERT(offsetof(holdover_link_t, holdover_us) == 24U, "holdover_link_t.holdover_us");
HOLDOVER_ASSERT(offsetof(holdover_link_t, ego_timeout_us) == 28U, "holdover_link_t.ego_timeout_us");
HOLDOVER_ASSERT(offsetof(holdover_link_t, request_timeout_us) == 32U, "holdover_link_t.request_timeout_us");
HOLDOVER_ASSERT(offsetof(holdover_link_t, sync_timeout_us) == 36U, "holdover_link_t.sync_timeout_us");
HOLDOVER_ASSERT(offsetof(holdover_link_t, assumed_delay_us) == 40U, "holdover_link_t.assumed_delay_us");
HOLDOVER_ASSERT(sizeof(holdover_envelope_t) == 32U, "sizeof holdover_envelope_t");
HOLDOVER_ASSERT(offsetof(holdover_envelope_t, engaged) == 0U, "holdover_envelope_t.engaged");
HOLDOVER_ASSERT(offsetof(holdover_envelope_t, acceleration_mm_s2) == 4U, "holdover_envelope_t.acceleration_mm_s2");
HOLDOVER_ASSERT(offsetof(holdover_envelope_t, braking_mm_s2) == 8U, "holdover_envelope_t.braking_mm_s2");
HOLDOVER_ASSERT(offsetof(holdover_envelope_t, jerk_mm_s3) == 12U, "holdover_envelope_t.jerk_mm_s3");
HOLDOVER_ASSERT(offsetof(holdover_envelope_t, speed_mm_s) == 16U, "holdover_envelope_t.speed_mm_s");
HOLDOVER_ASSERT(offsetof(holdover_envelope_t, margin_mm) == 20U, "holdover_envelope_t.margin_mm");
HOLDOVER_ASSERT(offsetof(holdover_envelope_t, delay_us) == 24U, "holdover_envelope_t.delay_us");
HOLDOVER_ASSERT(offsetof(holdover_envelope_t, lag_tolerance_milli) == 28U, "holdover_envelope_t.lag_tolerance_milli");
HOLDOVER_ASSERT(sizeof(holdover_config_t) == 332U, "sizeof holdover_config_t");
HOLDOVER_ASSERT(offsetof(holdover_config_t, station) == 0U, "holdover_config_t.station");
HOLDOVER_ASSERT(offsetof(holdover_config_t, range_sensor) == 1U, "holdover_config_t.range_sensor");
HOLDOVER_ASSERT(offsetof(holdover_config_t, base_id) == 2U, "holdover_config_t.base_id");
HOLDOVER_ASSERT(offsetof(holdover_config_t, station_id) == 4U, "holdover_config_t.station_id");
HOLDOVER_ASSERT(offsetof(holdover_config_t, identifiers) == 8U, "holdover_config_t.identifiers");
HOLDOVER_ASSERT(offsetof(holdover_config_t, period_us) == 140U, "holdover_config_t.period_us");
HOLDOVER_ASSERT(offsetof(holdover_config_t, length_mm) == 144U, "holdover_config_t.length_mm");
HOLDOVER_ASSERT(offsetof(holdover_config_t, lag_ms) == 148U, "holdover_config_t.lag_ms");
HOLDOVER_ASSERT(offsetof(holdover_config_t, limits) == 152U, "holdover_config_t.limits");
HOLDOVER_ASSERT(offsetof(holdover_config_t, body) == 168U, "holdover_config_t.body");
HOLDOVER_ASSERT(offsetof(holdover_config_t, correction) == 188U, "holdover_config_t.correction");
HOLDOVER_ASSERT(offsetof(holdover_config_t, passes) == 189U, "holdover_config_t.passes");
HOLDOVER_ASSERT(offsetof(holdover_config_t, law) == 192U, "holdover_config_t.law");
HOLDOVER_ASSERT(offsetof(holdover_config_t, prediction) == 236U, "holdover_config_t.prediction");
HOLDOVER_ASSERT(offsetof(holdover_config_t, link) == 256U, "holdover_config_t.link");
HOLDOVER_ASSERT(offsetof(holdover_config_t, envelope) == 300U, "holdover_config_t.envelope");
HOLDOVER_ASSERT(sizeof(holdover_frame_t) == 16U, "sizeof holdover_frame_t");
HOLDOVER_ASSERT(offsetof(holdover_frame_t, id) == 0U, "holdover_frame_t.id");
HOLDOVER_ASSERT(offsetof(holdover_frame_t, extended) == 4U, "holdover_frame_t.extended");
HOLDOVER_ASSERT(offsetof(holdover_frame_t, remote) == 5U, "holdover_frame_t.remote");
HOLDOVER_ASSERT(offsetof(holdover_frame_t, length) == 6U, "holdover_frame_t.length");
HOLDOVER_ASSERT(offsetof(holdover_frame_t, data) == 7U, "holdover_frame_t.data");
HOLDOVER_ASSERT(sizeof(holdover_command_t) == 16U, "sizeof holdover_command_t");
HOLDOVER_ASSERT(offsetof(holdover_command_t, acceleration_mm_s2) == 0U, "holdover_command_t.acceleration_mm_s2");
HOLDOVER_ASSERT(offsetof(holdover_command_t, effort) == 4U, "holdover_command_t.effort");
HOLDOVER_ASSERT(offsetof(holdover_command_t, mode) == 5U, "holdover_command_t.mode");
HOLDOVER_ASSERT(offsetof(holdover_command_t, cause) == 6U, "holdover_command_t.cause");
HOLDOVER_ASSERT(offsetof(holdover_command_t, limited) == 7U, "holdover_command_t.limited");
HOLDOVER_ASSERT(offsetof(holdover_command_t, effort_value) == 8U, "holdover_command_t.effort_value");
HOLDOVER_ASSERT(offsetof(holdover_command_t, tick) == 10U, "holdover_command_t.tick");
HOLDOVER_ASSERT(offsetof(holdover_command_t, hold) == 11U, "holdover_command_t.hold");
HOLDOVER_ASSERT(offsetof(holdover_command_t, time_ms) == 12U, "holdover_command_t.time_ms");
HOLDOVER_ASSERT(sizeof(holdover_estimate_t) == 48U, "sizeof holdover_estimate_t");
HOLDOVER_ASSERT(offsetof(holdover_estimate_t, position_mm) == 0U, "holdover_estimate_t.position_mm");
HOLDOVER_ASSERT(offsetof(holdover_estimate_t, age_us) == 8U, "holdover_estimate_t.age_us");
HOLDOVER_ASSERT(offsetof(holdover_estimate_t, speed_mm_s) == 16U, "holdover_estimate_t.speed_mm_s");
HOLDOVER_ASSERT(offsetof(holdover_estimate_t, valid) == 20U, "holdover_estimate_t.valid");
HOLDOVER_ASSERT(offsetof(holdover_estimate_t, link_on) == 21U, "holdover_estimate_t.link_on");
HOLDOVER_ASSERT(offsetof(holdover_estimate_t, bounded) == 22U, "holdover_estimate_t.bounded");
HOLDOVER_ASSERT(offsetof(holdover_estimate_t, lowest_position_mm) == 24U, "holdover_estimate_t.lowest_position_mm");
HOLDOVER_ASSERT(offsetof(holdover_estimate_t, highest_position_mm) == 32U, "holdover_estimate_t.highest_position_mm");
HOLDOVER_ASSERT(offsetof(holdover_estimate_t, lowest_speed_mm_s) == 40U, "holdover_estimate_t.lowest_speed_mm_s");
HOLDOVER_ASSERT(offsetof(holdover_estimate_t, highest_speed_mm_s) == 44U, "holdover_estimate_t.highest_speed_mm_s");
HOLDOVER_ASSERT(sizeof(holdover_answer_t) == 392U, "sizeof holdover_answer_t");
HOLDOVER_ASSERT(offsetof(holdover_answer_t, command) == 0U, "holdover_answer_t.command");
HOLDOVER_ASSERT(offsetof(holdover_answer_t, estimate) == 16U, "holdover_answer_t.estimate");
HOLDOVER_ASSERT(offsetof(holdover_answer_t, frame_count) == 64U, "holdover_answer_t.frame_count");
HOLDOVER_ASSERT(offsetof(holdover_answer_t, frames) == 68U, "holdover_answer_t.frames");
HOLDOVER_ASSERT(sizeof(holdover_scale_t) == 8U, "sizeof holdover_scale_t");
HOLDOVER_ASSERT(offsetof(holdover_scale_t, north) == 0U, "holdover_scale_t.north");
HOLDOVER_ASSERT(offsetof(holdover_scale_t, east) == 4U, "holdover_scale_t.east");
HOLDOVER_ASSERT(sizeof(holdover_segment_t) == 48U, "sizeof holdover_segment_t");
HOLDOVER_ASSERT(offsetof(holdover_segment_t, begins) == 0U, "holdover_segment_t.begins");
HOLDOVER_ASSERT(offsetof(holdover_segment_t, length) == 8U, "holdover_segment_t.length");
HOLDOVER_ASSERT(offsetof(holdover_segment_t, latitude) == 16U, "holdover_segment_t.latitude");
HOLDOVER_ASSERT(offsetof(holdover_segment_t, longitude) == 20U, "holdover_segment_t.longitude");
HOLDOVER_ASSERT(offsetof(holdover_segment_t, along) == 24U, "holdover_segment_t.along");
HOLDOVER_ASSERT(offsetof(holdover_segment_t, across) == 32U, "holdover_segment_t.across");
HOLDOVER_ASSERT(offsetof(holdover_segment_t, heading) == 40U, "holdover_segment_t.heading");
#if UINTPTR_MAX == 0xFFFFFFFFFFFFFFFFU
HOLDOVER_ASSERT(sizeof(holdover_path_t) == 16U, "sizeof holdover_path_t");
HOLDOVER_ASSERT(offsetof(holdover_path_t, segments) == 0U, "holdover_path_t.segments");
HOLDOVER_ASSERT(offsetof(holdover_path_t, segment_count) == 8U, "holdover_path_t.segment_count");
HOLDOVER_ASSERT(sizeof(holdover_approach_t) == 40U, "sizeof holdover_approach_t");
HOLDOVER_ASSERT(offsetof(holdover_approach_t, crossing) == 0U, "holdover_approach_t.crossing");
HOLDOVER_ASSERT(offsetof(holdover_approach_t, exits) == 8U, "holdover_approach_t.exits");
HOLDOVER_ASSERT(offsetof(holdover_approach_t, conflicts) == 16U, "holdover_approach_t.conflicts");
HOLDOVER_ASSERT(offsetof(holdover_approach_t, path) == 24U, "holdover_approach_t.path");
HOLDOVER_ASSERT(offsetof(holdover_approach_t, leg) == 32U, "holdover_approach_t.leg");
HOLDOVER_ASSERT(offsetof(holdover_approach_t, exit) == 33U, "holdover_approach_t.exit");
HOLDOVER_ASSERT(sizeof(holdover_intersection_t) == 32U, "sizeof holdover_intersection_t");
HOLDOVER_ASSERT(offsetof(holdover_intersection_t, half) == 0U, "holdover_intersection_t.half");
HOLDOVER_ASSERT(offsetof(holdover_intersection_t, approaches) == 8U, "holdover_intersection_t.approaches");
HOLDOVER_ASSERT(offsetof(holdover_intersection_t, approach_count) == 16U, "holdover_intersection_t.approach_count");
HOLDOVER_ASSERT(offsetof(holdover_intersection_t, id) == 24U, "holdover_intersection_t.id");
HOLDOVER_ASSERT(sizeof(holdover_crossing_t) == 24U, "sizeof holdover_crossing_t");
HOLDOVER_ASSERT(offsetof(holdover_crossing_t, at) == 0U, "holdover_crossing_t.at");
HOLDOVER_ASSERT(offsetof(holdover_crossing_t, intersection) == 8U, "holdover_crossing_t.intersection");
HOLDOVER_ASSERT(offsetof(holdover_crossing_t, leg) == 16U, "holdover_crossing_t.leg");
HOLDOVER_ASSERT(offsetof(holdover_crossing_t, exit) == 17U, "holdover_crossing_t.exit");
HOLDOVER_ASSERT(sizeof(holdover_itinerary_t) == 24U, "sizeof holdover_itinerary_t");
HOLDOVER_ASSERT(offsetof(holdover_itinerary_t, path) == 0U, "holdover_itinerary_t.path");
HOLDOVER_ASSERT(offsetof(holdover_itinerary_t, crossings) == 8U, "holdover_itinerary_t.crossings");
HOLDOVER_ASSERT(offsetof(holdover_itinerary_t, crossing_count) == 16U, "holdover_itinerary_t.crossing_count");
#endif
#endif

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// The version of the library; to be compared with `HOLDOVER_VERSION` once at start, since structs of another version may
// be laid out differently.
uint32_t holdover_version(void);

// The name of a code, as a string in ASCII that is there for good; `"unknown"` if there is no such code.
const char *holdover_status_name(int32_t status);

// Bytes of memory that a unit of the library needs at least; to be compared with `HOLDOVER_UNIT_SIZE` once at start, since a library
// may be built for another capacity than the program.
size_t holdover_unit_size(void);

// Fills in the configuration of a car: 1,500 kg, 4.8 m, 100 Hz, time gap 1.6 s, station 0, no range sensor, passes kept, the envelope
// engaged, and a horizon of 10.71 s or as long as the library has steps for.
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

// Takes note of what the platform around the unit met with, so many times since it last said so: one of
// `HOLDOVER_INCIDENT_...`. `Health` counts it beside the unit's own refusals.
//
// # Safety
// As `holdover_tick`.
holdover_status_t holdover_note(void *unit, int32_t incident, uint32_t times);

// Sets out on a way through intersections: from now on, and until the unit is made anew, positions of peers are taken on the virtual
// lane, and where `DriverRequest` names no predecessor the order at the intersections decides whom to follow.
//
// The way and all that it points to is copied into `map`, of which there are `size` bytes: `HOLDOVER_MAP_SIZE` at least. What is
// refused leaves the unit as it was, and on the way that it had; `map` may hold anything then.
//
// # Safety
// `map` has to be the caller's until the unit is on another way, is made anew, or is not used any more, and nobody else may write to
// it. `way`, and what is in it, has to point to as many structs as it says; `unit` as in `holdover_tick`.
holdover_status_t holdover_set_out(void *unit, const struct holdover_itinerary_t *way, void *map, size_t size);

// How often frames were refused for a cause since the unit was made; `cause` is one of `HOLDOVER_REFUSED_...`. 0 if
// the call is refused.
//
// # Safety
// `count` has to point to memory for a number that nobody else uses during the call; `unit` as in `holdover_tick`.
holdover_status_t holdover_count(void *unit, int32_t cause, uint32_t *count);

// Not of the library: a program on a bare machine may have it. A panic of the library calls it, and when it returns the processor stays
// where it is. Whoever links as docs/INTEGRATION.md says can see that nothing reaches a panic.
void holdover_panicked(void);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* HOLDOVER_H */
