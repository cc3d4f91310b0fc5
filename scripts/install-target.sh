#!/usr/bin/env bash
# install-target.sh TARGET
#
# Makes a stable compiler able to build for TARGET, and prints the folder of the `cargo` and `rustc` that can.
# Three ways, in this order, because a toolchain server is not within everybody's reach:
#   1. rustup downloads the target's standard library (a second);
#   2. rustup has the library's sources, and `core` and `alloc` are built from them into the toolchain (half a minute);
#   3. the same with Debian's own compiler and sources.
# Everything but the answer goes to stderr. Exit code 1 when no way is open.
set -euo pipefail

target=${1:?usage: install-target.sh TARGET}

say() { echo "install-target: $*" >&2; }

as_root() {
    if [ "$(id -u)" = 0 ]; then "$@"; elif command -v sudo >/dev/null; then sudo -n "$@"; else return 1; fi
}

# Whether the compiler in folder $1 has `core` for the target.
has_core() {
    compgen -G "$("$1/rustc" --print sysroot)/lib/rustlib/$target/lib/libcore-*.rlib" >/dev/null
}

# Builds `core`, `alloc` and `compiler_builtins` with the compiler in folder $1 and puts them where it looks for them.
build_core() {
    local bin=$1 libraries work
    libraries=$("$bin/rustc" --print sysroot)/lib/rustlib/$target/lib
    work=$(mktemp -d)
    mkdir "$work/src"
    echo '#![no_std]' >"$work/src/lib.rs"
    printf '[package]\nname = "empty"\nversion = "0.0.0"\nedition = "2024"\n[profile.release]\npanic = "abort"\n' \
        >"$work/Cargo.toml"
    # RUSTC_BOOTSTRAP lets the stable compiler build its own library, and nothing else here. The bitcode is what
    # link-time optimisation needs of a library.
    (
        cd "$work"
        env -u CARGO_BUILD_TARGET PATH="$bin:$PATH" RUSTC="$bin/rustc" RUSTC_BOOTSTRAP=1 \
            RUSTFLAGS='-C embed-bitcode=yes' CARGO_TARGET_DIR="$work/target" \
            "$bin/cargo" build --release --target "$target" -Zbuild-std=core,alloc
    ) >&2 || { rm -rf "$work"; return 1; }
    as_owner "$libraries" mkdir -p "$libraries"
    for crate in core alloc compiler_builtins; do
        as_owner "$libraries" cp "$work/target/$target/release/deps/lib$crate"-*.{rlib,rmeta} "$libraries/"
    done
    rm -rf "$work"
}

# Runs a command that writes to folder $1: as root only where that is needed.
as_owner() {
    local place=$1
    shift
    while [ ! -e "$place" ]; do place=$(dirname "$place"); done
    if [ -w "$place" ]; then "$@"; else as_root "$@"; fi
}

# Debian's compiler comes without the linker for bare metal: takes any `lld` that there is.
borrow_linker() {
    local bin=$1 host place linker
    host=$("$bin/rustc" -vV | sed -n 's/^host: //p')
    place=$("$bin/rustc" --print sysroot)/lib/rustlib/$host/bin
    [ -x "$place/rust-lld" ] && return
    linker=$(compgen -G "${RUSTUP_HOME:-$HOME/.rustup}/toolchains/*/lib/rustlib/$host/bin/rust-lld" | head -n 1 || true)
    if [ -z "$linker" ]; then
        command -v ld.lld >/dev/null || as_root apt-get install -y --no-install-recommends lld >&2
        linker=$(command -v ld.lld)
    fi
    as_owner "$place" mkdir -p "$place"
    as_owner "$place" ln -sf "$linker" "$place/rust-lld"
}

if command -v rustup >/dev/null; then
    bin=$(dirname "$(rustup which cargo)")
    if has_core "$bin"; then
        echo "$bin"
        exit
    fi
    if timeout 300 rustup target add "$target" >&2 && has_core "$bin"; then
        say "$target by rustup"
        echo "$bin"
        exit
    fi
    if timeout 300 rustup component add rust-src >&2 && build_core "$bin"; then
        say "$target built from rustup's sources"
        echo "$bin"
        exit
    fi
fi

bin=/usr/bin
if ! dpkg -s rustc-web cargo-web rust-web-src >/dev/null 2>&1; then
    { as_root apt-get update -qq && DEBIAN_FRONTEND=noninteractive as_root apt-get install -y --no-install-recommends \
        rustc-web cargo-web rust-web-src; } >&2 || { say "no way to get $target is open on this machine"; exit 1; }
fi
borrow_linker "$bin"
has_core "$bin" || build_core "$bin" || { say "Debian's compiler cannot build core for $target"; exit 1; }
say "$target in Debian's compiler"
echo "$bin"
