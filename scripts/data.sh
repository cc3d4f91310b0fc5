#!/usr/bin/env bash
# data.sh: the converters of recordings on small files in the published formats, and the notebooks of docs/notebooks/, executed.
# Figures are left in target/notebooks/.
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/need.sh

target=$(realpath -m "${CARGO_TARGET_DIR:-target}")
python=$target/data-python
mkdir -p "$python"
need_python "$python" scripts/data/requirements.txt
need_python "$python" docs/notebooks/requirements.txt
need_programs
sim=$programs/holdover-sim
(cd scripts/data && "$python/bin/python" test_recordings.py "$sim")
for notebook in docs/notebooks/*.ipynb; do
    "$python/bin/python" scripts/notebook_check.py "$notebook" "$sim" "$target/notebooks"
done
