#!/usr/bin/env python3
"""A notebook and the program enter; the executed notebook and its figures leave, or the first cell that fails.

    notebook_check.py NOTEBOOK HOLDOVER_SIM FOLDER
"""

import base64
import os
import sys
from pathlib import Path

import nbformat
from nbclient import NotebookClient

source, program, folder = Path(sys.argv[1]), Path(sys.argv[2]).resolve(), Path(sys.argv[3]).resolve()
folder.mkdir(parents=True, exist_ok=True)
os.environ["HOLDOVER_SIM"] = str(program)
notebook = nbformat.read(source, as_version=4)
if any(cell.get("outputs") for cell in notebook.cells):
    sys.exit(f"{source}: is kept with outputs; remedy: clear them before it is committed")
NotebookClient(notebook, timeout=120, kernel_name="python3", resources={"metadata": {"path": str(folder)}}).execute()
nbformat.write(notebook, folder / source.name)
pictures = 0
for cell in notebook.cells:
    for output in cell.get("outputs", []):
        picture = output.get("data", {}).get("image/png")
        if picture:
            pictures += 1
            (folder / f"{source.stem}-{pictures}.png").write_bytes(base64.b64decode(picture))
print(f"{source}: {len(notebook.cells)} cells, {pictures} figures in {folder}")
sys.exit(0 if pictures else 1)
