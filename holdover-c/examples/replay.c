/*
 * A drive that was recorded as CAN frames is given to a unit, and what the unit sends is printed: the three calls of
 * holdover.h at work. On a real bus the frames come from a driver, and the times from a clock.
 */
#include "board.h"
#include "calibration.h"
#include "holdover.h"

static const struct {
    uint64_t at_us;
    holdover_frame_t frame;
} drive[] = {
#include "drive.inc"
};

static const uint64_t tick_us = 10000;
static const uint64_t end_us = 6500000;

/* The unit lives here. An array of 64-bit words has the alignment that it needs. */
static uint64_t unit[HOLDOVER_UNIT_SIZE / sizeof(uint64_t)];

/* A number with at least so many digits, to base 10 or 16. */
static char *put_number(char *text, uint64_t number, unsigned base, unsigned digits)
{
    char reversed[20];
    unsigned count = 0;
    do {
        reversed[count++] = "0123456789abcdef"[number % base];
        number /= base;
    } while (number != 0 || count < digits);
    while (count > 0) {
        *text++ = reversed[--count];
    }
    return text;
}

static void print_frame(uint64_t now_us, const holdover_frame_t *frame)
{
    char line[64];
    char *end = put_number(line, now_us, 10, 1);
    *end++ = ' ';
    end = put_number(end, frame->id, 16, 1);
    *end++ = ' ';
    for (unsigned byte = 0; byte < frame->length; byte++) {
        end = put_number(end, frame->data[byte], 16, 2);
    }
    *end++ = '\n';
    board_write(line, (size_t)(end - line));
}

/* How often what was refused, code after code. */
static void print_refusals(void)
{
    uint32_t count;
    for (int32_t cause = HOLDOVER_REFUSED_LENGTH; holdover_count(unit, cause, &count) == HOLDOVER_OK; cause--) {
        char line[32];
        char *end = line;
        *end++ = '-';
        end = put_number(end, (uint64_t)-cause, 10, 1);
        *end++ = ' ';
        end = put_number(end, count, 10, 1);
        *end++ = '\n';
        board_write(line, (size_t)(end - line));
    }
}

int main(void)
{
    /* Not on the stack, where they would lie for as long as the program runs. */
    static holdover_config_t config;
    static holdover_answer_t answer;
    size_t next = 0;

    if (holdover_version() != HOLDOVER_VERSION) {
        return 1; /* the header is not that of the library */
    }
    config = calibration;
    if (holdover_init(unit, sizeof unit, &config) != HOLDOVER_OK) {
        return 2;
    }
    for (uint64_t now_us = 0; now_us <= end_us; now_us += tick_us) {
        for (; next < sizeof drive / sizeof drive[0] && drive[next].at_us < now_us; next++) {
            /* A refused frame is counted in the unit, and its Health message tells. */
            (void)holdover_receive(unit, drive[next].at_us, &drive[next].frame);
        }
        if (holdover_tick(unit, now_us, &answer) != HOLDOVER_OK) {
            return 3;
        }
        for (uint32_t frame = 0; frame < answer.frame_count; frame++) {
            print_frame(now_us, &answer.frames[frame]);
        }
    }
    print_refusals();
    return 0;
}
