"""Test the pinhole camera."""

from math import degrees, radians, tan

import numpy as np
import pytest

from stepaside.errors import ConfigurationError
from stepaside.sensing.camera_model import CameraModel

XTION = CameraModel.of_field_of_view(80, 60, radians(58.0), radians(45.0))


def test_edges_look_along_the_field_of_view() -> None:
    left = XTION.ray(0.0, 30.0)
    top = XTION.ray(40.0, 0.0)
    assert degrees(np.arctan2(left[1], left[0])) == pytest.approx(29.0)
    assert degrees(np.arctan2(top[2], top[0])) == pytest.approx(22.5)


def test_projection_undoes_rays() -> None:
    rays = XTION.rays().reshape(-1, 3)
    columns, rows = XTION.project(2.7 * rays).T
    u, v = np.meshgrid(np.arange(80) + 0.5, np.arange(60) + 0.5)
    np.testing.assert_allclose(columns, u.ravel(), atol=1e-9)
    np.testing.assert_allclose(rows, v.ravel(), atol=1e-9)


def test_what_is_behind_is_not_seen() -> None:
    assert XTION.sees([1.0, 0.0, 0.0])
    assert not XTION.sees([-1.0, 0.0, 0.0])
    assert XTION.sees([1.0, tan(radians(28.9)), 0.0])
    assert not XTION.sees([1.0, tan(radians(29.1)), 0.0])


@pytest.mark.parametrize(
    "change", [{"width": 2}, {"horizontal": 3.2}, {"vertical": float("nan")}]
)
def test_impossible_cameras_are_refused(change: dict[str, float]) -> None:
    values = {"width": 80, "height": 60, "horizontal": 1.0, "vertical": 0.8}
    with pytest.raises(ConfigurationError, match="must lie in"):
        CameraModel.of_field_of_view(**(values | change))  # type: ignore[arg-type]
