"""Test the ranges of sensors and scenes."""

from math import degrees
from typing import Any

import numpy as np
import pytest

from stepaside.core.errors import ConfigurationError
from stepaside.perception.camera_model import CameraModel
from stepaside.sim.camera_settings import (
    CameraSettings,
    ColourSettings,
    DepthSettings,
    RoomObject,
)


@pytest.mark.parametrize(
    ("kind", "values", "words"),
    [
        (DepthSettings, {"near": 3.0, "far": 2.0}, r"far must lie in \[3"),
        (RoomObject, {"kind": "red ball", "x": 0.0, "y": 0.0}, "'red ball'"),
    ],
)
def test_values_out_of_range_are_refused(
    kind: Any, values: dict[str, Any], words: str
) -> None:
    with pytest.raises(ConfigurationError, match=words):
        kind(**values)


def field_of_view(kind: ColourSettings | DepthSettings) -> tuple[float, ...]:
    model = CameraModel.of_field_of_view(kind.width, kind.height, *kind.view)
    assert (model.width, model.height) == (kind.width, kind.height)
    return (
        degrees(2.0 * np.arctan(0.5 * model.width / model.focal_x)),
        degrees(2.0 * np.arctan(0.5 * model.height / model.focal_y)),
    )


def test_optics_are_those_of_the_vendors() -> None:
    """SoftBank's for NAO, ASUS's for the Xtion, RealSense's for the D455."""
    assert field_of_view(ColourSettings()) == pytest.approx((60.9, 47.6))
    six = ColourSettings(optics="v6")
    assert field_of_view(six) == pytest.approx((54.7, 42.5))
    assert field_of_view(DepthSettings()) == pytest.approx((58.0, 45.0))
    rear = CameraSettings().rear
    assert field_of_view(rear) == pytest.approx((87.0, 58.0))
    assert (rear.near, rear.far) == (0.6, 6.0)
    with pytest.raises(ConfigurationError, match="got 'v7'"):
        ColourSettings(optics="v7")
