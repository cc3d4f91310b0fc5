"""sumo_programs.py: the programs of SUMO: where they are, and how they are called.

They are those of the Python package `eclipse-sumo` of this interpreter, else those on the PATH.
"""

import os
import shutil
import subprocess
from pathlib import Path

from corridor import Unusable

REMEDY = "python3 -m pip install -r scripts/sumo/requirements.txt"


def program(name):
    """The path of a program, and the environment that it needs."""
    environment = dict(os.environ)
    try:
        import sumo

        environment["SUMO_HOME"] = sumo.SUMO_HOME
        found = shutil.which(name, path=Path(sumo.SUMO_HOME) / "bin")
    except ImportError:
        found = None
    found = found or shutil.which(name)
    if not found:
        raise Unusable(f"SUMO is not installed: there is no `{name}`; remedy: {REMEDY}")
    return found, environment


def call(name, *options):
    """Runs a program to its end. The result: what it printed."""
    path, environment = program(name)
    done = subprocess.run([path, *map(str, options)], env=environment, capture_output=True, text=True, check=False)
    if done.returncode:
        raise Unusable(failed(name, done.returncode, done.stderr))
    return done.stdout


def failed(name, code, said):
    """What a failed program has to say, with the remedy."""
    lines = [line for line in said.splitlines() if line.startswith("Error")] or said.splitlines()[-1:]
    return f"{name} ended with {code}: {' '.join(lines) or 'without a word'}; compare its version with scripts/sumo/requirements.txt"


def version():
    """The version of SUMO, such as 1.28.0."""
    return call("sumo", "--version").split("\n", 1)[0].split()[-1]
