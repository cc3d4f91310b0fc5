/* What the examples need of the machine that they run on. */
#ifndef BOARD_H
#define BOARD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Writes text to where a program's output goes. */
void board_write(const char *text, size_t length);

/* Ends the program with this exit code. */
void board_stop(uint32_t code);

/* A file of the present folder, with a small buffer. */
typedef struct {
    intptr_t handle;
    size_t from, to;
    uint8_t buffer[640];
} board_file_t;

/* Opens a file, or makes it to be written; whether that went well. */
bool board_open(board_file_t *file, const char *name, bool to_write);

/* Reads so many bytes; false where there are not as many. */
bool board_read(board_file_t *file, uint8_t *bytes, size_t count);

/* Writes bytes, sooner or later. */
void board_write_file(board_file_t *file, const uint8_t *bytes, size_t count);

/* Writes what is not written yet. */
void board_close(board_file_t *file);

/* Of a machine: reads up to so many bytes, or writes them; how many it did. */
size_t board_read_some(intptr_t handle, uint8_t *bytes, size_t count);
void board_write_all(intptr_t handle, const uint8_t *bytes, size_t count);

#endif
