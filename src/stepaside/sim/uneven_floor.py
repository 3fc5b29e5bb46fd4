"""Uneven floor: a field of random heights."""

import mujoco
import numpy as np
from scipy.ndimage import zoom

HALF_SIDE = 4.0  # of an uneven floor, in [m]
GRAIN = 0.1  # spacing of independent heights of an uneven floor, in [m]
CELLS = 2  # grid cells per grain


def add_heights(
    spec: mujoco.MjSpec, unevenness: float, generator: np.random.Generator
) -> None:
    """Add a height field, random at every grain and linear in between."""
    grains = round(2.0 * HALF_SIDE / GRAIN) + 1
    coarse = generator.uniform(0.0, 1.0, (grains, grains))
    heights = np.clip(zoom(coarse, CELLS, order=1), 0.0, 1.0)
    spec.add_hfield(
        name="floor",
        size=[HALF_SIDE, HALF_SIDE, unevenness, 0.1],
        nrow=heights.shape[0],
        ncol=heights.shape[1],
        userdata=heights.astype(np.float32).ravel().tolist(),
    )
