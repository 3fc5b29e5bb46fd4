"""Test rotations against SciPy, and their signs."""

from math import nan, pi

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from stepaside.core.rotations import (
    angles_of,
    quaternion_of,
    rotation,
    rotation_about,
    rotation_of,
)


@pytest.mark.parametrize("seed", range(5))
def test_all_forms_are_those_of_scipy(seed: int) -> None:
    """Roll first, then pitch, then yaw, about axes that stay."""
    random = np.random.default_rng(seed)
    angles = (random.uniform(-pi, pi, 3) * [1, 0.5, 1]).tolist()
    wanted = Rotation.from_euler("xyz", angles)
    turn = wanted.as_matrix()
    np.testing.assert_allclose(rotation(*angles), turn, atol=1e-12)
    assert angles_of(turn) == pytest.approx(angles)
    w, *vector = quaternion_of(*angles)
    np.testing.assert_allclose(rotation_of([w, *vector]), turn, atol=1e-12)
    longer = [3.0 * part for part in (w, *vector)]
    np.testing.assert_allclose(rotation_of(longer), turn, atol=1e-12)
    about = wanted.as_rotvec()
    angle = float(np.linalg.norm(about))
    turned = rotation_about(about / angle, angle)
    np.testing.assert_allclose(turned, turn, atol=1e-12)


def test_signs_of_angles_are_those_of_a_robot() -> None:
    """Left ear up, nose down, turned to the left."""
    assert rotation(0.1, 0.0, 0.0)[2, 1] > 0.0
    assert rotation(0.0, 0.1, 0.0)[2, 0] < 0.0
    assert rotation(0.0, 0.0, 0.1)[1, 0] > 0.0


@pytest.mark.parametrize("pitch", [0.5 * pi, -0.5 * pi])
def test_angles_of_an_upright_rotation_give_it_again(pitch: float) -> None:
    turn = rotation(0.3, pitch, 0.8)
    np.testing.assert_allclose(rotation(*angles_of(turn)), turn, atol=1e-7)


@pytest.mark.parametrize("part", [0.0, nan, np.inf])
def test_a_quaternion_without_direction_is_no_rotation(part: float) -> None:
    assert np.isnan(rotation_of([part] * 4)).all()
