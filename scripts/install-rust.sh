#!/usr/bin/env bash
# install-rust.sh
#
# Makes `cargo`, `clippy` and `rustfmt` and a C linker available on a bare Debian, where they are missing; does nothing
# and says nothing where they are not. Exit code 1, and the remedy, when it cannot.
set -euo pipefail

as_root() {
    if [ "$(id -u)" = 0 ]; then "$@"; elif command -v sudo >/dev/null; then sudo -n "$@"; else return 1; fi
}

install() {
    echo "install-rust: apt-get install $*"
    as_root apt-get update -qq
    as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "$@"
}

command -v cc >/dev/null || install gcc libc6-dev || {
    echo "install-rust: no C linker and no right to install one; remedy: apt-get install gcc libc6-dev" >&2
    exit 1
}

if ! command -v cargo >/dev/null; then
    command -v curl >/dev/null || install ca-certificates curl || true
    curl --proto '=https' --tlsv1.2 -sSf https://static.rust-lang.org/rustup/rustup-init.sh |
        sh -s -- -y --profile minimal --component clippy --component rustfmt ||
        install rustc-web cargo-web rustfmt-web rust-web-clippy || {
        echo "install-rust: neither rustup nor apt-get can be used; remedy: install Rust 1.93 or later" >&2
        exit 1
    }
    PATH=${CARGO_HOME:-$HOME/.cargo}/bin:$PATH
fi

for component in clippy rustfmt; do
    cargo "${component/rustfmt/fmt}" --version >/dev/null 2>&1 || rustup component add "$component"
done
