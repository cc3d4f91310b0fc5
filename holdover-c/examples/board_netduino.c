/*
 * An STM32F405, or the emulator's model of it (netduinoplus2), without a C library: the processor starts here, and text, files
 * and the exit code go through semihosting, which needs a debugger or an emulator to listen.
 */
#include "board.h"

#include <stdint.h>

int main(void);
void reset(void);

/* From the linker script. */
extern uint32_t stack_top, data_start, data_end, data_image, bss_start, bss_end;

enum { SYS_OPEN = 0x01, SYS_WRITE = 0x05, SYS_READ = 0x06, SYS_EXIT_EXTENDED = 0x20 };

static intptr_t semihosting(intptr_t operation, const void *block)
{
    register intptr_t r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = block;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
}

void board_stop(uint32_t code)
{
    const uint32_t block[2] = {0x20026 /* the application has exited */, code};
    semihosting(SYS_EXIT_EXTENDED, block);
    for (;;) {
    }
}

/* The console is the file ":tt"; opened for writing it is standard output, for appending it is standard error. */
enum { STDOUT = 4, STDERR = 8 };

static intptr_t open_file(const char *name, uint32_t mode)
{
    uint32_t length = 0;
    while (name[length] != '\0') {
        length++;
    }
    const uint32_t block[3] = {(uint32_t)(uintptr_t)name, mode, length};
    return semihosting(SYS_OPEN, block);
}

static intptr_t open_console(uint32_t mode)
{
    return open_file(":tt", mode);
}

static void write_console(intptr_t console, const char *text, size_t length)
{
    const uint32_t block[3] = {(uint32_t)console, (uint32_t)(uintptr_t)text, length};
    semihosting(SYS_WRITE, block);
}

void board_write(const char *text, size_t length)
{
    static intptr_t console = -1;
    if (console < 0) {
        console = open_console(STDOUT);
    }
    write_console(console, text, length);
}

enum { READ_BINARY = 1, WRITE_BINARY = 5 };

bool board_open(board_file_t *file, const char *name, bool to_write)
{
    file->handle = open_file(name, to_write ? WRITE_BINARY : READ_BINARY);
    file->from = file->to = 0;
    return file->handle != -1;
}

size_t board_read_some(intptr_t handle, uint8_t *bytes, size_t count)
{
    const uint32_t block[3] = {(uint32_t)handle, (uint32_t)(uintptr_t)bytes, count};
    return count - (size_t)semihosting(SYS_READ, block); /* it tells what it has not read */
}

void board_write_all(intptr_t handle, const uint8_t *bytes, size_t count)
{
    write_console(handle, (const char *)bytes, count);
}

/* What nothing has been written over since the start was never on the stack. */
static const uint32_t unused = 0xDEADBEEF;

static void paint_stack(void)
{
    volatile uint32_t *end = (volatile uint32_t *)__builtin_frame_address(0) - 16; /* what this function itself has there */
    for (volatile uint32_t *word = &bss_end; word < end; word++) {
        *word = unused;
    }
}

/* Says on standard error how many bytes of stack were in use at the deepest. */
static void report_stack(void)
{
    const volatile uint32_t *deepest = &bss_end;
    while (*deepest == unused) {
        deepest++;
    }
    char text[] = "stack: 000000 bytes\n";
    uint32_t bytes = (uint32_t)((uintptr_t)&stack_top - (uintptr_t)deepest);
    for (char *digit = text + 12; bytes > 0; bytes /= 10) {
        *digit-- = (char)('0' + bytes % 10);
    }
    write_console(open_console(STDERR), text, sizeof text - 1);
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
    paint_stack();
    uint32_t code = (uint32_t)main();
    report_stack();
    board_stop(code);
}

static void failed(void)
{
    board_stop(99);
}

/* Where the processor begins: the stack, then what to run at reset, and at the faults. */
__attribute__((section(".vectors"), used)) static const uintptr_t vectors[16] = {
    (uintptr_t)&stack_top, (uintptr_t)reset,  (uintptr_t)failed, (uintptr_t)failed,
    (uintptr_t)failed,     (uintptr_t)failed, (uintptr_t)failed,
};
