/* What replay.c needs of the machine that it runs on. */
#ifndef BOARD_H
#define BOARD_H

#include <stddef.h>

/* Writes text to where a program's output goes. */
void board_write(const char *text, size_t length);

#endif
