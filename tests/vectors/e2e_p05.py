"""Writes e2e_p05.csv: frames protected by the PyPI package autosar-e2e (pip install autosar-e2e), one a line."""

import pathlib
import random

from e2e.p05 import e2e_p05_protect

random.seed(1)
lines = ["data_id,data"]
for number in range(1200):
    data_id = random.getrandbits(16) if number % 2 else 0x4800 + random.randrange(0xC0)
    data = bytearray(random.randbytes(random.choice([8, 12, 16, 20, 24, 32, 48, 64])))
    e2e_p05_protect(data, data_id, increment_counter=False)
    lines.append(f"{data_id:04x},{data.hex()}")
pathlib.Path(__file__).with_name("e2e_p05.csv").write_text("\n".join(lines) + "\n")
