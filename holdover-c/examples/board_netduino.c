/*
 * An STM32F405, or the emulator's model of it (netduinoplus2), without a C library: the processor starts here, and text and
 * the exit code leave through semihosting, which needs a debugger or an emulator to listen.
 */
#include "board.h"

#include <stdint.h>

int main(void);
void reset(void);

/* From the linker script. */
extern uint32_t stack_top, data_start, data_end, data_image, bss_start, bss_end;

enum { SYS_OPEN = 0x01, SYS_WRITE = 0x05, SYS_EXIT_EXTENDED = 0x20 };

static intptr_t semihosting(intptr_t operation, const void *block)
{
    register intptr_t r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = block;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
}

static void stop(uint32_t code)
{
    const uint32_t block[2] = {0x20026 /* the application has exited */, code};
    semihosting(SYS_EXIT_EXTENDED, block);
    for (;;) {
    }
}

void board_write(const char *text, size_t length)
{
    static intptr_t console = -1;
    if (console < 0) {
        const uint32_t open[3] = {(uint32_t)(uintptr_t)":tt", 4 /* "w": standard output */, 3 /* characters of ":tt" */};
        console = semihosting(SYS_OPEN, open);
    }
    const uint32_t write[3] = {(uint32_t)console, (uint32_t)(uintptr_t)text, length};
    semihosting(SYS_WRITE, write);
}

void reset(void)
{
    const uint32_t *image = &data_image;
    for (uint32_t *word = &data_start; word < &data_end; word++) {
        *word = *image++;
    }
    for (uint32_t *word = &bss_start; word < &bss_end; word++) {
        *word = 0;
    }
    *(volatile uint32_t *)0xE000ED88 |= 0xFu << 20; /* access to the FPU, whose registers hard-float code may save */
    __asm__ volatile("dsb\n\tisb");
    stop((uint32_t)main());
}

static void failed(void)
{
    stop(99);
}

/* Where the processor begins: the stack, then what to run at reset, and at the faults. */
__attribute__((section(".vectors"), used)) static const uintptr_t vectors[16] = {
    (uintptr_t)&stack_top, (uintptr_t)reset,  (uintptr_t)failed, (uintptr_t)failed,
    (uintptr_t)failed,     (uintptr_t)failed, (uintptr_t)failed,
};
