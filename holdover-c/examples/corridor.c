/*
 * A vehicle's way through four intersections, as it was recorded on its bus, is given to a unit, and what the unit sends is written to
 * a file: `log.bin` of the present folder enters, `sent.bin` leaves. tests/embedded/README.md says how a log is recorded, and
 * tests/replay/ what stands in it. It begins with the unit's configuration and map.
 *
 * A project of your own has its map as constants. Here it is read, so it needs room.
 */
#include "board.h"
#include "holdover.h"

#include <stdbool.h>

enum { SEGMENTS = 80, PATHS = 20, APPROACHES = 16, CROSSINGS = 4 };

static struct {
    holdover_segment_t segments[SEGMENTS];
    holdover_path_t paths[PATHS];
    holdover_approach_t approaches[APPROACHES];
    holdover_intersection_t intersections[CROSSINGS];
    holdover_crossing_t crossings[CROSSINGS];
    size_t segment_count, path_count, approach_count;
} map;

static uint64_t unit[HOLDOVER_UNIT_SIZE / sizeof(uint64_t)];
static uint64_t kept[HOLDOVER_MAP_SIZE(SEGMENTS, PATHS, APPROACHES, CROSSINGS, CROSSINGS) / sizeof(uint64_t)];

static board_file_t file_in, file_out;
static bool at_end;

/* A record: 7 bytes of time, the length, 4 of the identifier, 8 of data. */
enum { RECORD = 20 };
static const uint32_t id_of_tick = 0xFFFFFFFFU;
static const uint32_t is_standard = 0x80000000U;

static uint64_t little_endian(const uint8_t *bytes, unsigned count)
{
    uint64_t number = 0;
    while (count > 0) {
        number = (number << 8) | bytes[--count];
    }
    return number;
}

static void put_little_endian(uint8_t *bytes, uint64_t number, unsigned count)
{
    for (unsigned byte = 0; byte < count; byte++) {
        bytes[byte] = (uint8_t)(number >> (8 * byte));
    }
}

/* The next word of the head; 0 behind the end. */
static int64_t word(void)
{
    uint8_t bytes[8];
    if (!board_read(&file_in, bytes, sizeof bytes)) {
        at_end = true;
        return 0;
    }
    return (int64_t)little_endian(bytes, sizeof bytes);
}

/* A number with so many fraction bits, in thousandths, to nearest. */
static uint32_t milli(int64_t bits, unsigned fraction)
{
    return (uint32_t)((bits * 1000 + ((int64_t)1 << (fraction - 1))) >> fraction);
}

static void configuration(holdover_config_t *config)
{
    (void)holdover_default_config(config);
    config->station = (uint8_t)word();
    config->station_id = (uint32_t)word();
    config->law.time_gap_ms = milli(word(), 29);
    config->law.silent_time_gap_ms = milli(word(), 29);
    config->law.standstill_mm = milli(word(), 20);
    config->law.target_speed_mm_s = milli(word(), 23);
    config->law.catch_up_milli = milli(word(), 30);
    config->law.feed_forward_milli = milli(word(), 30);
    config->prediction.step_us = (uint32_t)word();
    config->prediction.horizon_us = (uint32_t)word();
    config->envelope.engaged = (uint8_t)word();
    config->range_sensor = (uint8_t)word();
}

static holdover_scale_t scale(void)
{
    holdover_scale_t scale;
    scale.north = (int32_t)word();
    scale.east = (int32_t)word();
    return scale;
}

static const holdover_path_t *path(void)
{
    const size_t count = (size_t)word();
    if (map.path_count == PATHS || count > SEGMENTS - map.segment_count) {
        return NULL; /* which is refused */
    }
    holdover_segment_t *const segments = &map.segments[map.segment_count];
    map.segment_count += count;
    for (size_t number = 0; number < count; number++) {
        holdover_segment_t *const segment = &segments[number];
        segment->latitude = (int32_t)word();
        segment->longitude = (int32_t)word();
        segment->begins = word();
        segment->length = word();
        segment->along = scale();
        segment->across = scale();
        segment->heading = (uint16_t)word();
    }
    holdover_path_t *const path = &map.paths[map.path_count++];
    path->segments = segments;
    path->segment_count = count;
    return path;
}

static void crossing(holdover_crossing_t *crossing, holdover_intersection_t *intersection)
{
    crossing->leg = (uint8_t)word();
    crossing->exit = (uint8_t)word();
    crossing->at = word();
    crossing->intersection = intersection;
    intersection->id = (uint8_t)word();
    intersection->half = word();
    intersection->approach_count = (size_t)word();
    if (intersection->approach_count > APPROACHES - map.approach_count) {
        intersection->approach_count = 0;
    }
    holdover_approach_t *const approaches = &map.approaches[map.approach_count];
    map.approach_count += intersection->approach_count;
    intersection->approaches = approaches;
    for (size_t number = 0; number < intersection->approach_count; number++) {
        approaches[number].leg = (uint8_t)word();
        approaches[number].exit = (uint8_t)word();
        approaches[number].path = path();
        approaches[number].crossing = word();
        approaches[number].exits = word();
        approaches[number].conflicts = (uint64_t)word();
    }
}

static holdover_itinerary_t itinerary(void)
{
    holdover_itinerary_t way;
    way.path = path();
    way.crossings = map.crossings;
    way.crossing_count = (size_t)word();
    if (way.crossing_count > CROSSINGS) {
        way.crossing_count = 0; /* which is refused */
    }
    for (size_t number = 0; number < way.crossing_count; number++) {
        crossing(&map.crossings[number], &map.intersections[number]);
    }
    return way;
}

static void write_record(uint64_t at_us, uint32_t id, const uint8_t *data)
{
    uint8_t record[RECORD];
    put_little_endian(record, at_us, 7);
    record[7] = 8;
    put_little_endian(&record[8], id, 4);
    for (unsigned byte = 0; byte < 8; byte++) {
        record[12 + byte] = data[byte];
    }
    board_write_file(&file_out, record, sizeof record);
}

/* All that happened, one record after the other. */
static holdover_status_t live(void)
{
    uint8_t record[RECORD];
    while (board_read(&file_in, record, sizeof record)) {
        const uint64_t at_us = little_endian(record, 7);
        const uint32_t id = (uint32_t)little_endian(&record[8], 4);
        if (id != id_of_tick) {
            holdover_frame_t frame = {0};
            frame.extended = (id & is_standard) == 0U ? 1U : 0U;
            frame.id = id & ~is_standard;
            frame.length = record[7];
            for (unsigned byte = 0; byte < sizeof frame.data; byte++) {
                frame.data[byte] = record[12 + byte];
            }
            (void)holdover_receive(unit, at_us, &frame); /* what is refused is counted */
            continue;
        }
        static holdover_answer_t answer; /* not on the stack */
        const holdover_status_t status = holdover_tick(unit, at_us, &answer);
        if (status != HOLDOVER_OK) {
            return status;
        }
        for (uint32_t number = 0; number < answer.frame_count; number++) {
            const holdover_frame_t *const frame = &answer.frames[number];
            write_record(at_us, frame->extended != 0U ? frame->id : (frame->id | is_standard), frame->data);
        }
    }
    return HOLDOVER_OK;
}

/* How often what was refused, cause after cause. */
static void write_refusals(void)
{
    uint32_t count;
    for (int32_t cause = HOLDOVER_REFUSED_LENGTH; holdover_count(unit, cause, &count) == HOLDOVER_OK; cause--) {
        uint8_t data[8];
        put_little_endian(data, count, sizeof data);
        write_record(0, (uint32_t)(HOLDOVER_REFUSED_LENGTH - cause) | is_standard, data);
    }
}

int main(void)
{
    static holdover_config_t config; /* not on the stack, where it would lie for as long as the program runs */
    if (holdover_version() != HOLDOVER_VERSION || holdover_unit_size() != HOLDOVER_UNIT_SIZE) {
        return 1; /* the header is not that of the library */
    }
    if (!board_open(&file_in, "log.bin", false) || !board_open(&file_out, "sent.bin", true)) {
        return 2;
    }
    configuration(&config);
    if (holdover_init(unit, sizeof unit, &config) != HOLDOVER_OK) {
        return 3;
    }
    if (word() != 0) {
        const holdover_itinerary_t way = itinerary();
        if (at_end || holdover_set_out(unit, &way, kept, sizeof kept) != HOLDOVER_OK) {
            return 4;
        }
    }
    if (live() != HOLDOVER_OK) {
        return 5;
    }
    write_refusals();
    board_close(&file_out);
    return 0;
}
