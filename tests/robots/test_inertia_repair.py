"""Test inertias that no body has, mended so that a model compiles."""

import mujoco
import numpy as np
import pytest

from stepaside.robots.model_overlay import repair_inertias

LINK = (
    '<mujoco><worldbody><body name="link"><joint name="turn"/>'
    '<inertial mass="{mass}" pos="0 0 0" fullinertia="{full}"/>'
    "</body></worldbody></mujoco>"
)


def spec_of(mass: float, full: str) -> mujoco.MjSpec:
    """A model of one link."""
    return mujoco.MjSpec.from_string(LINK.format(mass=mass, full=full))


@pytest.mark.parametrize(
    "full", ["0 0 0 0 0 1e-20", "0.01 0.01 -0.002 0 0 0", "1e-20 0 0 0 0 0"]
)
def test_an_invalid_inertia_compiles_after_repair(full: str) -> None:
    spec = spec_of(0.3, full)
    with pytest.raises(ValueError, match="eigenvalue|inertia"):
        spec_of(0.3, full).compile()
    repair_inertias(spec)
    model = spec.compile()
    moments = np.sort(model.body_inertia[1])
    assert moments[0] > 0.0 and moments[0] + moments[1] >= moments[2] * 0.999
    assert model.body_mass[1] == 0.3


@pytest.mark.parametrize(
    "how", ["fullinertia='{0} {0} {0} 0 0 0'", "diaginertia='{0} {0} {0}'"]
)
def test_inertias_in_wrong_units_are_replaced_by_typical_ones(
    how: str,
) -> None:
    """One of masses 20 m away tells that those of 0.3 m are wrong, too."""

    def model(worst: float) -> mujoco.MjSpec:
        rows = [how.format(moment) for moment in (worst, 0.1, 0.1, 1e-4)]
        return mujoco.MjSpec.from_string(
            "<mujoco><worldbody><body name='torso'><freejoint/>"
            f"<inertial mass='1' pos='0 0 0' {rows[0]}/>"
            "<body name='hip' pos='0 0 -0.1'><joint name='roll'/>"
            f"<inertial mass='1' pos='0 0 0' {rows[1]}/>"
            "<body name='thigh'><joint name='pitch'/>"
            f"<inertial mass='1' pos='0 0 0' {rows[2]}/>"
            "<body name='shank' pos='0 0 -0.2'><joint name='knee'/>"
            f"<inertial mass='1' pos='0 0 0' {rows[3]}/>"
            "</body></body></body></body></worldbody></mujoco>"
        )

    spec = model(400.0)
    repair_inertias(spec)
    moments = spec.compile().body_inertia[1:, 0]
    np.testing.assert_allclose(moments, [0.0016, 0.0016, 0.0064, 1e-4])
    spec = model(0.3)  # large for such a robot, but who knows
    repair_inertias(spec)
    np.testing.assert_allclose(spec.compile().body_inertia[2], 0.1)
