#!/usr/bin/env bash
# live.sh: the page of `live` in a real browser without a screen. Pictures of it go to target/live/.
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/need.sh

(cd host-sim/third-party/ogl && sha256sum --check --quiet SHA256SUMS)
need_browser
target=${CARGO_TARGET_DIR:-target}
mkdir -p "$target/live"
need_programs
sim=$programs/holdover-sim
for check in live_check live_input_check live_road_check; do
    echo "$check:"
    timeout 600 "$python/bin/python" "scripts/$check.py" "$sim" "$(command -v chromium)" "$target/live"
done
"$sim" run --no-report --trace "$target/live/run.csv" --mcap "$target/live/run.mcap" >/dev/null
"$python/bin/python" scripts/mcap_check.py "$target/live/run.mcap" "$target/live/run.csv"
# In this seed a vehicle soon follows another one at this time gap: without an error of position the verdict fails.
"$sim" run corridor --no-report --set duration_s=15 --seed 5 --set traffic.time_gap_s=3 --mcap "$target/live/roads.mcap" \
    --trajectories "$target/live/roads.csv" --trajectories-every 0.01 >/dev/null
"$python/bin/python" scripts/mcap_check.py "$target/live/roads.mcap" "$target/live/roads.csv" roads
