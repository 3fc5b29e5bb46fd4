"""Named random generators: one for each purpose, all from one seed."""

from zlib import crc32

import numpy as np


def named_generator(seed: int, name: str) -> np.random.Generator:
    """Generator of the draws of one purpose.

    Args:
        seed: Seed of the run.
        name: Purpose. Other names give independent draws.
    """
    return np.random.default_rng([seed, crc32(name.encode())])
