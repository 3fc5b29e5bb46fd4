"""Test the correction of joint errors."""

import numpy as np
import pytest

from stepaside.core.poses import Array
from stepaside.locomotion.control_settings import StabiliserSettings
from stepaside.locomotion.zmp.stabiliser import JointCorrection

TICK = 0.01


def correction(gain: float = 4.0, delay: float = 0.0) -> JointCorrection:
    gains = StabiliserSettings(joint_gain=gain, joint_leak=0.5)
    return JointCorrection(gains, tick=TICK, delay=delay)


def hold(joints: JointCorrection, missing: Array, ticks: int) -> Array:
    """Ask for the same, always missed by the same; the last correction."""
    targets = np.array([0.2, -0.3])
    corrected = targets
    for _ in range(ticks):
        corrected = joints.update(targets - missing, targets)
    added: Array = corrected - targets
    return added


def test_a_lasting_miss_settles_where_gain_and_leak_balance() -> None:
    """The joint stays off by what the play leaves: gain / leak of it."""
    joints = correction(gain=1.0)
    added = hold(joints, np.array([0.002, -0.002]), 5000)
    np.testing.assert_allclose(added, [0.004, -0.004], rtol=1e-6)


def test_a_servo_that_answers_too_late_is_not_mistaken_for_play() -> None:
    """The measured angle is the target of one delay and one ramp before."""
    delay = 0.03
    joints = correction(delay=delay)
    lag = round(delay / TICK) + 2
    asked = [np.array([0.1 * np.sin(0.3 * i)]) for i in range(60)]
    for i, targets in enumerate(asked):
        measured = asked[max(i - lag, 0)]
        corrected = joints.update(measured, targets)
        np.testing.assert_allclose(corrected, targets, atol=1e-15)


def test_a_correction_that_is_no_longer_needed_fades() -> None:
    joints, targets = correction(), np.array([0.1])
    for _ in range(50):
        joints.update(np.zeros(1), targets)
    for _ in range(5):
        first = joints.update(targets, targets)[0] - 0.1
    ticks = 200
    for _ in range(ticks):
        last = joints.update(targets, targets)[0] - 0.1
    assert first > 0.001
    assert last == pytest.approx(first * (1.0 - 0.5 * TICK) ** ticks)
