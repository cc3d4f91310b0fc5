#!/usr/bin/env bash
# device-m4.sh [OPTION...] IMAGE -- COMMAND [ARG...]
#
# Runs a command beside the firmware on a Cortex-M4F in the emulator (QEMU's `netduinoplus2`, an STM32F405). The emulator
# has no CAN controller for that chip; the firmware is a serial CAN adapter's other end, and Linux's own line discipline
# `slcan` makes the CAN interface `slcan0` of it, in user-mode Linux (see vcan.sh). The exit status is the command's.
#
#   --timeout S    end both after S seconds (default: 600)
#   -h, --help     this text
#
# The image:  cargo build --profile firmware --target thumbv7em-none-eabihf --bin holdover-ecu
# Example:    scripts/device-m4.sh target/thumbv7em-none-eabihf/firmware/holdover-ecu -- candump -n 20 slcan0
#
# Exit code: the command's; 2 wrong usage; 77 no QEMU or no vcan here; 124 the time was up; 125 the device did not start.
set -euo pipefail

say() { echo "device-m4: $*" >&2; }

# Inside of the kernel that has CAN: the serial line becomes an interface, and the command runs.
if [ "${1:-}" = --inside ]; then
    shift
    slcand -F -o -c -s8 "$VCAN_SERIAL0" slcan0 >&2 &
    trap 'kill $! && wait' EXIT
    for _ in $(seq 300); do [ -e /sys/class/net/slcan0 ] && break || sleep 0.1; done
    ip link set slcan0 txqueuelen 1000 up
    # Half a line that was under way when the line was opened ends with the first frame. A unit in lock step says nothing
    # of itself, and a silent device is for the command to find.
    candump -n 1 -T 3000 slcan0 >/dev/null || true
    first=()
    ! chrt --rr 1 true 2>/dev/null || first=(chrt --rr 1)
    "${first[@]}" "$@"
    exit
fi

options=()
while [ $# -gt 0 ]; do
    case $1 in
    -h | --help) sed -n '2,/^set -/{/^set -/d;s/^# \{0,1\}//;p}' "$0" && exit ;;
    --timeout) options+=("$1" "${2:-}") && shift 2 ;;
    -*) say "no option $1; device-m4.sh --help" && exit 2 ;;
    *) break ;;
    esac
done
[ $# -ge 3 ] && [ "$2" = -- ] || { say "usage: device-m4.sh [OPTION...] IMAGE -- COMMAND [ARG...]; device-m4.sh --help" && exit 2; }
image=$1
shift 2
[ -r "$image" ] || { say "$image: no such file; cargo build --profile firmware --target thumbv7em-none-eabihf --bin holdover-ecu" && exit 2; }
command -v qemu-system-arm >/dev/null || { say "no qemu-system-arm; remedy: apt-get install qemu-system-arm" && exit 77; }

# Hardware waits for no other program, so the emulator comes before others where this user may say so. It stays on one
# processor (the last), because its two threads pass each byte of the line to one another, and to wake another one for that
# takes longer.
first=(taskset -c "$(taskset -cp $$ | sed 's/.*[:,-] *//')")
! chrt --rr 1 true 2>/dev/null || first+=(chrt --rr 1)
words=$(mktemp) line=$(mktemp -u)
# A multiplexer, though there is one reader only: it keeps a few bytes for a receiver that holds one, as the emulator's model of
# this chip does; without it each byte would take two switches between the emulator's threads.
"${first[@]}" qemu-system-arm -M netduinoplus2 -display none -monitor none -kernel "$image" \
    -chardev "socket,id=line,path=$line,server=on,wait=off,mux=on" -serial chardev:line </dev/null >"$words" 2>&1 &
qemu=$!
trap 'kill $qemu 2>/dev/null; wait; rm -f "$words" "$line"' EXIT
for _ in $(seq 300); do [ -S "$line" ] && break || sleep 0.1; done
[ -S "$line" ] || { say "the emulator did not start:" && cat "$words" >&2 && exit 125; }
here=$(dirname "$(realpath "$0")")
"$here/vcan.sh" --real-time "${options[@]}" --serial "$line" -- "$here/device-m4.sh" --inside "$@"
