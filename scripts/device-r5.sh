#!/usr/bin/env bash
# device-r5.sh [OPTION...] IMAGE [QEMU OPTION...]
#
# The firmware on a Cortex-R5F in the emulator (QEMU's `xlnx-zcu102`, a ZynqMP), its CAN controller on a CAN interface of
# this kernel: what it sends is on `vcan0`, and what is on `vcan0` it receives. Runs until it is ended.
#
#   --can NAME    the interface (default: vcan0)
#   -h, --help    this text
#
# Where the machine has no vcan0:  scripts/vcan.sh sh -c 'scripts/device-r5.sh IMAGE & candump -n 20 vcan0; kill $!'
# The image:                       cargo build --profile firmware --target armv7r-none-eabihf --bin holdover-ecu
#
# Exit code: QEMU's; 2 wrong usage; 77 no QEMU here. The program becomes QEMU's process, so to end it is to cut the power.
set -euo pipefail

say() { echo "device-r5: $*" >&2; }

can=vcan0
while [ $# -gt 0 ]; do
    case $1 in
    -h | --help) sed -n '2,/^set -/{/^set -/d;s/^# \{0,1\}//;p}' "$0" && exit ;;
    --can) can=${2:-} && shift 2 ;;
    -*) say "no option $1; device-r5.sh --help" && exit 2 ;;
    *) break ;;
    esac
done
[ $# -gt 0 ] || { say "no image; device-r5.sh --help" && exit 2; }
image=$1
shift
[ -r "$image" ] || { say "$image: no such file; cargo build --profile firmware --target armv7r-none-eabihf --bin holdover-ecu" && exit 2; }
[ -e "/sys/class/net/$can" ] || { say "no CAN interface $can; scripts/vcan.sh runs a command where there is one" && exit 2; }
command -v qemu-system-aarch64 >/dev/null || { say "no qemu-system-aarch64; remedy: apt-get install qemu-system-arm" && exit 77; }

# Flash memories that the machine has and nobody uses; without contents, or QEMU fills 258 MB at its start.
flash=()
for size in 0:1M 1:1M 2:64M 3:64M 4:64M 5:64M; do
    flash+=(-drive "if=mtd,index=${size%:*},driver=null-co,read-zeroes=off,size=${size#*:}")
done

# QEMU starts every core but the first one powered off. The R5 is switched on from outside, as the chip's boot loader does.
power_on='{"execute": "qmp_capabilities"}
{"execute": "qom-set", "arguments": {"path": "/machine/soc/rpu-cluster/rpu-cpu[0]", "property": "start-powered-off", "value": false}}
{"execute": "system_reset"}
{"execute": "cont"}'

# One thread for all cores, because one processor is what user-mode Linux has. The four application cores stay off.
exec qemu-system-aarch64 -accel tcg,thread=single,tb-size=16 -M xlnx-zcu102,canbus0=can0 -smp 5 -S \
    -display none -audiodev none,id=none -serial none -monitor none "${flash[@]}" \
    -global 'xlnx-zynqmp.boot-cpu=rpu-cpu[0]' -device "loader,file=$image,cpu-num=4" \
    -object can-bus,id=can0 -object "can-host-socketcan,id=host,if=$can,canbus=can0" \
    -qmp stdio "$@" <<<"$power_on" >/dev/null
