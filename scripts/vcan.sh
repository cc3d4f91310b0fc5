#!/usr/bin/env bash
# vcan.sh [OPTION...] [--] COMMAND [ARG...]
#
# Runs a command under a Linux kernel that has a virtual CAN interface `vcan0`, for classic CAN and CAN FD, on any Linux machine and
# in any CI:
#
#   1. directly, where `vcan0` is up already, or where this user may make it (it is removed again afterwards);
#   2. otherwise in user-mode Linux: a kernel that is an ordinary process. It boots in two seconds on the machine's own
#      file system, needs no root, no module of the host's kernel and no virtualisation, and has CAN, vcan and slcan. On a
#      processor with AMX it needs a C compiler besides.
#
# The command finds the same files, working directory and environment, its stdout and stderr arrive apart from one
# another, and its exit status is that of this script. Its stdin is empty. In user-mode Linux it is root, has one
# processor and no network but `lo` and `vcan0`; build outside of it and run inside.
#
#   --serial PATH    a serial line of the machine (`/dev/ttyUSB0`) for SLCAN, or the socket of an emulator's, for which
#                    user-mode Linux is needed; may be repeated. The command finds its name, `/dev/ttyS0` in user-mode Linux,
#                    in VCAN_SERIAL0, then in VCAN_SERIAL1, and so on
#   --timeout S      end the command after S seconds (default: 600)
#   --memory SIZE    of user-mode Linux (default: 1G, taken as it is used)
#   --real-time      let it come before the machine's other programs, where this user may say so, as a bus waits for none. A
#                    command that never rests loses 50 ms of each second to them all the same: Linux sees to it
#   --uml            use user-mode Linux even where the machine has vcan
#   -h, --help       this text
#
# Exit code: the command's; 2 wrong usage; 77 no way to a vcan0 is open here (the reason and the remedy are on stderr);
# 124 the time was up; 125 the kernel ended without a status (its last words are on stderr).
#
# Example:  scripts/vcan.sh sh -c 'candump -n 1 vcan0 & sleep 0.2; cansend vcan0 123#DEADBEEF; wait'
#
# It is one file and depends on nothing else in this repository, so that it can be copied into another one. In GitHub's CI:
#     - run: ./vcan.sh cargo test --test can_bus
set -euo pipefail

packages=(user-mode-linux busybox-static can-utils iproute2)

say() { echo "vcan: $*" >&2; }

# The kernel hands what it does not know of its command line to its first process as environment, VCAN_JOB among it.
# This is that process: it makes the interface, runs the command, notes its status, and powers off.
guest() {
    export PATH=/usr/sbin:/usr/bin:/sbin:/bin
    mount() { busybox mount "$@"; }
    mount -t proc proc /proc
    mount -t sysfs sys /sys
    mount -t devtmpfs dev /dev 2>/dev/null || true # the kernel may have done it
    mkdir -p /dev/pts /dev/shm
    mount -t devpts -o ptmxmode=666 devpts /dev/pts
    mount -t tmpfs shm /dev/shm
    mount -t tmpfs run /run
    ln -sfn /proc/self/fd /dev/fd
    for name in stdin:0 stdout:1 stderr:2; do ln -sfn "/proc/self/fd/${name#*:}" "/dev/${name%:*}"; done
    # Linux withholds 50 ms of a second from programs in real time that take 95 % of it, so that others are not starved. This kernel
    # counts in ticks of 10 ms, so whoever wakes just before each of them seems to take all of it; and there are no others here.
    echo -1 >/proc/sys/kernel/sched_rt_runtime_us
    # Consoles 1 and 2 are the command's stdout and stderr; not a byte is to be changed on the way.
    for console in 1 2; do busybox stty raw -echo </dev/tty$console; done
    for module in net/can/can net/can/can-raw net/can/can-gw drivers/net/can/dev/can-dev drivers/net/can/vcan \
        drivers/net/can/slcan/slcan; do
        busybox insmod "$(echo /usr/lib/uml/modules/*/kernel)/$module.ko" || true # it may be built in
    done
    busybox ip link set lo up
    busybox ip link add dev vcan0 type vcan
    busybox ip link set vcan0 mtu 72 # of CAN FD
    busybox ip link set vcan0 up
    # By way of pipes, so that no program takes them for a terminal with somebody in front of it.
    local status=0 out err pid
    exec 3> >(exec cat >/dev/tty1) && out=$!
    exec 4> >(exec cat >/dev/tty2) && err=$!
    setsid bash "$VCAN_JOB/command" </dev/null >&3 2>&4 3>&- 4>&- || status=$?
    # What the command left running ends with it, and lets go of the pipes.
    for pid in /proc/[0-9]*; do
        pid=${pid#/proc/}
        [ -z "$(readlink "/proc/$pid/exe")" ] || [[ " 1 $out $err " = *" $pid "* ]] || kill -KILL "$pid" 2>/dev/null || true
    done
    exec 3>&- 4>&-
    wait "$out" "$err"
    echo "$status" >"$VCAN_JOB/status"
}

if [ $$ = 1 ] && [ -n "${VCAN_JOB:-}" ]; then
    trap 'busybox halt -f' EXIT
    guest
    exit
fi

usage() {
    sed -n '2,/^set -/{/^set -/d;s/^# \{0,1\}//;p}' "$0"
}

wrong() {
    say "$*"
    say "usage: vcan.sh [--serial PATH] [--timeout S] [--memory SIZE] [--real-time] [--uml] [--] COMMAND [ARG...]; vcan.sh --help says more"
    exit 2
}

# No vcan0 here: the reason, the remedy, 77.
cannot() {
    say "CANNOT RUN: $1"
    say "remedy: $2"
    exit 77
}

as_root() {
    if [ "$(id -u)" = 0 ]; then "$@"; elif command -v sudo >/dev/null; then sudo -n "$@" 2>/dev/null; else return 1; fi
}

# Whether vcan0 is there and up.
has_vcan() {
    [ -e /sys/class/net/vcan0 ] && [ "$(($(cat /sys/class/net/vcan0/flags) & 1))" = 1 ]
}

make_vcan() {
    command -v ip >/dev/null || return 1
    { as_root modprobe vcan || true; } 2>/dev/null
    if [ ! -e /sys/class/net/vcan0 ]; then
        as_root ip link add dev vcan0 type vcan 2>/dev/null || return 1
        trap 'as_root ip link delete vcan0' EXIT
    fi
    as_root ip link set vcan0 mtu 72 2>/dev/null || true # of CAN FD, which an interface that is up has already or not at all
    as_root ip link set vcan0 up 2>/dev/null
}

# A serial line becomes a CAN interface by the kernel's slcan, and only root may do that. A socket is no serial line.
has_slcan() {
    local line
    for line in "${serial[@]}"; do [ -c "$line" ] || return; done
    [ "$(id -u)" = 0 ] && { [ -d /sys/module/slcan ] || modprobe slcan 2>/dev/null; }
}

# Adds to `first` what lets a command come before others, if it is to and this user may say so.
come_first() {
    if [ $real_time = true ] && chrt --rr 1 true 2>/dev/null; then first+=(chrt --rr 1); fi
}

run_here() {
    local number
    local first=()
    come_first
    for number in "${!serial[@]}"; do export "VCAN_SERIAL$number=${serial[number]}"; done
    "${first[@]}" timeout --foreground --kill-after=5 "$limit" "$@" </dev/null
}

install_packages() {
    command -v linux.uml >/dev/null && command -v busybox >/dev/null && command -v candump >/dev/null &&
        command -v ip >/dev/null && return
    command -v apt-get >/dev/null ||
        cannot "the kernel has no vcan, or this user may not make one, and user-mode Linux is packaged for Debian and Ubuntu only" \
            "as root: modprobe vcan && ip link add dev vcan0 type vcan && ip link set vcan0 up"
    say "apt-get install ${packages[*]}"
    { as_root apt-get update -qq && as_root env DEBIAN_FRONTEND=noninteractive \
        apt-get install -y --no-install-recommends "${packages[@]}"; } >&2 ||
        cannot "the kernel has no vcan, or this user may not make one, and user-mode Linux cannot be installed" \
            "apt-get install ${packages[*]}; or, as root: modprobe vcan && ip link add dev vcan0 type vcan && ip link set vcan0 up"
}

# carry LINE... -- COMMAND...: runs the kernel with a socket in place of each line, and carries bytes between the two. Sockets,
# because what goes over a pseudo-terminal waits for a thread of the host's kernel that waits for every other program. The
# kernel learns by a signal what its lines are ready for, and gets none when they can be written to again: so whoever takes
# the bytes sends it. What comes while nobody in the guest reads is dropped, as by a serial port.
carry='
    use strict; use Fcntl; use Socket; use IO::Handle;
    my ($kernel, @serve) = $$;
    $^F = 99; # the sockets stay open for the kernel
    while ((my $path = shift) ne "--") {
        my $line;
        if (-S $path) {
            socket($line, AF_UNIX, SOCK_STREAM, 0) && connect($line, sockaddr_un $path) or die "vcan: $path: $!\n";
        } else {
            open($line, "+<", $path) or die "vcan: $path: $!\n";
            system "stty", "-F", $path, "raw", "-echo"; # the speed it keeps
        }
        socketpair(my $guest, my $end, AF_UNIX, SOCK_STREAM, PF_UNSPEC) or die "vcan: $!\n";
        push @serve, [$guest, $end, $line];
        next if fork;
        system "chrt --rr -p 2 $$ 2>/dev/null"; # before the kernel, which would not let it run while it has something to do
        $_->blocking(0) for $end, $line;
        my ($in, $out) = ("", ""); # to the kernel, and from it
        while (getppid == $kernel) {
            my ($read, $write) = ("", "");
            vec($read, fileno $line, 1) = $in eq "";
            vec($read, fileno $end, 1) = $out eq "";
            vec($write, fileno $end, 1) = $in ne "";
            vec($write, fileno $line, 1) = $out ne "";
            select $read, $write, undef, 1;
            if (vec $read, fileno $line, 1) {
                sysread $line, $in, 4096 or exit;
                $in = "" unless O_ASYNC & fcntl $guest, F_GETFL, 0; # the kernel has it open
            }
            if (vec $read, fileno $end, 1) {
                sysread $end, $out, 4096 or exit;
                kill IO => $kernel;
            }
            substr $in, 0, syswrite($end, $in) || 0, "" if $in ne "";
            substr $out, 0, syswrite($line, $out) || 0, "" if $out ne "";
        }
        exit;
    }
    exec @ARGV, map { "ssl$_=fd:" . fileno $serve[$_][0] } 0 .. $#serve;
'

# On a processor with AMX the state of a thread is larger than user-mode Linux of before 6.13 has room for, and the kernel of the
# machine refuses to take a part of it back. This takes the rest from the thread itself.
whole_state='
    #define _GNU_SOURCE
    #include <elf.h>
    #include <stdarg.h>
    #include <string.h>
    #include <sys/ptrace.h>
    #include <sys/syscall.h>
    #include <sys/uio.h>
    #include <unistd.h>

    long ptrace(enum __ptrace_request request, ...) {
        va_list more;
        va_start(more, request);
        long process = va_arg(more, int);
        void *address = va_arg(more, void *), *data = va_arg(more, void *);
        va_end(more);
        if (request == PTRACE_PEEKTEXT || request == PTRACE_PEEKDATA || request == PTRACE_PEEKUSER) {
            long word = 0;
            return syscall(SYS_ptrace, request, process, address, &word) < 0 ? -1 : word;
        }
        long result = syscall(SYS_ptrace, request, process, address, data);
        if (result >= 0 || request != PTRACE_SETREGSET || (long)address != NT_X86_XSTATE) return result;
        static char state[1 << 16];
        struct iovec whole = {state, sizeof state}, *part = data;
        if (syscall(SYS_ptrace, PTRACE_GETREGSET, process, address, &whole) < 0) return -1;
        memcpy(state, part->iov_base, part->iov_len < whole.iov_len ? part->iov_len : whole.iov_len);
        return syscall(SYS_ptrace, PTRACE_SETREGSET, process, address, &whole);
    }
'

# Everything that the guest's first process needs lies in $job. File descriptors 3 and 4 are the consoles 1 and 2.
run_in_uml() {
    local job number status kernel memory_in=/dev/shm
    job=$(mktemp -d /tmp/vcan.XXXXXX)
    trap "rm -rf '$job'" EXIT
    # The kernel's command line is divided at blanks, and this script may lie in a folder that has one in its name.
    install -m 755 "$0" "$job/init"
    for number in "${!serial[@]}"; do
        export "VCAN_SERIAL$number=/dev/ttyS$number"
    done
    {
        export -p
        printf 'cd %q\n' "$PWD"
        printf 'exec'
        printf ' %q' "$@"
        echo
    } >"$job/command"
    # The guest's memory is a file of the machine's. A container's /dev/shm is often smaller than that.
    [ "$(df --output=avail -B 1 /dev/shm 2>/dev/null | tail -n 1)" -gt "$(numfmt --from=iec "$memory")" ] 2>/dev/null ||
        memory_in=$job
    # It is several processes of which one runs at a time; that they stay on one processor makes each system call of the
    # command's three times as fast.
    local first=()
    [ $real_time = false ] || first=(taskset -c "$(taskset -cp $$ | sed 's/.*: *//; s/[-,].*//')")
    come_first
    [ ${#serial[@]} = 0 ] || first+=(perl -e "$carry" "${serial[@]}" --)
    if grep -q '^flags.* amx_tile' /proc/cpuinfo; then
        command -v cc >/dev/null || cannot "user-mode Linux needs a part that is compiled here, and there is no C compiler" "apt-get install gcc libc6-dev"
        cc -O2 -shared -fPIC -o "$job/state.so" -x c - <<<"$whole_state"
        first+=(env "LD_PRELOAD=$job/state.so")
    fi
    # Through a pipe, because the kernel would put the user's terminal into raw mode.
    local out err
    exec 3> >(exec cat) && out=$!
    exec 4> >(exec cat >&2) && err=$!
    TMPDIR=$memory_in timeout --kill-after=5 "$limit" "${first[@]}" linux.uml "mem=$memory" root=/dev/root rootfstype=hostfs \
        rootflags=/ rw "init=$job/init" "VCAN_JOB=$job" "uml_dir=$job" umid=kernel con=null con0=null,fd:1 con1=null,fd:3 \
        con2=null,fd:4 ssl=null quiet </dev/null >"$job/log" 2>&1 &
    kernel=$!
    trap "kill $kernel 2>/dev/null || true; exit 143" INT TERM
    status=0
    wait "$kernel" || status=$?
    exec 3>&- 4>&-
    wait "$out" "$err"
    if [ "$status" = 124 ] || [ "$status" = 137 ]; then
        say "the time of $limit s was up; --timeout gives more"
        exit 124
    fi
    [ -s "$job/status" ] || {
        say "user-mode Linux ended without running the command to its end; its last words:"
        tail -n 20 "$job/log" >&2
        exit 125
    }
    exit "$(cat "$job/status")"
}

limit=600 memory=1G uml=false real_time=false serial=()
while [ $# -gt 0 ]; do
    case $1 in
    -h | --help) usage && exit ;;
    --uml) uml=true && shift ;;
    --real-time) real_time=true && shift ;;
    --serial | --timeout | --memory)
        [ $# -ge 2 ] || wrong "$1 needs a value"
        case $1 in
        --serial)
            [ -c "$2" ] || [ -S "$2" ] || wrong "--serial $2: no such serial line"
            serial+=("$2")
            ;;
        --timeout) limit=$2 ;;
        --memory) memory=$2 ;;
        esac
        shift 2
        ;;
    --) shift && break ;;
    -*) wrong "no option $1" ;;
    *) break ;;
    esac
done
[ $# -gt 0 ] || wrong "no command"

if [ $uml = false ] && { [ ${#serial[@]} = 0 ] || has_slcan; } && { has_vcan || make_vcan; }; then
    run_here "$@"
else
    install_packages
    run_in_uml "$@"
fi
