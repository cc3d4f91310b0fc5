#!/usr/bin/env bash
# probe.sh IMAGE [OPTION...]: flashes an image of the firmware onto the board that HOLDOVER_BOARD names, by a debug probe, and
# shows its log until Ctrl-C. `cargo run --target thumbv7em-none-eabihf` calls it (.cargo/config.toml). Options are those of
# `probe-rs run`.
set -euo pipefail

case ${HOLDOVER_BOARD:-stm32f405} in
stm32f405 | feather_stm32f405 | pyboard) chip=STM32F405RGTx ;;
nucleo_g474re) chip=STM32G474RETx ;;
*)
    echo "probe.sh: HOLDOVER_BOARD=$HOLDOVER_BOARD cannot be flashed by probe-rs; docs/BOARDS.md says how" >&2
    exit 2
    ;;
esac
[ $# -ge 1 ] || {
    echo "usage: probe.sh IMAGE [OPTION...]" >&2
    exit 2
}
command -v probe-rs >/dev/null || {
    echo "probe.sh: probe-rs is not there; \`cargo install probe-rs-tools --locked\` installs it" >&2
    exit 2
}
exec probe-rs run --chip "$chip" "$@"
