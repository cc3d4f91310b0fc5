#!/usr/bin/env bash
# release.sh [--quick] [TARGET...]: archives of holdover-sim for a release, in target/release-archives/, each tried where there
# is nothing else: no library, no shell, no folder.
#
# Without a TARGET: x86_64-unknown-linux-musl and aarch64-unknown-linux-musl. An archive of another processor is tried by
# qemu-user; what could not be tried is said at the end, and loudly. --quick leaves out the optimisation: for a check of the
# recipe, not for a release.
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/need.sh
command -v rustup >/dev/null || PATH=${CARGO_HOME:-$HOME/.cargo}/bin:$PATH

profile=release
[ "${1:-}" = --quick ] && {
    shift
    profile=quick
}
[ $# -gt 0 ] || set -- x86_64-unknown-linux-musl aarch64-unknown-linux-musl
out=${CARGO_TARGET_DIR:-target}/release-archives
version=$(cargo metadata --locked --no-deps --format-version 1 | grep -o '"name":"holdover-sim","version":"[^"]*' | cut -d'"' -f8)
[ -n "$version" ] || { echo "the version of holdover-sim is not known" && exit 1; }
rm -rf "$out" && mkdir -p "$out"
untried=()

# try COMMAND...: the program in folder $bare sees nothing but that folder.
try() {
    if [ "$(id -u)" = 0 ]; then
        env -i "$(command -v chroot)" "$bare" "$@"
    else
        env -i "$(command -v unshare)" --map-root-user "$(command -v chroot)" "$bare" "$@"
    fi
}

for target in "$@"; do
    rustup target add "$target" >/dev/null 2>&1 || skip "no standard library for $target can be had on this machine"
    # The crates are Rust throughout, so that Rust's own linker and its C library do for every processor.
    linker=CARGO_TARGET_$(tr 'a-z-' 'A-Z_' <<<"$target")_LINKER
    env "$linker=rust-lld" cargo build --locked --profile "$profile" -p holdover-sim --target "$target"
    built=${CARGO_TARGET_DIR:-target}/$target/$profile/holdover-sim
    name=holdover-sim-$version-$target
    folder=$out/$name
    mkdir -p "$folder/completions"
    install -m 755 "$built" "$folder/holdover-sim"
    cp README.md CHANGELOG.md LICENSE-MIT LICENSE-APACHE holdover.dbc holdover-fd.dbc "$folder"

    if readelf --program-headers --wide "$folder/holdover-sim" | grep -q INTERP; then
        echo "$target: the program asks for a dynamic linker" && exit 1
    fi
    # How this machine runs the program: by itself, or by an emulator.
    run=() runs=yes
    case $target in
    "$(uname -m)"-*) ;;
    *)
        (need "qemu-${target%%-*}-static" qemu-user-static >/dev/null 2>&1) || true
        emulator=$(command -v "qemu-${target%%-*}-static" || command -v "qemu-${target%%-*}" || true)
        [ -n "$emulator" ] && run=("$emulator") || runs=no
        ;;
    esac
    if [ "$runs" = no ]; then
        untried+=("$target: no qemu-${target%%-*}; remedy: apt-get install qemu-user-static")
    else
        "${run[@]}" "$folder/holdover-sim" man "$folder/man1" 2>/dev/null
        for shell in bash zsh fish; do
            "${run[@]}" "$folder/holdover-sim" completions "$shell" >"$folder/completions/holdover-sim.$shell"
        done
    fi
    # The same files make the same archive.
    tar --sort=name --owner=0 --group=0 --numeric-owner --mtime="@$(git log -1 --format=%ct 2>/dev/null || echo 0)" \
        -C "$out" -czf "$out/$name.tar.gz" "$name"
    (cd "$out" && sha256sum "$name.tar.gz" >"$name.tar.gz.sha256")

    [ "$runs" = no ] && continue
    bare=$(mktemp -d)
    tar -C "$bare" --strip-components=1 -xzf "$out/$name.tar.gz"
    inside=()
    if [ ${#run[@]} -gt 0 ]; then
        cp "${run[0]}" "$bare/emulator" && inside=(/emulator)
    fi
    if try "${inside[@]}" /holdover-sim --version >"$bare/said" 2>&1; then
        grep -q "^holdover-sim $version " "$bare/said" || { cat "$bare/said" && exit 1; }
        try "${inside[@]}" /holdover-sim run --set duration_s=5 --out /report >"$bare/said"
        grep -q '^verdict: passed' "$bare/said" && [ -s "$bare/report/index.html" ]
        echo "$name.tar.gz: $(stat -c %s "$out/$name.tar.gz") bytes; on a bare machine: --version, a run, its report"
    else
        untried+=("$target: this machine lets nobody into a bare folder: $(head -1 "$bare/said")")
    fi
    rm -rf "$bare"
done
ls -l "$out"/*.tar.gz
if [ ${#untried[@]} -gt 0 ]; then
    printf '\n*** NOT TRIED ***\n'
    printf '*** %s\n' "${untried[@]}"
fi
