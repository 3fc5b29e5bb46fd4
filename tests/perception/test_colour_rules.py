"""Test the rules of the colour detector for trim and for robots."""

import cv2
import numpy as np
import pytest

from stepaside.perception.colour_detector import (
    BLUE,
    RED,
    Appearance,
    ColourDetector,
    smoothed_hsv,
)
from stepaside.perception.images import Pixels


def paint(hue: int, saturation: int, value: int) -> Pixels:
    """Flat image of a colour, on OpenCV's scales."""
    hsv = np.full((9, 9, 3), (hue, saturation, value), dtype=np.uint8)
    return np.asarray(cv2.cvtColor(hsv, cv2.COLOR_HSV2RGB), dtype=np.uint8)


def is_trim(look: Appearance, pixels: Pixels) -> bool:
    mask = ColourDetector(look).mask(smoothed_hsv(pixels))
    assert mask.min() == mask.max()
    assert mask.max() in (0, 255)
    return bool(mask.max())


@pytest.mark.parametrize(
    ("look", "middle", "width"), [(RED, 0, 9), (BLUE, 108, 8)]
)
def test_hues_wrap_around(look: Appearance, middle: int, width: int) -> None:
    """Red lies on both sides of its seam."""
    for hue in range(180):
        pixels = paint(hue, 220, 180)
        shown = cv2.cvtColor(pixels, cv2.COLOR_RGB2HSV)[0, 0, 0]
        away = abs((int(shown) - middle + 90) % 180 - 90)
        assert is_trim(look, pixels) is (away <= width), hue


@pytest.mark.parametrize(("look", "least"), [(RED, 110), (BLUE, 125)])
def test_pale_and_dark_colours_are_not_trim(
    look: Appearance, least: int
) -> None:
    for hue in (look.hue, (look.hue + 176) % 180):
        assert is_trim(look, paint(hue, least + 5, 200))
        assert not is_trim(look, paint(hue, least - 5, 200))
    assert is_trim(look, paint(look.hue, 255, 47))
    assert not is_trim(look, paint(look.hue, 255, 43))
