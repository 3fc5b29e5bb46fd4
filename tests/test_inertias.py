"""Test inertias that no body has, mended so that a model compiles."""

import mujoco
import numpy as np
import pytest

from stepaside.robots.inertias import mend_inertias

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
def test_an_inertia_that_is_none_compiles_once_mended(full: str) -> None:
    spec = spec_of(0.3, full)
    with pytest.raises(ValueError, match="eigenvalue|inertia"):
        spec_of(0.3, full).compile()
    assert mend_inertias(spec) == ["link"]
    model = spec.compile()
    moments = np.sort(model.body_inertia[1])
    assert moments[0] > 0.0 and moments[0] + moments[1] >= moments[2] * 0.999
    assert model.body_mass[1] == 0.3


def test_a_link_without_mass_gets_hardly_any() -> None:
    spec = spec_of(0.0, "0 0 0 0 0 0")
    mend_inertias(spec)
    model = spec.compile()
    assert 0.0 < model.body_mass[1] <= 1e-6


def test_an_inertia_that_can_be_stays_as_it_is() -> None:
    spec = spec_of(2.0, "0.02 0.03 0.025 0.001 -0.002 0.003")
    before = np.array(spec.body("link").fullinertia)
    assert mend_inertias(spec) == []
    np.testing.assert_array_equal(spec.body("link").fullinertia, before)
