"""Test the detection of trim in drawn images."""

import cv2
import numpy as np
import pytest

from stepaside.perception.camera_model import CameraModel
from stepaside.perception.colour_detector import (
    BLUE,
    RED,
    Appearance,
    ColourDetector,
)
from stepaside.perception.images import ColourImage, Pixels

CAMERA = CameraModel.of_field_of_view(320, 240, 1.063, 0.831)
PAINT = {"red": (200, 40, 35), "blue": (26, 92, 190)}
LOOKS = {"red": RED, "blue": BLUE}
# Patches of a robot 1 high: place (x rightward, y downward) and half axes.
TRIM = (
    ((-0.14, 0.08), (0.02, 0.06)),
    ((0.14, 0.08), (0.02, 0.06)),
    ((-0.20, 0.26), (0.07, 0.07)),
    ((0.20, 0.26), (0.07, 0.07)),
    ((0.00, 0.34), (0.05, 0.09)),
    ((-0.08, 0.68), (0.06, 0.06)),
    ((0.08, 0.68), (0.06, 0.06)),
    ((-0.08, 0.90), (0.06, 0.07)),
    ((0.08, 0.90), (0.06, 0.07)),
)


def empty() -> Pixels:
    """A grey room with noise."""
    noise = np.random.default_rng(1).normal(0.0, 4.0, (240, 320, 3))
    return np.clip(180.0 + noise, 0, 255).astype(np.uint8)


def draw_robot(pixels: Pixels, colour: str, at: int, tall: int) -> None:
    """Draw a white figure with trim, its axis at a column."""
    top = 150 - tall // 2
    body = (at, top + tall // 2), (tall // 4, tall // 2)
    cv2.ellipse(pixels, *body, 0, 0, 360, (240, 240, 238), -1)
    for (x, y), (a, b) in TRIM:
        middle = round(at + x * tall), round(top + y * tall)
        size = max(1, round(a * tall)), max(1, round(b * tall))
        cv2.ellipse(pixels, middle, size, 0, 0, 360, PAINT[colour], -1)


def draw_box(pixels: Pixels, colour: str, at: int, tall: int) -> None:
    """Draw a box of a colour."""
    corner = (at - tall // 3, 120)
    cv2.rectangle(
        pixels, corner, (at + tall // 3, 120 + tall), PAINT[colour], -1
    )


def look_for(appearance: Appearance, pixels: Pixels) -> float | None:
    image = ColourImage(0.0, CAMERA, pixels)
    found = ColourDetector(appearance).detect(image)
    return None if found is None else found.column


@pytest.mark.parametrize("colour", PAINT)
@pytest.mark.parametrize("tall", [60, 100, 160])
@pytest.mark.parametrize("at", [90, 160, 230])
def test_a_robot_is_detected_at_its_axis(
    colour: str, tall: int, at: int
) -> None:
    pixels = empty()
    draw_robot(pixels, colour, at, tall)
    assert look_for(LOOKS[colour], pixels) == pytest.approx(at, abs=2.0)


def test_of_several_robots_the_tallest_is_detected() -> None:
    pixels = empty()
    for at, tall in ((70, 80), (160, 110), (250, 90)):
        draw_robot(pixels, "red", at, tall)
    assert look_for(RED, pixels) == pytest.approx(160, abs=2.0)


def test_a_mirrored_image_mirrors_the_detection() -> None:
    pixels = empty()
    draw_robot(pixels, "red", 97, 110)
    column = look_for(RED, pixels)
    mirrored = look_for(RED, np.ascontiguousarray(pixels[:, ::-1]))
    assert column is not None
    assert mirrored == pytest.approx(320 - column, abs=0.5)


@pytest.mark.parametrize("colour", PAINT)
def test_boxes_and_figures_without_this_trim_are_no_robot(colour: str) -> None:
    other = "blue" if colour == "red" else "red"
    for tall in (30, 60, 100):
        pixels = empty()
        draw_box(pixels, colour, 80, tall)
        draw_robot(pixels, other, 200, 110)
        assert look_for(LOOKS[colour], pixels) is None


@pytest.mark.parametrize("gap", [-20, 15, 30, 60])
@pytest.mark.parametrize("tall", [30, 50])
def test_a_box_beside_a_robot_does_not_move_it(gap: int, tall: int) -> None:
    pixels = empty()
    draw_box(pixels, "red", 160 + 30 + gap + tall // 3, tall)
    draw_robot(pixels, "red", 160, 120)
    assert look_for(RED, pixels) == pytest.approx(160, abs=8.0)


def test_a_cut_by_an_image_edge_is_reported() -> None:
    pixels = empty()
    draw_robot(pixels, "blue", 160, 260)
    image = ColourImage(0.0, CAMERA, pixels)
    found = ColourDetector(BLUE).detect(image)
    assert found is not None
    assert found.cut_below
    assert not found.cut_aside


def pale(colour: str) -> tuple[int, ...]:
    """Paint as a pixel shows it that it covers in part."""
    return tuple(round(0.45 * c + 0.55 * 240) for c in PAINT[colour])


def draw_ears(pixels: Pixels, paint: tuple[int, ...], at: int) -> None:
    """Paint over the ears of a robot 100 high."""
    for x, y in ((-0.14, 0.08), (0.14, 0.08)):
        middle = round(at + 100 * x), round(100 + 100 * y)
        cv2.ellipse(pixels, middle, (2, 6), 0, 0, 360, paint, -1)


@pytest.mark.parametrize("colour", PAINT)
def test_one_pixel_wide_ears_are_the_upper_end(colour: str) -> None:
    """Otherwise such a robot appears a seventh farther away."""
    detector = ColourDetector(LOOKS[colour])
    tops = []
    for paint in (PAINT[colour], pale(colour), (240, 240, 238)):
        pixels = empty()
        draw_robot(pixels, colour, 160, 100)
        draw_ears(pixels, paint, 160)
        image = ColourImage(0.0, CAMERA, pixels)
        found = detector.detect(image)
        assert found is not None
        tops.append(found.top)
    strong, faint, absent = tops
    assert faint == pytest.approx(strong, abs=2.0)
    assert absent > strong + 10.0
