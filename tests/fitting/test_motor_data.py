"""Test what motors of a published model bear, beside what MuJoCo makes."""

from math import inf

import mujoco
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stepaside.fitting.motor_data import plausible_torques, published_values


@settings(max_examples=20)
@given(st.floats(1.0, 100.0), st.floats(0.2, 2.0), st.floats(0.1, 50.0))
def test_plausible_torques_scale_with_weight_and_length(
    mass: float, length: float, share: float
) -> None:
    """A torque is no number for none below ten times what tips a robot."""
    tips = mass * 9.81 * length
    told = {"knee": share * tips, "none": inf}
    kept = plausible_torques(told, mass, length)
    if abs(share - 10.0) > 0.01:
        assert ("knee" in kept) == (share < 10.0)
    assert "none" not in kept


def test_gains_and_posture_are_those_that_mujoco_applies() -> None:
    """Of position actuators and joints, and of the standing keyframe."""
    spec = mujoco.MjSpec.from_string(
        """<mujoco><worldbody><body><freejoint/><geom size="0.1"/>
        <body><geom size="0.1"/><joint name="hip" damping="0.5"/>
        <body><geom size="0.1"/><joint name="knee"/></body></body></body>
        </worldbody><actuator>
        <position joint="hip" kp="80" kv="2"/><motor joint="knee"/></actuator>
        <keyframe><key name="lies"/>
        <key name="stand" qpos="0 0 1 1 0 0 0 -0.2 0.4"/>
        </keyframe></mujoco>"""
    )
    found = published_values(spec)
    assert found == {
        "stiffness": {"hip": 80.0},
        "damping": {"hip": 2.5},
        "default_posture": {"hip": -0.2, "knee": 0.4},
    }
    model = spec.compile()
    data = mujoco.MjData(model)
    data.qpos[7], data.qvel[6] = 0.1, 1.0
    mujoco.mj_forward(model, data)
    torque = data.qfrc_actuator[6] + data.qfrc_passive[6]
    assert torque == pytest.approx(-80.0 * 0.1 - 2.5)
