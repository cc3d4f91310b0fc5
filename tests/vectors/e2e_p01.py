"""Writes e2e_p01.csv: frames protected by the PyPI package autosar-e2e (pip install autosar-e2e), one a line."""

import pathlib
import random

from e2e.p01 import E2E_P01_DATAID_BOTH, e2e_p01_protect

random.seed(1)
lines = ["data_id,data"]
for number in range(2000):
    data_id = random.getrandbits(16) if number % 2 else 0x4800 + random.randrange(0xC0)
    data = bytearray(random.randbytes(8))
    data[1] = data[1] & 0xF0 | random.randrange(15)
    e2e_p01_protect(data, data_id, data_id_mode=E2E_P01_DATAID_BOTH, increment_counter=False)
    lines.append(f"{data_id:04x},{data.hex()}")
pathlib.Path(__file__).with_name("e2e_p01.csv").write_text("\n".join(lines) + "\n")
