/* What becomes of a panic, in a library that is built to have one: the hook is called. */
#include "board.h"
#include "holdover.h"

extern void holdover_panic(void); /* with the feature _panic alone */

void holdover_panicked(void)
{
    static const char text[] = "panicked\n";
    board_write(text, sizeof text - 1);
    board_stop(42);
}

int main(void)
{
    holdover_panic();
    return 0;
}
