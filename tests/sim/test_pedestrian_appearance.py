"""Test the body of a person: size, gait and role in a duel."""

import mujoco
import numpy as np
import pytest

from stepaside.core.poses import Array, Pose
from stepaside.sim.person_body import (
    PARTS,
    add_person,
    mocap_indices,
    set_person_pose,
)


def figure() -> tuple[mujoco.MjModel, mujoco.MjData]:
    spec = mujoco.MjSpec()
    add_person(spec, "her")
    model = spec.compile()
    return model, mujoco.MjData(model)


def posed(frame: Pose, way: float) -> tuple[mujoco.MjModel, mujoco.MjData]:
    model, data = figure()
    set_person_pose(data, mocap_indices(model, "her"), frame, way)
    mujoco.mj_kinematics(model, data)
    return model, data


def box(model: mujoco.MjModel, data: mujoco.MjData, *names: str) -> Array:
    """Least and greatest corner of parts. Shape (2, 3)."""
    ends = []
    for name in names:
        body = model.body(f"her/{name}").id
        for geom in np.flatnonzero(model.geom_bodyid == body):
            radius, half = model.geom_size[geom, :2]
            axis = half * data.geom_xmat[geom].reshape(3, 3)[:, 2]
            for end in (-axis, axis):
                place = data.geom_xpos[geom] + end
                ends += [place - radius, place + radius]
    return np.array([np.min(ends, axis=0), np.max(ends, axis=0)])


STANDING = Pose(0.0, 0.0, 0.0)


def test_a_person_has_human_size() -> None:
    model, data = posed(STANDING, 0.0)
    low, high = box(model, data, *PARTS)
    assert low[2] == pytest.approx(0.0, abs=0.01)
    assert high[2] == pytest.approx(1.74, abs=0.01)
    np.testing.assert_allclose((low[1], high[1]), (-0.295, 0.295), atol=5e-3)
    low, high = box(model, data, "trunk")
    np.testing.assert_allclose((low[1], high[1]), (-0.23, 0.23), atol=1e-9)
    np.testing.assert_allclose((low[0], high[0]), (-0.15, 0.15), atol=1e-9)
    assert low[2] == pytest.approx(0.8)  # hips overlap with the legs
    low, high = box(model, data, "left leg")
    np.testing.assert_allclose((low[0], high[0]), (-0.085, 0.185), atol=1e-9)
    np.testing.assert_allclose((low[1], high[1]), (0.025, 0.155), atol=1e-9)
    assert high[2] == pytest.approx(0.965)
    low, high = box(model, data, "left arm")
    assert low[2] == pytest.approx(1.42 - 0.55 - 0.045)
    assert high[2] == pytest.approx(1.465)
    assert low[1] == pytest.approx(0.195)
    assert high[0] == pytest.approx(0.075)
