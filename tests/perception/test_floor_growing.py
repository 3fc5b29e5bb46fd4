"""Test region growing of floor under gradual lighting."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from stepaside.perception.near_floor import MAX_STEP, grow_floor

HIGH, WIDE = 40, 60
FIRST = np.s_[:, :12]  # columns whose colour is known


def lit(first: float = 120.0, last: float = 230.0) -> NDArray[np.uint8]:
    """Floor that gets lighter from left to right, by two levels a pixel."""
    levels = np.linspace(first, last, WIDE)
    return np.broadcast_to(levels[None, :, None], (HIGH, WIDE, 3)).astype(
        np.uint8
    )


def known(place: Any = FIRST) -> NDArray[np.bool_]:
    found = np.zeros((HIGH, WIDE), dtype=np.bool_)
    found[place] = True
    return found


def test_gradual_lighting_stays_floor() -> None:
    assert grow_floor(lit(), known()).all()


def test_an_empty_mask_does_not_grow() -> None:
    assert not grow_floor(lit(), known(np.s_[:0])).any()


@pytest.mark.parametrize("less", [-60, -25, 25])
def test_regions_with_an_edge_are_not_floor(less: int) -> None:
    """Lighter or darker: but for its rim, which no pixel tells."""
    pixels = lit(150.0, 200.0)
    pixels[10:30, 30:50] = (pixels[10:30, 30:50].astype(int) + less).clip(0)
    grown = grow_floor(pixels, known())
    assert not grown[11:29, 31:49].any()
    assert grown[:8].all() and grown[32:].all()
    assert grown[:, :28].all() and grown[:, 52:].all()


def test_a_surface_with_few_known_pixels_is_not_floor() -> None:
    """A few pixels of a thing may look like floor by chance."""
    pixels = lit(80.0, 80.0)
    pixels[:, 30:] = 200
    few = known(np.s_[:, :12]) | known(np.s_[5:8, 40:43])
    grown = grow_floor(pixels, few)
    assert grown[:, :27].all()
    assert grown[:, 33:].sum() == 9  # what is known stays


def test_lines_between_tiles_are_floor() -> None:
    pixels = lit(190.0, 190.0)
    pixels[:, 30:] = 190 + 3 * MAX_STEP  # two surfaces, both known in part
    both = known() | known(np.s_[:, 45:])
    assert grow_floor(pixels, both).all()
    assert not grow_floor(pixels, known())[:, 32:].any()


def test_edge_pixels_are_no_surface() -> None:
    """Even if many pixels of a pattern have colours of the floor."""
    pixels = lit(190.0, 190.0)
    pattern = np.indices((HIGH, 30))[1] // 3 % 2 * 90 + 100
    pixels[:, 30:] = pattern[..., None]
    like = known() | known(np.s_[:, 30:])
    like[:, 30:] &= pattern == 190
    grown = grow_floor(pixels, like)
    assert grown[:, :27].all()
    assert not grown[:, 36:58][pattern[:, 6:28] == 100].any()
