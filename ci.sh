#!/usr/bin/env bash
# ci.sh: everything that has to hold, as one script with named steps. `./ci.sh --help` lists them.
#
# A step that cannot run on this machine says why and counts as skipped; where CI=true is set, it counts as failed.
# The last line is always the count: `N passed, N failed, N skipped`.
set -euo pipefail
cd "$(dirname "$0")"

target=thumbv7em-none-eabihf
image=${CARGO_TARGET_DIR:-target}/$target/firmware/holdover-ecu
steps=(fmt lint doc test dbc study live reports data cross tasks firmware vcan c package release)
skipped=77 # exit code of a step that cannot run here
command -v rustup >/dev/null || PATH=${CARGO_HOME:-$HOME/.cargo}/bin:$PATH
export CARGO_TERM_COLOR=${CARGO_TERM_COLOR:-never}

usage() {
    cat <<'TEXT'
usage: ./ci.sh [STEP...]      (no step: all of them, in this order)

  fmt       every file is formatted
  lint      no warning of the compiler or of clippy; unsafe code only in src/board/, at the edge of holdover-c and in tests/embedded/
  doc       documentation without a warning; each source file opens with what it does, and has at most 400 lines
  test      unit, property, integration and documentation tests, with overflow checks
  dbc       the DBC files as cantools and canmatrix read them: without a warning, and the same as DBC, KCD, SYM and ARXML
  study     the verdicts of the case study: the four intersections for ten minutes, with the figures that docs/RESULTS.md has, and
            the worst link of the string of ten
  live      the page of `live` in a browser without a screen: it drives, breaks links and goes back in time; pictures in target/live
  reports   the reports of every command in that browser at two widths, light and dark, and printed: nothing is cut off, values,
            zoom and map work, and the console is quiet; pictures in target/reports
  data      the converters of public recordings on small files in the published formats; the notebooks of docs/notebooks run to
            their ends, with figures in target/notebooks
  cross     the core with `core` alone for Cortex-M0, M4F, M33 and RISC-V; the firmware, and what it takes of its memory
  tasks     the unit as a task of RTIC and of Embassy compiles and links, by locked versions
  firmware  the firmware in every form, without a panic, in the emulator: replayed logs bit for bit, and what it costs
  vcan      hardware in the loop on a CAN interface of Linux: the SocketCAN tests, and the paper's scenario against the unit as
            a process, on an emulated Cortex-M4F, and on an emulated Cortex-R5F with a CAN controller; the first node, a
            program in Python, against the process and the Cortex-M4F; scripts/hil.sh runs parts
  c         the C examples say what the Rust core says, on the host and in the emulator, over the whole way of the corridor's ego
            too; the header is one for C99, C11, C++ and MISRA C, for each capacity
  package   the package that would be published builds by itself and holds what it should
  release   an archive of the simulator for x86-64, built without optimisation, runs in a folder with nothing else in it;
            scripts/release.sh makes those of a release

exit code: 0 all passed; 1 a step failed; 2 no such step
TEXT
}

skip() {
    echo "SKIPPED: $*"
    exit "$skipped"
}

step_fmt() {
    cargo fmt --all --check
    cargo fmt --all --check --manifest-path tests/embedded/Cargo.toml
    cargo fmt --check --manifest-path examples/rtic/Cargo.toml
    cargo fmt --check --manifest-path examples/embassy/Cargo.toml
}

step_lint() {
    cargo clippy --locked --workspace --all-targets -- -D warnings
    cargo clippy --locked -p holdover --lib --features defmt -- -D warnings
    local outside unsafe='^src/board/|^tests/embedded/|^holdover-c/(src/(doors|map|memory|panic|pointer|room)\.rs|tests/)'
    outside=$(source_files | grep -vE "$unsafe" | xargs grep -nE '\bunsafe\s*(\{|fn|impl|extern)' || true)
    [ -z "$outside" ] || {
        printf 'unsafe code where there is to be none:\n%s\n' "$outside"
        return 1
    }
}

step_doc() {
    local bad=0 file first lines
    while read -r file; do
        first=$(head -c 3 "$file")
        lines=$(wc -l <"$file")
        [ "$first" = '//!' ] || { echo "$file: has to open with //! and what it does" && bad=1; }
        [ "$lines" -le 400 ] || { echo "$file: $lines lines, of at most 400; split it by concept" && bad=1; }
    done < <(source_files)
    RUSTDOCFLAGS='-D warnings' cargo doc --locked --no-deps --workspace
    [ "$bad" = 0 ]
}

step_test() {
    cargo test --locked --workspace --profile checked --no-fail-fast
}

step_dbc() {
    source scripts/need.sh
    local python=${CARGO_TARGET_DIR:-target}/python
    mkdir -p "$python"
    need_python "$python" scripts/dbc-requirements.txt
    "$python/bin/python" scripts/dbc_check.py holdover.dbc holdover-fd.dbc
}

step_study() {
    source scripts/need.sh
    need python3 python3
    need_programs
    local sim=$programs/holdover-sim results=${CARGO_TARGET_DIR:-target}/corridor.json
    "$sim" run corridor --no-report --json >"$results"
    python3 scripts/documented_corridor.py docs/RESULTS.md "$results"
    "$sim" string --delays 0.2 --losses 0.4 --step-only --seeds 20 --no-report
}

step_live() {
    scripts/live.sh
}

step_reports() {
    scripts/reports.sh
}

step_data() {
    scripts/data.sh
}

step_cross() {
    local bin sizes unit
    bin=$(scripts/install-target.sh "$target") || skip "no standard library for $target can be had on this machine"
    PATH=$bin:$PATH
    # No target is privileged in the core: without an FPU, without a wide multiply, another instruction set.
    local other
    for other in thumbv6m-none-eabi thumbv8m.main-none-eabihf riscv32imac-unknown-none-elf; do
        if PATH=$(scripts/install-target.sh "$other"):$PATH; then
            cargo build --locked --profile firmware --target "$other" --lib
        else
            skip "no standard library for $other can be had on this machine"
        fi
    done
    cargo build --locked --profile firmware --target "$target" --lib
    cargo build --locked --profile firmware --target "$target" --bin holdover-ecu
    # The host's binutils read any ELF file. A linker for the host is always there, and they with it.
    sizes=$(size -A "$image")
    echo
    echo "$image, bytes:"
    for section in .vector_table .text .rodata .data .bss; do
        printf '  %-28s %7d\n' "$section" "$(awk -v name=$section '$1 == name { print $2 }' <<<"$sizes")"
    done
    # The firmware keeps its unit in a static of that name, and the symbol tells the size: 8 peers, 400 steps.
    unit=$(readelf --syms --wide "$image" | awk '$4 == "OBJECT" && $8 ~ /4UNIT(17h|$|E)/ { print $3 }')
    [ -n "$unit" ] || {
        echo "no static UNIT in the image, so the size of the unit is not known"
        return 1
    }
    printf '  %-28s %7d of at most 65536\n' 'OnboardUnit<8, 8, 400>' "$unit"
    [ "$unit" -le 65536 ]
    cargo clippy --locked --profile firmware --target "$target" -- -D warnings
    HOLDOVER_BOARD=nucleo_g474re cargo clippy --locked --profile firmware --target "$target" --bin holdover-ecu --features bxcan -- -D warnings
}

step_tasks() {
    local bin tasks example
    bin=$(scripts/install-target.sh "$target") || skip "no standard library for $target can be had on this machine"
    PATH=$bin:$PATH
    # They have most of their dependencies in common.
    tasks=$(realpath -m "${CARGO_TARGET_DIR:-target}/tasks")
    for example in rtic embassy; do
        (
            cd "examples/$example"
            export CARGO_TARGET_DIR=$tasks
            cargo clippy --locked --release --target "$target" -- -D warnings
            cargo build --locked --release --target "$target"
            size "$tasks/$target/release/holdover-$example"
        )
    done
}

step_firmware() {
    scripts/firmware.sh
}

step_vcan() {
    scripts/hil.sh
}

step_c() {
    holdover-c/check.sh
}

step_package() {
    local dirty=() contents wanted=0 name
    if [ "${CI:-}" != true ] && [ -n "$(git status --porcelain 2>/dev/null)" ]; then
        echo "note: the working tree has changes, and they are packaged as they are"
        dirty=(--allow-dirty)
    fi
    contents=$(cargo package --locked -p holdover --list "${dirty[@]}")
    for name in Cargo.toml README.md ARCHITECTURE.md CHANGELOG.md LICENSE-MIT LICENSE-APACHE holdover.dbc build.rs \
        src/lib.rs src/main.rs src/board/mod.rs \
        src/board/stm32f405/memory.x src/board/stm32g474/memory.x src/board/zynqmp_r5/link.x; do
        grep -qxF "$name" <<<"$contents" || { echo "the package lacks $name" && wanted=1; }
    done
    if grep -E '^(host-sim|holdover-c|scripts|\.ci|target)/|^ci\.sh$' <<<"$contents"; then
        echo "the package holds files that are not part of it (above)"
        wanted=1
    fi
    [ "$wanted" = 0 ]
    cargo publish --dry-run --locked -p holdover "${dirty[@]}"
    wc -l <<<"$contents" | xargs printf '%d files in the package\n'
}

step_release() {
    scripts/release.sh --quick x86_64-unknown-linux-musl
}

# Every source file that is ours.
source_files() {
    find src host-sim holdover-c tests examples build.rs -name '*.rs' -not -path '*/target/*' 2>/dev/null | sort
}

# A step runs as a process of its own (`--one`), so that its first failing command ends it and nothing of it reaches the next.
if [ "${1:-}" = --one ]; then
    "step_$2"
    exit
fi

case "${1:-}" in
-h | --help)
    usage
    exit
    ;;
esac
for name in "$@"; do
    if [[ " ${steps[*]} " != *" $name "* ]]; then
        echo "ci.sh: no step '$name'" >&2
        usage >&2
        exit 2
    fi
done
[ $# -gt 0 ] && steps=("$@")

passed=0 failed=0 not_run=0 summary= ends=
logs=$(mktemp -d)
trap 'rm -rf "$logs"' EXIT
exec 2>&1 # one stream, so that a log keeps the order
scripts/install-rust.sh || true # what is missing then fails its steps, by name
for name in "${steps[@]}"; do
    printf '\n==> %s\n' "$name"
    started=$SECONDS
    code=0
    exec 3> >(tee "$logs/$name")
    bash "$PWD/ci.sh" --one "$name" >&3 2>&3 3>&- || code=$?
    exec 3>&-
    # Waits for the end of its output, for 10 s at most: a program that the step left behind keeps it open.
    timeout 10 tail --pid=$! -s 0.1 -f /dev/null || true
    if [ "$code" = 0 ]; then
        verdict=passed passed=$((passed + 1))
    elif [ "$code" = "$skipped" ] && [ "${CI:-}" != true ]; then
        verdict=SKIPPED not_run=$((not_run + 1))
    elif [ "$code" = "$skipped" ]; then
        verdict='FAILED (skipped, which CI does not allow)' failed=$((failed + 1))
    else
        verdict="FAILED (exit code $code)" failed=$((failed + 1))
    fi
    # Where only the end of a long log is kept, this is what says why.
    [[ "$verdict" != FAILED* ]] || ends+=$(printf '\n==> the end of %s, which failed\n' "$name" && tail -n 30 "$logs/$name")$'\n'
    summary+=$(printf '%-8s %4d s  %s' "$name" $((SECONDS - started)) "$verdict")$'\n'
done

printf '%s\n==> summary\n%s%d passed, %d failed, %d skipped\n' "$ends" "$summary" "$passed" "$failed" "$not_run"
[ "$failed" = 0 ]
