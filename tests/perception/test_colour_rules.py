"""Test the rules of the colour detector for trim and for robots."""

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray

from stepaside.perception.camera_model import CameraModel
from stepaside.perception.colour_detector import (
    BLUE,
    RED,
    Appearance,
    ColourDetection,
    ColourDetector,
    check_group,
    smoothed_hsv,
)
from stepaside.perception.images import ColourImage, Pixels

CAMERA = CameraModel.of_field_of_view(320, 240, 1.063, 0.831)
Patch = tuple[int, int, int, int, int]  # left, top, right, bottom, area


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


def boxes(*patches: Patch) -> NDArray[np.int32]:
    return np.array(patches, dtype=np.int32)


def patch(
    left: int, top: int, width: int, height: int, share: float = 0.75
) -> Patch:
    """Patch that fills a share of its box."""
    area = round(share * width * height)
    return left, top, left + width, top + height, area


# Ears, shoulders, arms, a belt, and legs: 100 pixels high, 80 wide.
TRIM = (
    patch(148, 40, 8, 10),
    patch(164, 40, 8, 10),
    patch(120, 60, 16, 20),
    patch(184, 60, 16, 20),
    patch(155, 84, 10, 10),
    patch(140, 120, 14, 20),
    patch(166, 120, 14, 20),
    patch(156, 112, 8, 8),
)


def judge(*patches: Patch) -> ColourDetection | None:
    return check_group(boxes(*patches), CAMERA)


def ends(found: ColourDetection | None) -> tuple[float, ...]:
    assert found is not None
    return found.left, found.top, found.right, found.bottom


def test_a_detection_spans_all_trim() -> None:
    found = judge(*TRIM)
    assert ends(found) == (120, 40, 200, 140)
    assert found is not None and found.column == 160.0
    assert found.confidence == 1.0
    assert not (found.cut_above or found.cut_below or found.cut_aside)
    fewer = judge(*TRIM[:-1])
    assert fewer is not None and fewer.confidence == 7 / 8
    more = judge(*TRIM, patch(150, 100, 8, 8))
    assert more is not None and more.confidence == 1.0
    assert judge(TRIM[2]) is None


@pytest.mark.parametrize(
    ("share", "size", "same"),
    [(0.9, 28, True), (0.8, 28, False), (0.9, 14, False)],
)
def test_large_square_patches_are_removed(
    share: float, size: int, same: bool
) -> None:
    """Large is 2.5 times the median patch; round ones fill 0.79 of a box."""
    box = patch(210, 90, size, size, share)
    assert (ends(judge(*TRIM, box)) == ends(judge(*TRIM))) is same


@pytest.mark.parametrize(("tall", "same"), [(58, False), (62, True)])
def test_tall_patches_are_removed(tall: int, same: bool) -> None:
    """It may be 0.6 of the height of all trim."""
    post = patch(204, 60, 6, tall)
    assert (ends(judge(*TRIM, post)) == ends(judge(*TRIM))) is same


def test_cut_edges_are_reported() -> None:
    """Below, 0.1 of the height may be missing: trim ends above the feet."""

    def moved(x: int, y: int) -> ColourDetection:
        group = [(a + x, b + y, c + x, d + y, e) for a, b, c, d, e in TRIM]
        found = judge(*group)
        assert found is not None
        return found

    assert moved(0, -39).cut_above and not moved(0, -38).cut_above
    assert moved(0, 89).cut_below and not moved(0, 88).cut_below
    assert moved(-119, 0).cut_aside and not moved(-118, 0).cut_aside
    assert moved(119, 0).cut_aside and not moved(118, 0).cut_aside
    assert not moved(-119, 0).cut_above and not moved(0, 89).cut_aside


@pytest.mark.parametrize(("width", "found"), [(205, True), (215, False)])
def test_a_group_wider_than_two_robots_is_rejected(
    width: int, found: bool
) -> None:
    corners = [(50, 60), (50 + width - 20, 60), (100, 100), (150, 140)]
    group = [patch(x, y, 20, 20) for x, y in corners]
    assert (judge(*group) is not None) is found
    # Cut off above, it may be taller than it looks.
    cut = [patch(x, y - 60, 20, 20) for x, y in corners]
    assert judge(*cut) is not None
    # As may be one that is cut off below.
    cut = [patch(x, y + 80, 20, 20) for x, y in corners]
    assert judge(*cut) is not None


@pytest.mark.parametrize(("area", "found"), [(430, True), (470, False)])
def test_trim_fills_less_than_half_of_its_box(area: int, found: bool) -> None:
    """Nine patches in a square of 90 pixels: 0.48 and 0.52 of it."""
    grid = [
        (100 + 30 * i, 60 + 30 * j, 130 + 30 * i, 90 + 30 * j, area)
        for i in range(3)
        for j in range(3)
    ]
    assert (judge(*grid) is not None) is found


EAR, SHOULDER = patch(150, 60, 12, 12), patch(146, 82, 20, 20)


def test_ear_and_shoulder_are_a_profile_in_any_order() -> None:
    for pair in ((EAR, SHOULDER), (SHOULDER, EAR)):
        found = judge(*pair)
        assert ends(found) == (146, 60, 166, 102)
        assert found is not None and found.confidence == 0.25


@pytest.mark.parametrize(
    ("shoulder", "found"),
    [
        (patch(146, 72, 20, 20, 0.4), True),  # it touches
        (patch(146, 71, 20, 20, 0.4), False),  # it overlaps
        (patch(146, 91, 20, 20), True),
        (patch(146, 92, 20, 20), False),  # the gap is as wide as it
        (patch(157, 82, 20, 20), True),
        (patch(159, 82, 20, 20), False),  # aside by 0.6 of its width
        (patch(135, 82, 20, 20), True),
        (patch(133, 82, 20, 20), False),
        (patch(146, 90, 20, 20, 0.86), False),  # a square one
        (patch(146, 90, 20, 20, 0.84), True),
        (patch(144, 82, 24, 24, 0.74), True),
        (patch(144, 82, 24, 24, 0.76), False),  # four times as large
    ],
)
def test_two_other_patches_are_no_robot(shoulder: Patch, found: bool) -> None:
    assert (judge(EAR, shoulder) is not None) is found


def scene(*blots: tuple[int, int, int, int], wide: int = 320) -> ColourImage:
    """A grey image with rectangles of red: left, top, width, height."""
    pixels = np.full((240, wide, 3), 180, dtype=np.uint8)
    for left, top, width, height in blots:
        pixels[top : top + height, left : left + width] = (200, 40, 35)
    camera = CameraModel(wide, 240, 260.0, 260.0)
    return ColourImage(0.0, camera, pixels)


SPREAD = [(100, 60, 20, 20), (160, 60, 20, 20), (100, 120, 20, 20)]


@pytest.mark.parametrize(
    ("width", "height", "counts"), [(5, 2, True), (3, 3, False)]
)
def test_specks_below_the_minimum_area_are_ignored(
    width: int, height: int, counts: bool
) -> None:
    """Blurred, six pixels of the one pass as red and five of the other."""
    (plain,) = ColourDetector(RED).detect_all(scene(*SPREAD), most=1)
    image = scene(*SPREAD, (185, 66, width, height))
    (found,) = ColourDetector(RED).detect_all(image, most=1)
    assert plain.right == pytest.approx(180, abs=1)
    assert (found.right > plain.right) is counts


def test_the_tallest_of_several_robots_is_detected() -> None:
    small = [(x // 2 + 200, y // 2 + 10, 10, 10) for x, y, _, _ in SPREAD]
    large = [(x - 95, y + 60, a, b) for x, y, a, b in SPREAD]
    for blots in (small + large, large + small):
        (found,) = ColourDetector(RED).detect_all(scene(*blots), most=1)
        assert found.right < 100
    upside = [(x, 230 - y, a, b) for x, y, a, b in small + large]
    (found,) = ColourDetector(RED).detect_all(scene(*upside), most=1)
    assert found.right < 100
