"""Test conventions of LoLA: joints, axes, units, numbers of frames."""

from math import atan2, hypot

import numpy as np
import pytest

from lola_fakes import JOINTS, STANCE, counted, sensor_frame
from stepaside.core.errors import ModelError
from stepaside.drivers.joint.frame_clock import (
    LEAD,
    FrameClock,
    FrameOrderError,
)
from stepaside.drivers.joint.frames import measurement_of
from stepaside.drivers.joint.joint_map import JointMap
from stepaside.drivers.lola.conventions import joint_frame_of, sensor_frame_of
from stepaside.drivers.lola.nao_joints import (
    LEGS,
    LOLA_JOINTS,
    NAMES,
    NAO_MOTORS,
    TICK,
)
from stepaside.perception.images import SonarEcho
from stepaside.perception.measurement import Measurement, Sighting
from stepaside.robots.description import load_robot

MAP = JointMap(JOINTS, NAO_MOTORS)


def test_lola_has_25_motors_and_one_for_both_hip_yaws() -> None:
    assert len(LOLA_JOINTS) == len(set(NAMES)) == 25
    assert NAMES[7] == "LHipYawPitch" and "RHipYawPitch" not in NAMES
    assert NAMES[18] == "RShoulderPitch" and NAMES[23:] == ("LHand", "RHand")
    sides = [name[0] for name in NAMES[LEGS]]
    assert sides == 6 * ["L"] + 5 * ["R"]


def test_ranges_and_speeds_are_those_of_the_description() -> None:
    description = load_robot("nao")
    model = description.compile()
    for joint in LOLA_JOINTS[:23]:
        ranges = model.joint(joint.name).range
        np.testing.assert_allclose(ranges, (joint.low, joint.high))
        assert description.speed_limits[joint.name] == joint.speed


def test_every_joint_comes_back_from_the_wire_in_its_place() -> None:
    names = tuple(reversed(JOINTS))
    joints = JointMap(names, NAO_MOTORS)
    values = np.arange(23.0)
    spread = joints.to_motors(values, np.full(25, -1.0))
    assert spread[NAMES.index("LKneePitch")] == names.index("LKneePitch")
    assert spread[23:].tolist() == [-1.0, -1.0]  # hands are left alone
    np.testing.assert_array_equal(joints.from_motors(spread), values)


def test_a_joint_without_a_motor_is_refused_by_name() -> None:
    with pytest.raises(ModelError, match="'RHipYawPitch' has no motor"):
        JointMap([*JOINTS, "RHipYawPitch"], NAO_MOTORS)
    with pytest.raises(ModelError, match="must differ"):
        JointMap(["HeadYaw", "HeadYaw"], NAO_MOTORS)


def test_a_frame_of_a_real_robot_leans_as_its_accelerometer_says() -> None:
    """A frame recorded by others: leaning back and a little to the right."""
    frame = sensor_frame(
        angles=(0.03758, -0.35991),
        accelerometer=np.array([-3.06563, -0.39278, -9.32142]),
    )
    x, y, z = measurement_of(
        joint_frame_of(frame), MAP, 0.0
    ).accelerometer.tolist()
    assert z > 0.0  # an upright robot is pushed up by the floor
    assert atan2(y, z) == pytest.approx(frame.angles[0], abs=0.01)
    assert atan2(-x, hypot(y, z)) == pytest.approx(frame.angles[1], abs=0.05)


def test_feet_weigh_in_kilograms_and_push_in_newtons() -> None:
    forces = measurement_of(
        joint_frame_of(sensor_frame()), MAP, 0.0
    ).foot_forces
    assert forces.sum() == pytest.approx(8 * 0.65 * 9.81)


def test_echoes_are_named_and_no_echo_is_none() -> None:
    measured = measurement_of(
        joint_frame_of(sensor_frame(sonar=(0.4, 2.55))), MAP, 1.0
    )
    assert measured.percepts == (
        SonarEcho(1.0, "left", 0.4),
        SonarEcho(1.0, "right", None),
    )


def test_a_measurement_comes_back_from_its_frame() -> None:
    sent = Measurement(
        2.0,
        STANCE,
        np.array([0.1, -0.2, 0.3]),
        np.array([1.0, -2.0, 9.0]),
        np.arange(8.0),
        None,
        (SonarEcho(2.0, "left", 0.5), SonarEcho(2.0, "right", None)),
    )
    frame = sensor_frame_of(
        sent,
        MAP,
        angles=(0.0, 0.0),
        stiffness=np.ones(25),
        count=70000,
        chest_pressed=True,
        lock_step=False,
    )
    assert frame.touch[0] == 1.0 and sum(frame.touch) == 1.0
    assert frame.accelerometer.tolist() == [-1.0, 2.0, -9.0]
    assert frame.battery[3] == 70000 - 65536
    got = measurement_of(
        joint_frame_of(frame), MAP, 2.0, Sighting(1.9, 0.1, 0.9)
    )
    for name in ("joint_positions", "gyro", "accelerometer", "foot_forces"):
        np.testing.assert_allclose(getattr(got, name), getattr(sent, name))
    assert got.percepts == sent.percepts
    assert got.sighting == Sighting(1.9, 0.1, 0.9)


def test_frames_on_time_are_numbered_for_hours() -> None:
    """Even where two clocks differ by one percent."""
    clock, now = FrameClock(TICK), 0.0
    for number in range(20_000):
        assert clock.note(now, 36.0) == number
        now += 0.99 * TICK


def test_a_burst_after_a_pause_is_no_lie() -> None:
    clock = FrameClock(TICK)
    clock.note(0.0, 36.0)
    assert clock.note(10 * TICK, 36.0, 10) == 10


def test_frames_that_outrun_the_clock_come_from_the_future() -> None:
    clock, now = FrameClock(TICK), 0.0
    with pytest.raises(FrameOrderError, match="ahead of the clock"):
        for _ in range(40):
            clock.note(now, 36.0)
            now += 0.5 * TICK
    assert now > LEAD / 2.0  # not for a little jitter


def test_a_world_in_lock_step_may_outrun_the_clock() -> None:
    clock = FrameClock(TICK, counted=True, paced=False)
    for number in range(100):
        assert clock.note(0.0, float(number)) == number


@pytest.mark.parametrize(
    ("numbers", "said"),
    [
        ((5, 5), "frame 5 came after frame 5"),
        ((5, 4), "frame 4 came after frame 5"),
        ((5, 16), "frame 16 came after frame 5"),
        ((5, 6.5), "number must be .* got 6.5"),
        ((5, -1), "number must be .* got -1"),
        ((65536,), "number must be .* got 65536"),
    ],
)
def test_frames_out_of_order_or_from_the_future_are_refused(
    numbers: tuple[float, ...], said: str
) -> None:
    clock = FrameClock(TICK, counted=True, paced=False)
    with pytest.raises(FrameOrderError, match=said):
        for number in numbers:
            clock.note(0.0, number)


def test_missing_frames_are_counted_and_the_number_wraps() -> None:
    clock = FrameClock(TICK, counted=True, paced=False)
    times = [clock.note(0.0, n) for n in (65533.0, 65535.0, 0.0, 3.0)]
    assert times == [0, 2, 3, 6]
    assert counted(7).battery[3] == 7.0
