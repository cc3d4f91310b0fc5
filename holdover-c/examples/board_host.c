/* A host: text enters, standard output leaves; and files. */
#include "board.h"

#include <stdio.h>
#include <stdlib.h>

void board_write(const char *text, size_t length)
{
    fwrite(text, 1, length, stdout);
}

void board_stop(uint32_t code)
{
    exit((int)code);
}

bool board_open(board_file_t *file, const char *name, bool to_write)
{
    FILE *const opened = fopen(name, to_write ? "wb" : "rb");
    if (opened != NULL) {
        setvbuf(opened, NULL, _IONBF, 0);
    }
    file->handle = (intptr_t)opened;
    file->from = file->to = 0;
    return opened != NULL;
}

size_t board_read_some(intptr_t handle, uint8_t *bytes, size_t count)
{
    return fread(bytes, 1, count, (FILE *)handle);
}

void board_write_all(intptr_t handle, const uint8_t *bytes, size_t count)
{
    fwrite(bytes, 1, count, (FILE *)handle);
}
