#!/usr/bin/env bash
# holdover-c/check.sh: the C example says what the Rust core says, byte for byte, on the host and on a Cortex-M4F in the
# emulator; the header is one for C99 and for C++; the C of the manual compiles; no panic can be reached. `./ci.sh c` runs it.
# Exit code 77: something that it needs is not there, and cannot be had.
set -euo pipefail
cd "$(dirname "$0")/.."

target=thumbv7em-none-eabihf
build=${CARGO_TARGET_DIR:-target}/c
sources=holdover-c/examples
most_stack=4096
strict=(-std=c99 -Wall -Wextra -Werror -pedantic -O2 -I holdover-c)

source scripts/need.sh

same() {
    cmp "$1" "$2" || { diff "$1" "$2" | head -n 20; return 1; }
}

rm -rf "$build"
mkdir -p "$build"
cargo run --locked --release --quiet -p holdover-c --example reference >"$build/reference.txt"
frames=$(grep -vc '^-' "$build/reference.txt")

# On the host.
cargo build --locked --release -p holdover-c
library=${CARGO_TARGET_DIR:-target}/release/libholdover_c.a
gcc "${strict[@]}" "$sources"/{replay,calibration,board_host}.c "$library" -lpthread -ldl -lm -o "$build/replay"
"$build/replay" >"$build/host.txt"
same "$build/reference.txt" "$build/host.txt"
echo "host: $frames frames, the same as of the Rust core"

# The manual's pieces of C, each by itself.
awk -v to="$build/manual" '/^```c$/ { n++; on = 1; next } /^```/ { on = 0 } on { print > (to n ".c") }' docs/INTEGRATION.md
for piece in "$build"/manual*.c; do
    gcc "${strict[@]}" -fsyntax-only "$piece"
done

need g++ g++
printf '#include "holdover.h"\nholdover_answer_t answer;\n' >"$build/header.cpp"
g++ -std=c++11 -Wall -Wextra -Werror -pedantic -I holdover-c -fsyntax-only "$build/header.cpp"

# On the ECU.
need arm-none-eabi-gcc gcc-arm-none-eabi
need qemu-system-arm qemu-system-arm
bin=$(scripts/install-target.sh "$target") || skip "no standard library for $target can be had on this machine"
PATH=$bin:$PATH cargo build --locked --profile firmware --target "$target" -p holdover-c
library=${CARGO_TARGET_DIR:-target}/$target/firmware/libholdover_c.a
image=$build/replay.elf
arm-none-eabi-gcc "${strict[@]}" -mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16 -ffreestanding \
    -nostdlib -T "$sources/netduino.ld" -Wl,--gc-sections -Wl,-z,noexecstack -Wl,-Map="$build/replay.map" \
    "$sources"/{replay,calibration,board_netduino}.c "$library" -o "$image"
if arm-none-eabi-nm -C "$image" | grep -iE 'panic|unwrap_failed|rust_begin_unwind'; then
    echo "a panic can be reached from the image (above)"
    exit 1
fi
timeout 60 qemu-system-arm -M netduinoplus2 -display none -serial none -monitor none \
    -semihosting-config enable=on,target=native -kernel "$image" >"$build/ecu.txt" 2>"$build/stack.txt" </dev/null || {
    cat "$build/stack.txt"
    exit 1
}
same "$build/reference.txt" "$build/ecu.txt"
stack=$(sed -n 's/^stack: 0*\([0-9]*\) bytes$/\1/p' "$build/stack.txt")
[ -n "$stack" ] && [ "$stack" -le "$most_stack" ] || {
    echo "the image took ${stack:-an unknown number of} bytes of stack, of at most $most_stack"
    exit 1
}
arm-none-eabi-size "$image"
echo "$target: $frames frames, the same as of the Rust core; no panic in the image; $stack bytes of stack"
