"""Test limits of joint targets and stiffness, and the lights."""

import numpy as np
import pytest

from lola_fakes import JOINTS, STANCE, sensor_frame
from stepaside.drivers.joint.joint_map import JointMap
from stepaside.drivers.joint.motion_states import (
    POSTURE_SPEED,
    JointMotionState,
)
from stepaside.drivers.joint.safety_state_machine import RobotState
from stepaside.drivers.joint.target_limits import (
    HOT,
    MIN_STIFFNESS,
    WARM,
    StiffnessRamp,
    TargetLimiter,
    derate_stiffness,
)
from stepaside.drivers.lola.conventions import joint_frame_of
from stepaside.drivers.lola.lights import COLOURS, lights_for
from stepaside.drivers.lola.lola_frames import ActuatorFrame, pack_actuators
from stepaside.drivers.lola.nao_joints import (
    CROUCH,
    HIGH,
    LOW,
    NAMES,
    NAO_MOTORS,
    SPEED,
    TICK,
)

ONES = np.ones(25)
KNEE = NAMES.index("LKneePitch")


def test_targets_within_reach_are_not_touched() -> None:
    middle = 0.5 * (LOW + HIGH)
    wanted = middle + np.minimum(0.9 * SPEED * TICK, 0.1)
    np.testing.assert_allclose(
        TargetLimiter(middle, NAO_MOTORS).toward(wanted), wanted
    )


def test_no_target_moves_faster_than_its_motor() -> None:
    limiter = TargetLimiter(np.zeros(25), NAO_MOTORS)
    got = limiter.toward(np.full(25, 100.0))
    limit = np.minimum(SPEED * TICK, HIGH - 0.01)
    np.testing.assert_allclose(got, limit)
    back = limiter.toward(np.full(25, -100.0))
    assert np.all(got - back <= SPEED * TICK + 1e-12)


@pytest.mark.parametrize("end", [-1e9, 1e9])
def test_no_target_leaves_its_range(end: float) -> None:
    limiter = TargetLimiter(np.zeros(25), NAO_MOTORS)
    for _ in range(500):
        got = limiter.toward(np.full(25, end))
    np.testing.assert_allclose(got, LOW + 0.01 if end < 0 else HIGH - 0.01)


def test_targets_that_are_not_finite_are_ignored() -> None:
    middle = 0.5 * (LOW + HIGH)
    wanted = np.full(25, np.nan)
    wanted[0] = np.inf
    got = TargetLimiter(middle, NAO_MOTORS).toward(wanted)
    np.testing.assert_array_equal(got, middle)


def test_a_cool_joint_has_all_its_torque_and_a_hot_one_half() -> None:
    def share(degrees: float, status: int = 0) -> float:
        hot = derate_stiffness(ONES, np.full(25, degrees), (status,) * 25)
        return float(hot[0])

    assert share(20.0) == share(WARM) == 1.0
    assert share(HOT) == share(HOT + 50.0) == MIN_STIFFNESS
    assert share(0.5 * (WARM + HOT)) == pytest.approx(
        0.5 * (1.0 + MIN_STIFFNESS)
    )
    assert share(20.0, status=3) == 0.0


def test_only_the_hot_joint_is_cut() -> None:
    temperature = np.full(25, 30.0)
    temperature[KNEE] = HOT
    cut = derate_stiffness(ONES, temperature, (0,) * 25)
    assert cut[KNEE] == MIN_STIFFNESS and cut.sum() == 24.0 + MIN_STIFFNESS


def test_stiffness_takes_a_second_to_grow_and_half_of_one_to_fade() -> None:
    ramp = StiffnessRamp(TICK)
    grown = [ramp.toward(1.0) for _ in range(84)]
    assert grown[0] == pytest.approx(TICK) and grown[-1] == 1.0
    assert grown[-2] < 1.0
    faded = [ramp.toward(0.0) for _ in range(42)]
    assert faded[-1] == 0.0 < faded[-2]


def motion_at(
    state: RobotState, ticks: int, start: np.ndarray
) -> JointMotionState:
    """A motion of a robot that follows its targets."""
    motion = JointMotionState(JointMap(JOINTS, NAO_MOTORS), STANCE, NAO_MOTORS)
    position = start
    for _ in range(ticks):
        frame = sensor_frame(position=position)
        position, _ = motion.move(state, joint_frame_of(frame), STANCE)
        motion.measured = position  # type: ignore[attr-defined]
    return motion


def test_a_posture_is_reached_slowly_from_where_the_robot_is() -> None:
    start = np.zeros(25)
    start[KNEE] = 1.5
    motion = JointMotionState(JointMap(JOINTS, NAO_MOTORS), STANCE, NAO_MOTORS)
    last, position = start, start
    for _ in range(400):
        targets, stiffness = motion.move(
            RobotState.REACHING,
            joint_frame_of(sensor_frame(position=position)),
            STANCE,
        )
        assert np.all(np.abs(targets - last) <= POSTURE_SPEED * TICK + 1e-12)
        last = position = targets
        if motion.reached(RobotState.REACHING, position):
            break
    assert stiffness.tolist() == [1.0] * 25
    np.testing.assert_allclose(position[:23], STANCE, atol=0.02)


def test_a_leg_that_is_held_has_not_reached_the_stance() -> None:
    motion = motion_at(RobotState.REACHING, 400, np.zeros(25))
    there = motion.targets.copy()
    assert motion.reached(RobotState.REACHING, there)
    held = there.copy()
    held[KNEE] += 0.5
    assert not motion.reached(RobotState.REACHING, held)
    assert not motion.reached(RobotState.WALKING, there)


def test_rest_is_a_crouch_over_the_feet() -> None:
    motion = motion_at(RobotState.RESTING, 600, sensor_frame().position)
    for side in "LR":
        knee = motion.targets[NAMES.index(f"{side}KneePitch")]
        assert knee == pytest.approx(CROUCH["KneePitch"], abs=0.02)
    pitches = CROUCH["HipPitch"] + CROUCH["KneePitch"] + CROUCH["AnklePitch"]
    assert pitches == pytest.approx(0.0)  # the torso stays upright
    assert motion.reached(RobotState.RESTING, motion.targets)


def test_a_limp_robot_holds_nothing_and_starts_from_where_it_lies() -> None:
    motion = JointMotionState(JointMap(JOINTS, NAO_MOTORS), STANCE, NAO_MOTORS)
    lying = np.full(25, 0.3)
    motion.move(RobotState.LIMP, joint_frame_of(sensor_frame()), STANCE)
    targets, stiffness = motion.move(
        RobotState.LIMP, joint_frame_of(sensor_frame(position=lying)), STANCE
    )
    assert stiffness.tolist() == [0.0] * 25 and motion.is_limp
    np.testing.assert_array_equal(targets, lying)


def test_every_state_has_its_own_colour_and_fits_the_wire() -> None:
    assert set(COLOURS) == set(RobotState)
    assert len(set(COLOURS.values())) == len(RobotState)
    for state in RobotState:
        lights = lights_for(state, sees=True, charge=0.5)
        assert lights["Chest"] == COLOURS[state]
        assert sum(lights["LEar"]) == 5.0
        assert len(pack_actuators(ActuatorFrame(lights=lights))) > 400
    assert (
        sum(lights_for(RobotState.READY, sees=False, charge=2)["LEye"]) == 0.0
    )
