"""Test what motors of a published model bear, beside what MuJoCo makes."""

from math import inf

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stepaside.fitting.motor_data import (
    plausible_torques,
    published_torques,
    published_values,
)

GEAR = st.floats(0.5, 200.0).flatmap(lambda g: st.sampled_from([g, -g]))
TORQUE = st.floats(0.5, 90.0)
MODEL = """
<mujoco><option gravity="0 0 0"/><worldbody><body><geom size="0.1"/>
<joint name="knee" type="hinge" axis="0 1 0" {joint}/></body></worldbody>
<actuator>{actuator}</actuator></mujoco>
"""


def made(actuator: str, joint: str = "") -> mujoco.MjSpec:
    """A model of one joint with one actuator."""
    text = MODEL.format(actuator=actuator, joint=joint)
    return mujoco.MjSpec.from_string(text)


def greatest(spec: mujoco.MjSpec) -> float:
    """Greatest torque that MuJoCo lets the joint have, in [N m]."""
    model = spec.compile()
    data = mujoco.MjData(model)
    found = 0.0
    for ctrl in (-1e6, -1.0, 1.0, 1e6):
        data.ctrl[:] = ctrl
        mujoco.mj_forward(model, data)
        found = max(found, float(np.abs(data.qfrc_actuator).max()))
    return found


@settings(max_examples=20)
@given(GEAR, TORQUE, st.sampled_from(["general", "motor"]))
def test_a_force_range_acts_through_the_gear(
    gear: float, force: float, kind: str
) -> None:
    spec = made(
        f'<{kind} joint="knee" gear="{gear}" '
        f'forcelimited="true" forcerange="-{force} {force}"/>'
    )
    assert published_torques(spec) == pytest.approx({"knee": greatest(spec)})
    assert greatest(spec) == pytest.approx(abs(gear) * force)


@settings(max_examples=20)
@given(GEAR, TORQUE, st.floats(0.5, 30.0))
def test_the_range_of_a_command_acts_through_gear_and_gain(
    gear: float, most: float, gain: float
) -> None:
    spec = made(
        f'<general joint="knee" gear="{gear}" gainprm="{gain}" '
        f'ctrllimited="true" ctrlrange="-{most} {most}"/>'
    )
    assert published_torques(spec) == pytest.approx({"knee": greatest(spec)})


@settings(max_examples=20)
@given(GEAR, TORQUE)
def test_the_force_range_of_a_joint_counts_without_any_gear(
    gear: float, torque: float
) -> None:
    """It bounds what all actuators make of it together."""
    spec = made(
        f'<position joint="knee" gear="{gear}" kp="1e5"/>',
        f'actuatorfrclimited="true" actuatorfrcrange="-{torque} {torque}"',
    )
    assert published_torques(spec) == pytest.approx({"knee": greatest(spec)})


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


def test_a_model_without_gains_and_keyframes_publishes_none() -> None:
    assert published_values(made('<motor joint="knee"/>')) == {}
