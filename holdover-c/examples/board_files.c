/* Files by pieces of a buffer: each call of the machine may stop it. */
#include "board.h"

bool board_read(board_file_t *file, uint8_t *bytes, size_t count)
{
    for (size_t byte = 0; byte < count; byte++) {
        if (file->from == file->to) {
            file->from = 0;
            file->to = board_read_some(file->handle, file->buffer, sizeof file->buffer);
            if (file->to == 0) {
                return false;
            }
        }
        bytes[byte] = file->buffer[file->from++];
    }
    return true;
}

void board_write_file(board_file_t *file, const uint8_t *bytes, size_t count)
{
    for (size_t byte = 0; byte < count; byte++) {
        if (file->to == sizeof file->buffer) {
            board_close(file);
        }
        file->buffer[file->to++] = bytes[byte];
    }
}

void board_close(board_file_t *file)
{
    board_write_all(file->handle, file->buffer, file->to);
    file->to = 0;
}
