#!/usr/bin/env bash
# firmware.sh: the firmware builds in every form, nothing in it can panic, it ticks in the emulator, replayed logs give the
# same frames as on this host, and what it costs is no more than it was. `./ci.sh firmware` runs it. The costs are of a
# workspace of their own. Logs and costs are run beside the images: most of either is one compiler that has one processor.
# Exit code 77: something that it needs is not there, and cannot be had.
set -euo pipefail
cd "$(dirname "$0")/.."

ecu=thumbv7em-none-eabihf
small=thumbv6m-none-eabi
real_time=armv7r-none-eabihf
built=${CARGO_TARGET_DIR:-target}
work=$built/firmware
export CARGO_TERM_COLOR=${CARGO_TERM_COLOR:-never}

source scripts/need.sh

need qemu-system-arm qemu-system-arm
need arm-none-eabi-nm binutils-arm-none-eabi
for target in $ecu $small $real_time; do
    bin=$(scripts/install-target.sh $target) || skip "no standard library for $target can be had on this machine"
done
PATH=$bin:$PATH
mkdir -p "$work"

firmware() {
    cargo build --locked --quiet --profile firmware --target $ecu --bin holdover-ecu "$@"
}

emulate() {
    timeout "${seconds:-60}" qemu-system-arm -nographic -monitor none "$@"
}

# One form of the image: without a warning, and how large it is. With `no-panic` it only links if nothing reaches the panic handler. The
# board that is built for by default is not named, so that what other steps built is not built again.
form() { # BOARD FEATURES
    export HOLDOVER_BOARD=$1
    [ "$1" != stm32f405 ] || unset HOLDOVER_BOARD
    cargo clippy --locked --quiet --profile firmware --target $ecu --bin holdover-ecu --features "$2" -- -D warnings
    firmware --features "$2"
    size -A "$built/$ecu/firmware/holdover-ecu" | awk -v board="$1" -v features="${2:-none}" '
        $1 == ".vector_table" || $1 == ".text" || $1 == ".rodata" || $1 == ".data" { flash += $2 }
        $1 == ".data" || $1 == ".bss" || $1 == ".uninit" { ram += $2 }
        END { printf "  %-17s features %-14s flash %6d  static RAM %6d\n", board, features, flash, ram }'
}

# A frame of ours that is too short; the unit has to count it, in the page of `Health` for cause 0.
for_5_s() {
    { sleep 1; printf 't480100\r'; sleep 4; } | seconds=5 emulate -M netduinoplus2 -serial stdio -kernel "$image" \
        >"$work/serial.txt" 2>/dev/null || [ $? = 124 ]
    tr '\r' '\n' <"$work/serial.txt" | awk '
        /^t[0-9A-F]+$/ { frames++ }
        # MotionCommand every 10 ms; Health every 100 ms, page after page, the cause in bits 12 to 19 and its count behind it.
        /^t4828/ { commands++ }
        /^t498/ && substr($0, 8, 1) == "0" && substr($0, 11, 1) == "0" && substr($0, 10, 1) == "1" { counted = 1 }
        END {
            printf "  %d frames, %d of them commands; the short frame is %s\n", frames, commands, counted ? "counted" : "not counted"
            exit !(commands > 300 && commands < 560 && counted)
        }'
}

images() {
    echo "-- the image in its forms"
    form feather_stm32f405 bxcan
    form pyboard bxcan
    form nucleo_g474re log
    for features in log bxcan,log log-semihosting ''; do
        form stm32f405 "$features"
    done
    image=$built/$ecu/firmware/holdover-ecu
    # The idle unit is zero throughout. A field whose nothing is not zero would put the whole unit into flash as well.
    arm-none-eabi-nm "$image" | grep -E ' [bB] .*4UNIT' >/dev/null || {
        echo "the static UNIT does not lie in .bss: a field of the idle unit is not zero in memory (src/held.rs)"
        exit 1
    }

    echo "-- no panic in the image, from its start on"
    form nucleo_g474re no-panic
    for features in fd bxcan ''; do
        form stm32f405 "no-panic${features:+,$features}"
    done
    echo "  linked: nothing reaches the panic handler"
    if RUSTFLAGS='--cfg seeded_panic' firmware --features no-panic --target-dir "$work/seeded" 2>"$work/seeded.txt"; then
        echo "the check does not work: an image with a panic in it was linked"
        exit 1
    fi
    grep -q 'undefined symbol: the_firmware_can_panic' "$work/seeded.txt" || {
        echo "the image with a panic in it failed for another reason:"
        cat "$work/seeded.txt"
        exit 1
    }
    echo "  and with a panic put in, not linked"

    echo "-- the image in the emulator, for 5 s"
    firmware # the one without features again
    # The emulator keeps to the wall clock: on a machine that is busy with something else it may get too little of it once.
    for_5_s || for_5_s || for_5_s

    echo "-- the image that logs, for 3 s without a debugger"
    firmware --features log
    rtt=$(arm-none-eabi-nm "$image" | awk '$3 == "_SEGGER_RTT" { print $1 }')
    {
        sleep 3
        printf 'pmemsave 0x%s 48 "%s"\nquit\n' "$rtt" "$work/rtt.bin"
    } | timeout 20 qemu-system-arm -display none -M netduinoplus2 -serial "file:$work/logging.txt" -monitor stdio -kernel "$image" \
        >/dev/null
    commands=$(tr '\r' '\n' <"$work/logging.txt" | grep -c '^t4828')
    # Of the buffer for a probe: how much was written into it, and how much of that was read.
    read -r written unread <<<"$(od -A n -t u4 -j 36 -N 8 "$work/rtt.bin")"
    echo "  $commands commands; $written bytes of log wait for a probe"
    [ "$commands" -gt 100 ] && [ "$written" -gt 0 ] && [ "$unread" = 0 ]
}

replays_and_costs() {
    echo "-- logs replayed, against this host"
    need_programs
    holdover_log=$programs/holdover-log
    cd tests/embedded
    built=$(realpath -m "${CARGO_TARGET_DIR:-target}")
    replays=$built/replay
    mkdir -p "$replays"
    "$holdover_log" record "$replays" | sed 's/^/  /'
    # The unit is as large as the firmware's. The Cortex-M0 needs more memory for it than its board has; the Cortex-R5F stands alone.
    while read -r target machine; do
        program=$built/$target/firmware/replay
        read -ra machine <<<"$machine"
        cargo clippy --locked --quiet --profile firmware --target "$target" -p holdover-image --bin replay -- -D warnings
        cargo build --locked --quiet --profile firmware --target "$target" -p holdover-image --bin replay
        for log in string corridor; do
            rm -f "$replays/$log/sent.bin"
            (cd "$replays/$log" && emulate -serial none -semihosting-config enable=on,target=native \
                -M "${machine[@]/@/$program}")
            printf '  %s, %s: ' "$target" "$log"
            "$holdover_log" compare "$replays/$log/host.bin" "$replays/$log/sent.bin"
        done
    done <<TEXT
$ecu netduinoplus2 -kernel @
$small microbit -global nrf51-soc.sram-size=131072 -kernel @
$real_time none -cpu cortex-r5f -m 16M -device loader,cpu-num=0,file=@
TEXT

    echo "-- what it costs, in instructions and bytes"
    ./cost.sh
}

replays_and_costs >"$work/beside.txt" 2>&1 &
beside=$!
trap 'kill $beside 2>/dev/null || true' EXIT
images
code=0
wait $beside || code=$?
cat "$work/beside.txt"
exit $code
