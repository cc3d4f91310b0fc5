#!/usr/bin/env bash
# hil.sh [CHECK...]: hardware in the loop on a real CAN interface of Linux. `./ci.sh vcan` runs all of it:
#
#   kernel   vcan.sh gives a command a vcan0, and keeps what it says of exit code, output and time
#   tests    the simulator's tests that need a SocketCAN interface; one in real time that fails is asked again, as below, if this machine
#            kept a processor from it
#   ecu      the paper's scenario against the unit as a process of Linux, in real time over CAN FD and with identifiers of 29 bits, with these
#            in lock step too; the tests have the other ways
#   m4       the same against the firmware on an emulated Cortex-M4F, over Linux's slcan
#   r5       the same against the firmware on an emulated Cortex-R5F, whose CAN controller is on vcan0
#   node     the first node, a Python program that knows the DBC alone, against the process, over classic CAN and CAN FD, and the
#            emulated Cortex-M4F. The emulated boards' controllers have classic CAN alone
#
# Where a command gets a kernel of its own, two run at once, each with its own vcan0, and the images are built meanwhile: a bus leaves
# the processor idle for most of the time.
#
# Exit code 77: something that it needs is not there, and cannot be had.
set -euo pipefail
cd "$(dirname "$0")/.."

built=$(realpath -m "${CARGO_TARGET_DIR:-target}")
work=$built/hil
export CARGO_TERM_COLOR=${CARGO_TERM_COLOR:-never}

source scripts/need.sh

# expect WANTED COMMAND...: the command ends with that exit code.
expect() {
    local wanted=$1 code=0
    shift
    "$@" || code=$?
    [ "$code" = "$wanted" ] || { echo "exit code $code instead of $wanted: $*" && return 1; }
}

check_kernel() {
    local out=$work/kernel
    expect 7 scripts/vcan.sh bash -c 'candump -n 1 vcan0 & sleep 0.3; cansend vcan0 123#DEADBEEF; wait; pwd; echo "$0 $1" >&2; exit 7' \
        "two  words" "a 'quote'" >"$out.out" 2>"$out.err"
    diff <(printf '  vcan0  123   [4]  DE AD BE EF\n%s\n' "$PWD") "$out.out"
    diff <(echo "two  words a 'quote'") "$out.err"
    # What the consoles of user-mode Linux are slow to take is not lost when it ends.
    diff <(scripts/vcan.sh seq 100000 | md5sum) <(seq 100000 | md5sum)
    expect 124 scripts/vcan.sh --timeout 4 sleep 60
    expect 127 scripts/vcan.sh no-such-command
    expect 2 scripts/vcan.sh --serial /dev/no-such-line true
    echo "  a frame on vcan0, exit codes, output apart, 588,895 bytes without loss, time limit"
}

# both COMMAND COMMAND...: all of them at once, where each has a kernel of its own; what each says comes in order, after its end.
both() {
    local command job=0 jobs=() code=0
    for command; do
        if [ "$own_kernel" = yes ]; then
            $command >"$work/both.$job" 2>&1 &
            jobs+=($!)
        else
            $command || code=$?
        fi
        job=$((job + 1))
    done
    for job in "${!jobs[@]}"; do
        wait "${jobs[$job]}" || code=$?
        cat "$work/both.$job"
    done
    return $code
}

# images TARGET: the firmware in both forms, as $work/TARGET-real-time and $work/TARGET-lock-step, as far as it is not built yet.
images() {
    if [ -n "${building:-}" ]; then
        wait "$building" || true
        cat "$work/images"
        building=
    fi
    [ -e "$work/$1-lock-step" ] || build_images "$1"
}

build_images() {
    local bin form
    bin=$(scripts/install-target.sh "$1") || skip "no standard library for $1 can be had on this machine"
    for form in real-time lock-step; do
        local firmware=(--locked --quiet --profile firmware --target "$1" --bin holdover-ecu --features "${form/real-time/}")
        PATH=$bin:$PATH cargo clippy "${firmware[@]}" -- -D warnings
        PATH=$bin:$PATH cargo build "${firmware[@]}"
        cp "$built/$1/firmware/holdover-ecu" "$work/$1-$form"
    done
}

# judge INTERFACE ARGUMENT...: the command line of the harness. The firmware is a car of station 1.
judge() {
    local bus=$1
    shift
    harness=("$sim" hil --bus "$bus" --station 1 "$@")
}

# Looks every 5 ms at how late it is woken, though it comes before all other programs, and writes down the largest lateness in
# milliseconds when it is ended.
look='use Time::HiRes "time"; my ($caller, $end, $largest) = (getppid, 0, 0); $SIG{TERM} = sub { $end = 1 };
    until ($end or getppid != $caller) {
        my $due = time + 0.005;
        select undef, undef, undef, 0.005;
        $largest = time - $due if time - $due > $largest;
    }
    printf "%.0f\n", 1000 * $largest'

# One such for each processor that this may use; none where nothing may come before other programs.
look_out() {
    local part cpu
    lookers=()
    rm -rf "$withheld" && mkdir -p "$withheld"
    chrt --rr 3 perl -MTime::HiRes -e 1 2>/dev/null || return 0
    for part in $(taskset -cp $$ | sed 's/.*: //; s/,/ /g'); do
        for cpu in $(seq "${part%-*}" "${part#*-}"); do
            taskset -c "$cpu" chrt --rr 3 perl -e "$look" >"$withheld/$cpu" &
            lookers+=($!)
        done
    done
}

# Ends them: for how many milliseconds a processor was withheld at most, as far as is known, is in `most` then.
look_back() {
    most=0
    [ ${#lookers[@]} -gt 0 ] || return 0
    kill "${lookers[@]}" 2>/dev/null || true
    wait "${lookers[@]}" || true
    most=$(sort -n "$withheld"/* | tail -1)
    most=${most:-0}
}

# conclude COMMAND...: the verdict of a run in real time. Of a device that is a process or emulated, a failure says nothing if
# this machine kept a processor from its programs for half a period: then it is asked again, as after a verdict of
# "inconclusive": beside nothing else of this script, and after a pause, since what else a machine has to do often passes.
conclude() {
    local attempt code most why turn lookers withheld=$work/withheld.$BASHPID
    exec {turn}>"$work/turn"
    for attempt in {1..8}; do
        if [ "$attempt" = 1 ]; then
            flock --shared "$turn"
        else
            sleep $((5 * attempt))
            flock --exclusive "$turn"
        fi
        look_out
        code=0
        "$@" || code=$?
        look_back
        flock --unlock "$turn"
        case $code in
        3) why="the harness was late itself" ;;
        1) why="this machine kept a processor from its programs for $most ms at once" && [ "$most" -ge 5 ] || break ;;
        *) break ;;
        esac
        code=3
        echo "attempt $attempt of 8 says nothing: $why"
    done
    exec {turn}>&-
    return $code
}

test_binaries() {
    cargo test --locked --profile checked --workspace --test 'vcan_*' --no-run --message-format json |
        grep '"kind":\["test"\]' | sed -n 's/.*"executable":"\([^"]*\)".*/\1/p'
}

# tests FILE: the tests whose names it has, which has those that failed afterwards.
tests() {
    local code=0
    # A test's own folder is its package's. One at a time, because they share the bus.
    scripts/vcan.sh --real-time --timeout 1800 bash -c 'cd host-sim
        mapfile -t names <"$1" && shift
        code=0
        for binary; do "$binary" --ignored --exact --test-threads 1 "${names[@]}" || code=1; done
        exit $code' tests "$1" "${binaries[@]}" 2>&1 | tee "$1.said" || code=$?
    sed -n 's/^    \([a-z0-9_]*\)$/\1/p' "$1.said" | sort -u >"$1"
    # In lock step no lateness explains a failure; and where no test failed, something else did.
    if [ "$code" = 1 ] && { [ ! -s "$1" ] || grep -q in_lock_step "$1"; }; then return 101; fi
    return "$code"
}

# shard NUMBER: every second one of the tests, from that one on.
shard() {
    local names=$work/names.$1 binary
    for binary in "${binaries[@]}"; do "$binary" --ignored --list --format terse; done |
        sed -n "s/: test$//p" | awk "NR % 2 == $1" >"$names"
    conclude tests "$names"
}

check_tests() {
    local binaries
    # Built outside: user-mode Linux has one processor.
    mapfile -t binaries < <(test_binaries)
    [ ${#binaries[@]} -gt 0 ] || { echo "no test of holdover-sim needs vcan0" && return 1; }
    both "shard 0" "shard 1"
}

# in_real_time fd|placed: a process of Linux, over CAN FD, or with identifiers of its own.
in_real_time() {
    local options=(--fd) words=--fd bus='CAN FD'
    if [ "$1" = placed ]; then
        options=(--identifiers "$work/identifiers") words="--identifiers '$work/identifiers'" bus=$placed
    fi
    echo "-- a process of Linux, real time, $bus"
    judge vcan0 "${options[@]}"
    conclude scripts/vcan.sh --real-time "${harness[@]}" --device "'$sim' ecu --bus vcan0 --station 1 $words"
}

check_ecu() {
    local placed='identifiers of 11 and 29 bits, placed one by one'
    # As in a vehicle whose bus has identifiers of 29 bits: what is not said here stays in the block.
    printf '%s\n' MotionCommand=0x0CFF0210 EgoMotionA=0x0CFF0321 EgoMotionB=0x0CFF0421 PeerMotionA=0x18FF4021/0x100 \
        PeerMotionB=0x18FF5021/0x100 DriverRequest=0x123 >"$work/identifiers"
    both 'in_real_time fd' 'in_real_time placed'
    echo "-- a process of Linux, lock step, $placed"
    judge vcan0 --lock-step --identifiers "$work/identifiers"
    scripts/vcan.sh --real-time "${harness[@]}" --device "'$sim' ecu --bus vcan0 --station 1 --lock-step --identifiers '$work/identifiers'"
}

check_m4() {
    need qemu-system-arm qemu-system-arm
    local target=thumbv7em-none-eabihf
    images $target
    echo "-- an emulated Cortex-M4F over slcan, real time"
    judge slcan0
    conclude scripts/device-m4.sh "$work/$target-real-time" -- "${harness[@]}"
    echo "-- an emulated Cortex-M4F over slcan, lock step"
    judge slcan0 --lock-step
    scripts/device-m4.sh "$work/$target-lock-step" -- "${harness[@]}"
}

check_r5() {
    need qemu-system-aarch64 qemu-system-arm
    local target=armv7r-none-eabihf
    images $target
    echo "-- an emulated Cortex-R5F with a CAN controller on vcan0, real time"
    judge vcan0
    conclude scripts/device-r5.sh "$work/$target-real-time" -- "${harness[@]}"
    echo "-- an emulated Cortex-R5F with a CAN controller on vcan0, lock step"
    judge vcan0 --lock-step
    scripts/device-r5.sh "$work/$target-lock-step" -- "${harness[@]}"
}

# beside_process [--fd]: the node and a process.
beside_process() {
    echo "-- the first node and a process of Linux${1:+, CAN FD}"
    conclude scripts/vcan.sh --real-time bash -c '"$0" ecu --bus vcan0 --station 1 $1 & shift; "$@"; code=$?; kill $!; exit $code' \
        "$sim" "${1:-}" "${node[@]}" "$@"
}

check_node() {
    need qemu-system-arm qemu-system-arm
    local target=thumbv7em-none-eabihf python=$work/python
    local node=("$python/bin/python" examples/first-node/first_node.py)
    # The guest of user-mode Linux runs on the machine's own files, and so with this environment.
    need_python "$python" examples/first-node/requirements.txt
    images $target
    both beside_process 'beside_process --fd'
    echo "-- the first node and an emulated Cortex-M4F over slcan"
    conclude scripts/device-m4.sh "$work/$target-real-time" -- "${node[@]}" --channel slcan0
}

checks=(kernel tests ecu m4 r5 node)
for name in "$@"; do
    [[ " ${checks[*]} " = *" $name "* ]] || { echo "hil.sh: no check '$name'; there are: ${checks[*]}" >&2 && exit 2; }
done
[ $# -gt 0 ] && checks=("$@")

mkdir -p "$work"
rm -f "$work"/*-none-eabi*
code=0
kernel=$(scripts/vcan.sh cat /proc/sys/kernel/random/boot_id) || code=$?
[ "$code" != 77 ] || skip "no vcan0 can be had on this machine"
[ "$code" = 0 ] || exit "$code"
own_kernel=yes
[ "$kernel" != "$(cat /proc/sys/kernel/random/boot_id)" ] || own_kernel=no
need_programs
sim=$programs/holdover-sim
building=
if [[ $own_kernel = yes && " ${checks[*]} " = *' m4 '*' r5 '* ]]; then
    test_binaries >/dev/null # first, because cargo does one thing at a time
    (
        exec {turn}>"$work/turn" # see conclude
        flock --shared "$turn"
        build_images thumbv7em-none-eabihf && build_images armv7r-none-eabihf
    ) >"$work/images" 2>&1 &
    building=$!
fi
for name in "${checks[@]}"; do
    echo "-- $name"
    "check_$name"
done
