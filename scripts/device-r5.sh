#!/usr/bin/env bash
# device-r5.sh [OPTION...] IMAGE [-- COMMAND [ARG...]]
#
# Runs a command beside the firmware on a Cortex-R5F in the emulator (QEMU's `xlnx-zcu102`, a ZynqMP), whose CAN controller
# is on a CAN interface of this kernel: what it sends is on `vcan0`, and what is on `vcan0` it receives. Where there is no
# vcan0, everything runs in user-mode Linux. The exit status is the command's. Without a command, only the device runs, on
# an interface that is there, until it is ended; the process is then QEMU's, so to end it is to cut the device's power.
#
#   --can NAME     the interface (default: vcan0)
#   --timeout S    end both after S seconds (default: 600)
#   --uml          use user-mode Linux even where the machine has vcan (see vcan.sh)
#   -h, --help     this text
#
# The image:  cargo build --profile firmware --target armv7r-none-eabihf --bin holdover-ecu
# Example:    scripts/device-r5.sh target/armv7r-none-eabihf/firmware/holdover-ecu -- candump -n 20 vcan0
#
# Exit code: the command's; 2 wrong usage; 77 no QEMU or no vcan here; 124 the time was up; 125 the device did not start.
set -euo pipefail

say() { echo "device-r5: $*" >&2; }

can=vcan0 vcan=() inside=false
while [ $# -gt 0 ]; do
    case $1 in
    -h | --help) sed -n '2,/^set -/{/^set -/d;s/^# \{0,1\}//;p}' "$0" && exit ;;
    --can) can=${2:-} && shift 2 ;;
    --timeout) vcan+=("$1" "${2:-}") && shift 2 ;;
    --uml) vcan+=("$1") && shift ;;
    --inside) inside=true && shift ;;
    -*) say "no option $1; device-r5.sh --help" && exit 2 ;;
    *) break ;;
    esac
done
[ $# = 1 ] || { [ $# -ge 3 ] && [ "$2" = -- ]; } ||
    { say "usage: device-r5.sh [OPTION...] IMAGE [-- COMMAND [ARG...]]; device-r5.sh --help" && exit 2; }
image=$1
[ -r "$image" ] || { say "$image: no such file; cargo build --profile firmware --target armv7r-none-eabihf --bin holdover-ecu" && exit 2; }
command -v qemu-system-aarch64 >/dev/null || { say "no qemu-system-aarch64; remedy: apt-get install qemu-system-arm" && exit 77; }
here=$(dirname "$(realpath "$0")")

if [ $# -gt 1 ]; then
    shift 2
    [ $inside = true ] || exec "$here/vcan.sh" --real-time "${vcan[@]}" -- "$here/device-r5.sh" --inside --can "$can" "$image" -- "$@"
    "$here/device-r5.sh" --can "$can" "$image" &
    device=$!
    trap 'kill $device 2>/dev/null; wait' EXIT
    # It boots in two seconds. A unit in lock step says nothing of itself, and a silent device is for the command to find.
    candump -n 1 -T 3000 "$can" >/dev/null || true
    kill -0 $device 2>/dev/null || { say "the device did not start" && exit 125; }
    # Both come before everything else, and neither before the other: each rests when it has nothing to do. An emulator that comes
    # second is interrupted at each of its frames by who hears them, and misses periods; its threads wait for one another in
    # loops, so that none of them may come before another one.
    first=()
    if chrt --rr 1 true 2>/dev/null; then chrt --rr -a -p 1 $device && first=(chrt --rr 1); fi
    "${first[@]}" "$@"
    exit
fi
[ -e "/sys/class/net/$can" ] || { say "no CAN interface $can; scripts/vcan.sh runs a command where there is one" && exit 2; }

# Flash memories that the machine has and nobody uses; without contents, or QEMU fills 258 MB at its start.
flash=()
for size in 0:1M 1:1M 2:64M 3:64M 4:64M 5:64M; do
    flash+=(-drive "if=mtd,index=${size%:*},driver=null-co,read-zeroes=off,size=${size#*:}")
done

# QEMU starts every core but the first one powered off. The R5 is switched on from outside, as the chip's boot loader does. The model
# has no interrupt controller for this core: a timer is wired to it as IRQ, and the CAN controller as FIQ, to wake it when it sleeps.
power_on='{"execute": "qmp_capabilities"}
{"execute": "qom-set", "arguments": {"path": "/machine/soc/rpu-cluster/rpu-cpu[0]", "property": "start-powered-off", "value": false}}
{"execute": "qom-set", "arguments": {"path": "/machine/soc/ttc[0]", "property": "sysbus-irq[0]", "value": "/machine/soc/rpu-cluster/rpu-cpu[0]/unnamed-gpio-in[0]"}}
{"execute": "qom-set", "arguments": {"path": "/machine/soc/can[0]", "property": "sysbus-irq[0]", "value": "/machine/soc/rpu-cluster/rpu-cpu[0]/unnamed-gpio-in[1]"}}
{"execute": "system_reset"}
{"execute": "cont"}'

# One thread for all cores, because one processor is what user-mode Linux has. The four application cores stay off.
exec qemu-system-aarch64 -accel tcg,thread=single,tb-size=16 -M xlnx-zcu102,canbus0=can0 -smp 5 -S \
    -display none -audiodev none,id=none -serial none -monitor none "${flash[@]}" \
    -global 'xlnx-zynqmp.boot-cpu=rpu-cpu[0]' -device "loader,file=$image,cpu-num=4" \
    -object can-bus,id=can0 -object "can-host-socketcan,id=host,if=$can,canbus=can0" \
    -qmp stdio <<<"$power_on" >/dev/null
