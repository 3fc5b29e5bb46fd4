"""Test that the points of a geom reach as far as the geom does."""

from collections.abc import Callable

import mujoco
import numpy as np
import pytest

from stepaside.core.poses import Array
from stepaside.robots.geom_points import geom_points_in_world

SIZE = np.array([0.3, 0.2, 0.1])
QUAT = "0.8 0.3 -0.4 0.2"
PLACE = np.array([1.0, -2.0, 0.5])
# How far each shape reaches along the axes of the world from its middle, by
# the axes of the shape in its columns.
REACHES: dict[str, Callable[[Array], Array]] = {
    "box": lambda axes: np.abs(axes) @ SIZE,
    "sphere": lambda axes: np.full(3, SIZE[0]),
    "ellipsoid": lambda axes: np.sqrt((axes**2) @ SIZE**2),
    "capsule": lambda axes: SIZE[0] + SIZE[1] * np.abs(axes[:, 2]),
    "cylinder": lambda axes: (
        SIZE[0] * np.sqrt(1.0 - axes[:, 2] ** 2) + SIZE[1] * np.abs(axes[:, 2])
    ),
}


def points(geom: str, assets: str = "") -> tuple[Array, Array]:
    """Points of a geom that is turned, and its axes."""
    model = mujoco.MjModel.from_xml_string(
        f'<mujoco><asset>{assets}</asset><worldbody><body pos="1 -2 0.5" '
        f'quat="{QUAT}"><geom {geom}/></body></worldbody></mujoco>'
    )
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return geom_points_in_world(model, data, 0), data.geom_xmat[0].reshape(
        3, 3
    )


@pytest.mark.parametrize("kind", REACHES)
def test_points_span_the_geom(kind: str) -> None:
    """Points on the rims of a cylinder are 15 degrees apart."""
    found, axes = points(f'type="{kind}" size="0.3 0.2 0.1"')
    reach = REACHES[kind](axes)
    slack = 0.01 * SIZE[0] if kind == "cylinder" else 1e-12
    for sign in (1.0, -1.0):
        far = (sign * (found - PLACE)).max(axis=0)
        assert (far <= reach + 1e-12).all()
        np.testing.assert_allclose(far, reach, rtol=0.0, atol=slack)
