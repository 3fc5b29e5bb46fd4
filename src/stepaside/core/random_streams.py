"""Independent random generators by name, derived from one seed."""

from zlib import crc32

import numpy as np


def named_generator(seed: int, name: str) -> np.random.Generator:
    """Return the random generator of one purpose, independent of others."""
    return np.random.default_rng([seed, crc32(name.encode())])
