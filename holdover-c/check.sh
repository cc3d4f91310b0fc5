#!/usr/bin/env bash
# holdover-c/check.sh: the C examples say what the Rust core says, byte for byte, on the host and on a Cortex-M4F in the
# emulator: a short drive, and the whole way of the corridor's ego through four intersections. The header is one for C99, C11 and
# C++, for each capacity, and MISRA C; the C of the manual compiles; no panic can be reached. `./ci.sh c` runs it.
# Exit code 77: something that it needs is not there, and cannot be had.
set -euo pipefail
cd "$(dirname "$0")/.."

target=thumbv7em-none-eabihf
build=$(realpath -m "${CARGO_TARGET_DIR:-target}/c")
sources=holdover-c/examples
most_stack=4096
strict=(-Wall -Wextra -Werror -pedantic -O2 -I holdover-c)
arm=(-mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16 -ffreestanding)
# The functions of the examples in sections of their own, so that what is not used is not in the image.
image=(-std=c99 "${strict[@]}" "${arm[@]}" -ffunction-sections -nostdlib -T "$sources/netduino.ld" -Wl,--gc-sections -Wl,-z,noexecstack)

source scripts/need.sh

same() {
    cmp "$1" "$2" || { diff "$1" "$2" | head -n 20; return 1; }
}

emulate() {
    timeout 120 qemu-system-arm -M netduinoplus2 -display none -serial none -monitor none \
        -semihosting-config enable=on,target=native -kernel "$@" </dev/null
}

rm -rf "$build"
mkdir -p "$build"
need_programs
log=$programs/holdover-log
"$programs/examples/reference" >"$build/reference.txt"
frames=$(grep -vc '^-' "$build/reference.txt")
"$log" record "$build" | grep '^corridor'

# On the host.
library=${CARGO_TARGET_DIR:-target}/release/libholdover_c.a
system=(-lpthread -ldl -lm)
for capacity in 16-8-1072 4-4-200; do
    cargo build --locked --release -p holdover-c --features "capacity-$capacity"
    gcc -std=c11 "${strict[@]}" "-DHOLDOVER_CAPACITY_${capacity//-/_}" "$sources/capacity.c" "$library" "${system[@]}" -o "$build/capacity"
    "$build/capacity"
    echo "host: a unit of $capacity starts"
done
cargo build --locked --release -p holdover-c
gcc -std=c11 "${strict[@]}" "$sources/capacity.c" "$library" "${system[@]}" -o "$build/capacity"
"$build/capacity"
gcc -std=c99 "${strict[@]}" "$sources"/{replay,calibration,board_host}.c "$library" "${system[@]}" -o "$build/replay"
"$build/replay" >"$build/host.txt"
same "$build/reference.txt" "$build/host.txt"
echo "host: $frames frames, the same as of the Rust core"
gcc -std=c99 "${strict[@]}" "$sources"/{corridor,board_files,board_host}.c "$library" "${system[@]}" -o "$build/ego"
(cd "$build/corridor" && ../ego)
"$log" compare "$build/corridor/host.bin" "$build/corridor/sent.bin" | sed 's/^/host: the corridor, /'

# The manual's pieces of C, each by itself.
awk -v to="$build/manual" '/^```c$/ { n++; on = 1; next } /^```/ { on = 0 } on { print > (to n ".c") }' docs/INTEGRATION.md
for piece in "$build"/manual*.c; do
    gcc -std=c99 "${strict[@]}" -fsyntax-only "$piece"
done

# The header: layouts by either kind of compiler, and what MISRA C objects to. That not all of it is used is no fault of a header.
need g++ g++
need cppcheck cppcheck
printf '#include "holdover.h"\nholdover_answer_t answer;\n' >"$build/header.cpp"
for capacity in 8_8_400 16_8_1072 4_4_200; do
    g++ -std=c++11 "${strict[@]}" "-DHOLDOVER_CAPACITY_$capacity" -fsyntax-only "$build/header.cpp"
    gcc -std=c11 "${strict[@]}" "-DHOLDOVER_CAPACITY_$capacity" -fsyntax-only "$sources/misra.c"
done
sed 's/HOLDOVER_ASSERT(sizeof(holdover_config_t) == \([0-9]*\)U/HOLDOVER_ASSERT(sizeof(holdover_config_t) != \1U/' holdover-c/holdover.h >"$build/holdover.h"
if gcc -std=c11 -I "$build" -fsyntax-only "$sources/misra.c" 2>/dev/null; then
    echo "the check does not work: a header with another layout was compiled"
    exit 1
fi
cppcheck --std=c99 --addon=misra -I holdover-c -q --enable=style "$sources/misra.c" >"$build/misra.txt" 2>&1
if grep -F '[misra-' "$build/misra.txt" | grep -v '\[misra-c2012-2\.[35]\]'; then
    echo "MISRA C has rules against the header, or against how it is used (above)"
    exit 1
fi

# On the ECU.
need arm-none-eabi-gcc gcc-arm-none-eabi
need qemu-system-arm qemu-system-arm
bin=$(scripts/install-target.sh "$target") || skip "no standard library for $target can be had on this machine"
PATH=$bin:$PATH
library=${CARGO_TARGET_DIR:-target}/$target/firmware/libholdover_c.a
cargo build --locked --profile firmware --target "$target" -p holdover-c --features _panic
arm-none-eabi-gcc "${image[@]}" "$sources"/{panicked,board_netduino}.c "$library" -o "$build/panicked.elf"
code=0
said=$(emulate "$build/panicked.elf" 2>/dev/null) || code=$?
[ "$said $code" = "panicked 42" ] || {
    echo "the hook of a panic was not called: $said, exit code $code"
    exit 1
}
cargo build --locked --profile firmware --target "$target" -p holdover-c
arm-none-eabi-gcc -std=c11 "${strict[@]}" "${arm[@]}" -fsyntax-only "$sources/misra.c"
for example in replay corridor; do
    files=("$sources/$example.c" "$sources/board_netduino.c" "$sources/board_files.c")
    [ $example = corridor ] || files+=("$sources/calibration.c")
    arm-none-eabi-gcc "${image[@]}" -Wl,-Map="$build/$example.map" "${files[@]}" "$library" -o "$build/$example.elf"
    if arm-none-eabi-nm -C "$build/$example.elf" | grep -iE 'panic|unwrap_failed|rust_begin_unwind'; then
        echo "a panic can be reached from the image (above)"
        exit 1
    fi
done
emulate "$build/replay.elf" >"$build/ecu.txt" 2>"$build/stack.txt" || {
    cat "$build/stack.txt"
    exit 1
}
same "$build/reference.txt" "$build/ecu.txt"
(
    cd "$build/corridor"
    rm sent.bin
    emulate ../corridor.elf 2>../stack-corridor.txt
)
"$log" compare "$build/corridor/host.bin" "$build/corridor/sent.bin" | sed "s/^/$target: the corridor, /"
for text in stack stack-corridor; do
    stack=$(sed -n 's/^stack: 0*\([0-9]*\) bytes$/\1/p' "$build/$text.txt")
    [ -n "$stack" ] && [ "$stack" -le "$most_stack" ] || {
        echo "the image took ${stack:-an unknown number of} bytes of stack, of at most $most_stack"
        exit 1
    }
    echo "$target: $stack bytes of stack"
done
arm-none-eabi-size "$build"/{replay,corridor}.elf
echo "$target: $frames frames, the same as of the Rust core; no panic in the image, and one put in calls its hook"
