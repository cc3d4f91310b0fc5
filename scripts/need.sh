#!/usr/bin/env bash
# need.sh: what the checks share; to be sourced.

# skip WHY...: this check cannot run here (exit code 77, which ci.sh counts).
skip() {
    echo "SKIPPED: $*"
    exit 77
}

as_root() {
    if [ "$(id -u)" = 0 ]; then "$@"; elif command -v sudo >/dev/null; then sudo -n "$@"; else return 1; fi
}

# need COMMAND PACKAGE: installs a package of Debian's if the command is missing.
need() {
    command -v "$1" >/dev/null && return
    { as_root apt-get update -qq && as_root env DEBIAN_FRONTEND=noninteractive \
        apt-get install -y --no-install-recommends "$2"; } || skip "$1 is not there; remedy: apt-get install $2"
}

# need_browser: Chromium, and in `python` an environment of Python that drives it.
need_browser() {
    need chromium chromium
    python=${CARGO_TARGET_DIR:-target}/live-python
    mkdir -p "$python"
    need_python "$python" scripts/live-requirements.txt
}

# need_programs: builds the workspace's programs and tests, and says in `programs` where they are. All of them, as `./ci.sh test`
# builds them: for a choice of packages Cargo builds the dependencies anew, with the features of this choice, and the simulator too.
need_programs() {
    cargo build --locked --workspace --all-targets --profile checked
    programs=$(realpath -m "${CARGO_TARGET_DIR:-target}")/checked
}

# need_python FOLDER REQUIREMENTS: an environment of Python in that folder with these packages of PyPI.
need_python() {
    need python3 python3
    # Debian's python3 has venv in a package of its own.
    python3 -c 'import ensurepip' 2>/dev/null || as_root apt-get install -y --no-install-recommends python3-venv ||
        skip "this Python makes no environments; remedy: apt-get install python3-venv"
    { [ -x "$1/bin/pip" ] || python3 -m venv "$1"; } &&
        "$1/bin/pip" install --quiet --disable-pip-version-check -r "$2" ||
        skip "the packages in $2 cannot be had from PyPI"
}
