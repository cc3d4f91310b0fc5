"""chacha.py: the random numbers of holdover-sim, in Python.

ChaCha8 with a stream for each purpose, seeded from one number: `host-sim/src/streams.rs` says how. The same seed and stream give the same
numbers, so that this folder has the same trips as the simulator.
"""

import struct

WORD = 0xFFFF_FFFF
CONSTANTS = struct.unpack("<4I", b"expand 32-byte k")
COLUMNS = [(0, 4, 8, 12), (1, 5, 9, 13), (2, 6, 10, 14), (3, 7, 11, 15)]
DIAGONALS = [(0, 5, 10, 15), (1, 6, 11, 12), (2, 7, 8, 13), (3, 4, 9, 14)]
DOUBLE_ROUNDS = 4


def key(seed):
    """The eight words of the key: PCG32 from the seed on, as `SeedableRng::seed_from_u64` of rand_core has it."""
    words = []
    for _ in range(8):
        seed = (seed * 0x5851_F42D_4C95_7F2D + 0xA176_54E4_6FBE_17F3) & (1 << 64) - 1
        mixed, by = (((seed >> 18) ^ seed) >> 27) & WORD, seed >> 59
        words.append((mixed >> by | mixed << (32 - by)) & WORD)
    return words


def block(key_words, stream, count):
    """The sixteen words of one block."""
    start = [*CONSTANTS, *key_words, count & WORD, count >> 32, stream & WORD, stream >> 32]
    x = list(start)
    for a, b, c, d in (COLUMNS + DIAGONALS) * DOUBLE_ROUNDS:
        for into, add, turn, by in ((a, b, d, 16), (c, d, b, 12), (a, b, d, 8), (c, d, b, 7)):
            x[into] = (x[into] + x[add]) & WORD
            mixed = x[turn] ^ x[into]
            x[turn] = (mixed << by | mixed >> (32 - by)) & WORD
    return [(a + b) & WORD for a, b in zip(x, start)]


def units(seed, stream):
    """Numbers uniform in [0, 1) by steps of 2⁻⁵³, without end."""
    words, count = key(seed), 0
    while True:
        drawn = block(words, stream, count)
        for low, high in zip(drawn[::2], drawn[1::2]):
            yield ((high << 32 | low) >> 11) / (1 << 53)
        count += 1
