#!/usr/bin/env bash
# cost.sh [--write]: counts what the core costs on the emulated ECU, and fails where it is more than 5 % worse than cost.csv
# says, or where README.md is not the table of cost.csv. With --write it makes cost.csv and the tables of README.md anew.
#
# Needs qemu-system-arm, a target thumbv7em-none-eabihf for cargo, and `size` of any binutils.
set -euo pipefail
cd "$(dirname "$0")"
export LC_ALL=C

target=thumbv7em-none-eabihf
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cargo build --locked --quiet --profile firmware --target $target -p holdover-image --bin cost
timeout 900 qemu-system-arm -M netduinoplus2 -nographic -monitor none -serial none \
    -semihosting-config enable=on,target=native -icount shift=6,align=off,sleep=off \
    -kernel "${CARGO_TARGET_DIR:-target}/$target/firmware/cost" >"$work/counts" || {
    echo "cost: the program failed in the emulator; its last words:"
    tail -n 5 "$work/counts"
    exit 1
}

# The same program for a bus of CAN FD, which the firmware's boards do not have.
cargo build --locked --quiet --profile firmware --target $target -p holdover-image --bin cost --features fd --target-dir "${CARGO_TARGET_DIR:-target}/fd"
timeout 300 qemu-system-arm -M netduinoplus2 -nographic -monitor none -serial none \
    -semihosting-config enable=on,target=native -icount shift=6,align=off,sleep=off \
    -kernel "${CARGO_TARGET_DIR:-target}/fd/$target/firmware/cost" >>"$work/counts" || {
    echo "cost: the program failed in the emulator over CAN FD; its last words:"
    tail -n 5 "$work/counts"
    exit 1
}

# What a float's exponential and root take, and how far they are off.
cargo build --locked --quiet --profile firmware --target $target -p holdover-image --bin maths
timeout 300 qemu-system-arm -M netduinoplus2 -nographic -monitor none -serial none \
    -semihosting-config enable=on,target=native -icount shift=6,align=off,sleep=off \
    -kernel "${CARGO_TARGET_DIR:-target}/$target/firmware/maths" >>"$work/counts" || {
    echo "cost: the program for a float's functions failed in the emulator; its last words:"
    tail -n 5 "$work/counts"
    exit 1
}

# The firmware without logs: what is in flash (.data lies there too, for the start), and what is in RAM for good. In a folder of its own,
# because scripts/firmware.sh builds other forms of it meanwhile.
ecu=$(realpath -m "${CARGO_TARGET_DIR:-target}/ecu")
(cd ../.. && cargo build --locked --quiet --profile firmware --target $target --bin holdover-ecu --target-dir "$ecu")
size -A "$ecu/$target/firmware/holdover-ecu" | awk '
    $1 == ".vector_table" || $1 == ".text" || $1 == ".rodata" || $1 == ".data" { flash += $2 }
    $1 == ".data" || $1 == ".bss" || $1 == ".uninit" { ram += $2 }
    END { print "flash 8 400", flash; print "ram 8 400", ram }' >>"$work/counts"
{
    echo name,peers,steps,count
    tr ' ' , <"$work/counts"
} >"$work/cost.csv"

# limits COUNTS: the figures that have a limit, as `what|limit|figure|how close`.
limits() {
    awk -F, -v OFS='|' '
        { count[$1 "," $2 "," $3] = $4 }
        function at(name, steps) { return count[name ",8," (steps ? steps : 400)] }
        function most(name, i, kinds, count) {
            count = 0
            for (i = split("both sensor terse all", kinds, " "); i > 0; i--) { if (at(kinds[i] "-" name, 359) > count) count = at(kinds[i] "-" name, 359) }
            return count
        }
        function row(what, limit, figure) {
            print what, limit, figure, figure <= limit ? "met" : sprintf("missed by %.0f %%", (figure / limit - 1) * 100)
        }
        END {
            fixed = count["step-fixed,1,400"]; single = count["step-f32,1,400"]; double = count["step-f64,1,400"]
            row("quiet tick, no intersection, instructions", 6000, at("quiet"))
            row("quiet tick at an intersection, with envelope and range sensor, instructions", 9000, most("quiet"))
            row("worst tick, 400 steps, no intersection, instructions", 240000, at("horizons") > at("late") ? at("horizons") : at("late"))
            row("worst tick of all below, 359 steps, instructions", 240000, most("worst"))
            row("worst `receive`, classic CAN, at most one view in a period, instructions", 6000, most("receive"))
            row("per vehicle and step, with feed-forward, instructions", 60, sprintf("%.1f", (at("send") - at("send", 100)) / 300))
            row("flash without logs, bytes", 65536, at("flash"))
            row("static RAM, bytes", 49152, at("ram"))
            row("deepest stack, bytes", 4096, at("both-stack", 359) > at("stack") ? at("both-stack", 359) : at("stack"))
            row("a follower'\''s step against f32 on the FPU", 1.5, sprintf("%.2f", fixed / single))
            row("a follower'\''s step against f64", 1, sprintf("%.3f", fixed / double))
        }' "$1"
}

# readme COUNTS: README.md with the tables of these counts.
readme() {
    tables "$1" >"$work/tables"
    awk -v tables="$work/tables" '
        /<!-- tables -->/ { print; while ((getline line < tables) > 0) print line; inside = 1 }
        /<!-- end -->/ { inside = 0 }
        !inside && !/<!-- tables -->/ { print }' README.md
}

tables() {
    echo
    echo '| figure, for 8 peers and 400 steps | limit | measured | |'
    echo '|---|--:|--:|---|'
    limits "$1" | sed 's/|/ | /g; s/.*/| & |/'
    echo
    echo '| peers | steps | quiet tick | one peer new | send tick | worst, models | worst, horizons | samples of 2 s ago | `receive`, worst | mean | start | unit, bytes | stack, bytes |'
    echo '|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|'
    awk -F, '
        $1 == "quiet" { order[++n] = $2 "," $3 }
        { count[$1 "," $2 "," $3] = $4 }
        END {
            for (i = 1; i <= n; i++) {
                split(order[i], key, ",")
                printf "| %d | %d |", key[1], key[2]
                m = split("quiet one send all horizons late receive receive-mean start unit stack", names, " ")
                for (j = 1; j <= m; j++) printf " %d |", count[names[j] "," order[i]]
                print ""
            }
        }' "$1"
    echo
    echo '| a drive, 8 peers, 359 steps of 30 ms | bare | envelope | map | both | envelope, range sensor | the same, a terse target | all three |'
    echo '|---|--:|--:|--:|--:|--:|--:|--:|'
    awk -F, '
        { count[$1 "," $2 "," $3] = $4 }
        function row(what, name, figure, i) {
            for (i = 1; i <= 7; i++) { figure = figure " | " count[kinds[i] "-" name ",8,359"] }
            print "| " what figure " |"
        }
        END {
            split("bare envelope map both sensor terse all", kinds, " ")
            row("quiet tick", "quiet")
            row("the tick of the review, no news", "review")
            row("send tick, no news", "send")
            row("send tick, all peers new", "all")
            row("the same, with their horizons", "horizons")
            row("seconds 4 to 6 with horizons, 135 drives", "first")
            row("such seconds with an opened time gap", "opened")
            row("passes of 20 stations", "passes")
            row("samples of 0.3 s ago", "late-0.3")
            row("samples of 3 s ago, after a silence", "late-3")
            row("these in two ticks in a row", "late-twice")
            row("horizons behind samples of 0.31 s ago, twice", "horizons-twice")
            row("of the admitted maximum", "late-most")
            row("everything at once", "together")
            row("the same after 3 s without a tick", "pause")
            row("worst of these", "worst")
            row("`receive`, worst", "receive")
            row("40 frames, a full bus in a period", "bus")
            row("stack, bytes", "stack")
        }' "$1"
    echo
    echo '| the frames of one peer in 100 ms, of 8 | instructions of `receive` | |'
    echo '|---|--:|--:|'
    awk -F, '
        $1 == "peer" { classic = $4; printf "| classic CAN: 7.6 frames | %d | 1.00 |\n", $4 }
        $1 == "peer-fd" { printf "| CAN FD: 1 frame | %d | %.2f |\n", $4, $4 / classic }' "$1"
    echo
    echo '| one step of one vehicle | instructions | |'
    echo '|---|--:|---|'
    awk -F, '
        function row(what, count) { printf "| %s | %.1f | %.2f |\n", what, count / 400, count / fixed }
        $1 == "step-fixed" { fixed = $4; row("follower, the core (fixed point)", $4) }
        $1 == "step-f32" { row("follower, `f32` on the FPU", $4) }
        $1 == "step-f64" { row("follower, `f64` in software", $4) }
        $1 == "step-kalman" { row("Kalman filter with constant acceleration, `f32` (`minikalman`)", $4) }' "$1"
    echo
    echo '| a function of a float | instructions | largest error |'
    echo '|---|--:|--:|'
    awk -F, '
        { count[$1] = $4 }
        function row(what, name) { printf "| %s | %d | %.1e |\n", what, count[name], (count[name "-error"] + 1) / 1e9 }
        END {
            row("`e^(-δt/T)` and what it stands in, the core", "exp-fixed")
            row("the same, `f32` with `micromath`", "exp-micromath")
            row("root, `f32` with `micromath`, relative", "sqrt-micromath")
        }' "$1"
    echo
    echo '| a follower after 4 s, `f32` against `f64` | apart, mm |'
    echo '|---|--:|'
    awk -F, '
        function row(what, micrometres) { printf "| %s | %.2f |\n", what, micrometres / 1000 }
        $1 == "place-f32-near" { row("at the origin", $4) }
        $1 == "place-f32-far" { row("5 km from it", $4) }' "$1"
    echo
}

limits "$work/cost.csv" | awk -F'|' '{ printf "  %-86s %10s of %8s  %s\n", $1, $3, $2, $4 }'

if [ "${1:-}" = --write ]; then
    cp "$work/cost.csv" cost.csv
    readme cost.csv >"$work/README.md"
    cp "$work/README.md" README.md
    echo "cost: cost.csv and README.md written"
    exit
fi

awk -F, '
    NR == FNR { old[$1 "," $2 "," $3] = $4; next }
    FNR > 1 && !(($1 "," $2 "," $3) in old) { print "cost: " $1 " for " $2 " peers and " $3 " steps is not in cost.csv"; bad = 1 }
    FNR > 1 && $4 > 1.05 * old[$1 "," $2 "," $3] {
        printf "cost: %s for %d peers and %d steps: %d, was %d\n", $1, $2, $3, $4, old[$1 "," $2 "," $3]
        bad = 1
    }
    END { exit bad }' cost.csv "$work/cost.csv" || {
    echo "cost: more than 5 % worse than cost.csv; if that is meant, tests/embedded/cost.sh --write writes it anew"
    exit 1
}
readme cost.csv | diff README.md - || {
    echo "cost: the tables of tests/embedded/README.md are not those of cost.csv (above); cost.sh --write writes both anew"
    exit 1
}
