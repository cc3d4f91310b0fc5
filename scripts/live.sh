#!/usr/bin/env bash
# live.sh: the page of `live` in a real browser without a screen. Pictures of it go to target/live/.
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/need.sh

need_browser
target=${CARGO_TARGET_DIR:-target}
mkdir -p "$target/live"
cargo build --locked --release -p holdover-sim
timeout 170 "$python/bin/python" scripts/live_check.py "$target/release/holdover-sim" "$(command -v chromium)" "$target/live"
sim=$target/release/holdover-sim
"$sim" run --no-report --trace "$target/live/run.csv" --mcap "$target/live/run.mcap" >/dev/null
"$python/bin/python" scripts/mcap_check.py "$target/live/run.mcap" "$target/live/run.csv"
