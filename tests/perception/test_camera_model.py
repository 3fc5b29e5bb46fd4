"""Test the pinhole camera."""

from math import radians, tan

import numpy as np
import pytest

from stepaside.core.errors import ConfigurationError
from stepaside.perception.camera_model import CameraModel

XTION = CameraModel.of_field_of_view(80, 60, radians(58.0), radians(45.0))


def test_projection_inverts_rays() -> None:
    rays = XTION.rays().reshape(-1, 3)
    columns, rows = XTION.project(2.7 * rays).T
    u, v = np.meshgrid(np.arange(80) + 0.5, np.arange(60) + 0.5)
    np.testing.assert_allclose(columns, u.ravel(), atol=1e-9)
    np.testing.assert_allclose(rows, v.ravel(), atol=1e-9)


@pytest.mark.parametrize(
    "change", [{"width": 2}, {"horizontal": 3.2}, {"vertical": float("nan")}]
)
def test_impossible_cameras_are_refused(change: dict[str, float]) -> None:
    values = {"width": 80, "height": 60, "horizontal": 1.0, "vertical": 0.8}
    with pytest.raises(ConfigurationError, match="must lie in"):
        CameraModel.of_field_of_view(**(values | change))  # type: ignore[arg-type]


def test_axes_are_forward_left_and_up() -> None:
    (center, left, above) = XTION.project(
        [[2.0, 0.0, 0.0], [2.0, 0.5, 0.0], [2.0, 0.0, 0.5]]
    )
    assert center == pytest.approx((40.0, 30.0))
    assert left[0] == pytest.approx(40.0 - 40.0 / tan(radians(29.0)) / 4.0)
    assert left[1] == pytest.approx(30.0)
    assert above[1] == pytest.approx(30.0 - 30.0 / tan(radians(22.5)) / 4.0)
    assert above[0] == pytest.approx(40.0)


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_an_image_ends_on_all_four_sides(side: float) -> None:
    inside, outside = tan(radians(22.4)), tan(radians(22.6))
    assert XTION.sees([1.0, 0.0, side * inside])
    assert not XTION.sees([1.0, 0.0, side * outside])
    inside, outside = tan(radians(28.9)), tan(radians(29.1))
    assert XTION.sees([1.0, side * inside, 0.0])
    assert not XTION.sees([1.0, side * outside, 0.0])


def test_the_calibration_matrix_projects_as_the_camera_does() -> None:
    """Pixel centres are at whole numbers in ROS, at halves here."""
    camera = CameraModel.of_field_of_view(320, 240, 0.9, 0.7)
    point = np.array([2.0, 0.3, -0.2])  # ahead, left, up
    right_down_ahead = np.array([-point[1], -point[2], point[0]])
    u, v, w = camera.calibration_matrix @ right_down_ahead
    column, row = camera.project(point)[0]
    np.testing.assert_allclose((u / w + 0.5, v / w + 0.5), (column, row))
