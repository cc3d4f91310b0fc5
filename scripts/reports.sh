#!/usr/bin/env bash
# reports.sh: the reports of every command in a real browser: large and narrow, light and dark, and printed. Pages, pictures
# and PDF files are left in target/reports/.
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/need.sh

need_browser
target=${CARGO_TARGET_DIR:-target}
reports=$target/reports
need_programs
sim=$programs/holdover-sim
rm -rf "$reports"
mkdir -p "$reports"

# report NAME COMMAND...: the report of a command; a failed verdict (exit code 1) is a report too.
report() {
    local name=$1 code=0
    shift
    "$sim" "$@" --out "$reports/$name" >/dev/null 2>"$reports/$name.log" || code=$?
    [ "$code" -le 1 ] || { cat "$reports/$name.log" && return 1; }
}

# A drive with a hole, as a recorder leaves one, and a link that loses one message in five.
awk 'BEGIN { print "t_s,position_m,speed_mps"
    for (n = 0; n <= 600; n++) if (n < 250 || n > 290) { t = n / 10
        printf "%.1f,%.3f,%.3f\n", t, 12 * t - 10 * (cos(t / 5) - 1), 12 + 2 * sin(t / 5) } }' >"$reports/drive.csv"
awk 'BEGIN { print "t_s,delay_s"; for (n = 0; n < 600; n++) printf "%.1f,%s\n", n / 10, n % 5 ? 0.05 + n % 7 / 100 : "" }' >"$reports/link.csv"

report run run
report collision run --envelope=off --range-sensors off --set channel.loss=0.95
report evaluate evaluate --motion "$reports/drive.csv" --outage 1,2,4
report evaluate-link evaluate --motion "$reports/drive.csv" --channel "$reports/link.csv"
report sweep sweep --seeds 4
report envelope-cost envelope-cost --seeds 2
report gains gains
report string string --delays 0,0.2 --losses 0,0.4 --step-only --seeds 3
report braking braking --seeds 2
report motions motions --silences 5
report corridor run corridor --set duration_s=15 --set ego_after_s=0 --set 'ego_road="Harrison Street, southwest"' --vehicles 10

timeout 300 "$python/bin/python" scripts/reports_check.py "$(command -v chromium)" "$reports"
