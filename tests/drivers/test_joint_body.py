"""Test the body of a joint-driven robot: states, limits and refusals."""

from math import degrees, inf, nan
from typing import Any

import numpy as np
import pytest

from joint_fakes import (
    MOTORS,
    STANCE,
    TICK,
    FakeRobot,
    FakeSession,
    body_of,
    play,
    press,
    status,
    walking,
)
from stepaside.core.errors import ConfigurationError
from stepaside.drivers.guardian_process import SessionLost
from stepaside.drivers.joint_body import JointBody, MotorGains
from stepaside.drivers.joint_robot import check_joint_robot, motors_of
from stepaside.drivers.safety_states import SafetyState
from stepaside.perception.images import SonarEcho
from stepaside.perception.measurement import Sighting
from stepaside.robots.description import load_robot
from stepaside.robots.tree_cache import load_tree


def state_of(body: JointBody) -> SafetyState:
    """Return the state now: type checkers assume that it does not change."""
    return body.state


def test_a_robot_stands_up_slowly_and_walks_by_its_button() -> None:
    body, session = body_of()
    session.angles = np.array([0.3, 1.5, 0.0, -0.2])  # of gripper and knee
    play(body, 110)
    assert state_of(body) is SafetyState.READY
    np.testing.assert_allclose(session.angles[[3, 1, 2]], STANCE, atol=0.02)
    sent = [t for t in session.sent if t is not None]
    shares = [t.stiffness[1] / 80.0 for t in sent]
    assert shares[0] == pytest.approx(TICK) and shares[60] == 1.0
    np.testing.assert_allclose(sent[0].angles[1], 1.5, atol=0.02)
    speeds = np.abs(np.diff([t.angles for t in sent], axis=0)) / TICK
    assert speeds[:, 1].max() <= 0.5 + 1e-9
    assert all(t.stiffness[0] == 0.0 for t in sent)  # not described
    press(session, body, STANCE)
    shown = session.robot.shown
    assert [state.value for state in shown] == [
        *("limp", "reaching", "ready", "walking")
    ]


def test_control_moves_the_joints_only_while_it_walks() -> None:
    body, session = body_of()
    wanted = STANCE + np.array([0.05, 0.05, 0.0])
    play(body, 60, wanted)
    held = session.sent[-1]
    assert held is not None
    np.testing.assert_allclose(held.angles[MOTORS.order], STANCE, atol=1e-6)
    press(session, body, wanted)
    play(body, 1, wanted)
    moved = session.sent[-1]
    assert moved is not None
    np.testing.assert_allclose(moved.angles[MOTORS.order], wanted, atol=1e-6)


def test_time_is_zero_where_walking_begins_and_counts_ticks() -> None:
    body, session = walking()
    session.time += 2 * TICK  # two reports are missing
    session.now += 2 * TICK
    session.changes["percepts"] = (SonarEcho(session.time, "left", 0.5),)
    read = body.read()
    assert read.time == pytest.approx(3 * TICK)
    assert read.sighting is not None
    assert read.sighting[:3] == pytest.approx((read.time, 0.4, 0.7))
    assert read.percepts[0].time == pytest.approx(read.time - TICK)
    np.testing.assert_allclose(read.joint_positions, session.angles[[3, 1, 2]])


def test_targets_stay_in_range_and_within_the_speed_of_their_motor() -> None:
    body, session = walking()
    play(body, 60, np.array([5.0, -5.0, 5.0]))
    sent = session.sent[-1]
    assert sent is not None
    hip, knee, neck = sent.angles[MOTORS.order]
    assert hip == pytest.approx(0.99) and knee == pytest.approx(0.01)
    assert neck == pytest.approx(60 * TICK * 0.25, rel=0.1)


def test_gains_of_control_hold_only_while_it_walks() -> None:
    """They are soft, so that its targets are not limited."""
    own = MotorGains(np.full(3, 7.0), np.full(3, 0.5))
    body, session = walking(gains=own)
    before, after = session.sent[-3], session.sent[-1]
    assert before is not None and after is not None
    assert before.stiffness[MOTORS.order].tolist() == [100.0, 80.0, 10.0]
    assert after.stiffness[MOTORS.order].tolist() == [7.0, 7.0, 7.0]
    play(body, 1, np.array([5.0, 5.0, 5.0]))
    far = session.sent[-1]
    assert far is not None and far.angles[MOTORS.order].tolist() == [5.0] * 3


def test_a_robot_that_stands_by_itself_is_stiff_at_once_and_given_back() -> (
    None
):
    robot = FakeRobot()
    robot.stands = True
    body, session = body_of(FakeSession(robot))
    play(body, 4)
    first = next(t for t in session.sent if t is not None)
    assert first.stiffness[1] == 80.0
    body.fail("asked")
    play(body, 3)
    assert session.sent.count(None) == 1


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"foot_forces": np.zeros(8)}, "are lifted"),
        ({"status": status(charge=0.02)}, "battery is at 2 %"),
        ({"status": status(current=np.array([0, 1.2, 0, 0]))}, "current"),
        ({"status": status(bumped=True)}, "bumper"),
        ({"accelerometer": np.zeros(3)}, "accelerometer reads 0.0"),
        ({"accelerometer": np.array([0, 0, -9.8])}, "tilt of 180 deg"),
        ({"hindrance": "tired"}, "tired"),
        ({"status": status(heat=np.array([0, 2, 0, 0]))}, "reports heat"),
        ({"status": status(temperature=np.full(4, 82.0))}, "has 82 degC"),
    ],
)
def test_a_walk_ends_when_a_sensor_says_that_it_must(
    changes: dict[str, Any], word: str
) -> None:
    body, session = walking()
    session.changes |= changes
    play(body, 40)
    assert state_of(body) is SafetyState.STOPPING and word in body.reason


def test_a_constant_accelerometer_ends_a_walk_whose_legs_move() -> None:
    body, session = walking()
    session.changes["accelerometer"] = np.array([0.0, 0.0, 9.8])
    play(body, 40)
    assert state_of(body) is SafetyState.WALKING  # the legs stand still
    for i in range(20):
        play(body, 1, STANCE + 0.1 * np.sin(0.5 * i))
    assert state_of(body) is SafetyState.STOPPING
    assert "constant while the legs move" in body.reason


@pytest.mark.parametrize(
    "changes",
    [
        {"status": status(current=np.array([9.0, 0, 0, 0]))},  # the gripper
        {"status": status(charge=0.12)},
        {"status": status(heat=np.array([3, 0, 3, 0]))},  # not of a leg
        {"gyro": np.array([0.0, 0.0, 5.0])},  # turning is no fall
        {"sighting": None},  # a robot with a button walks on
    ],
)
def test_a_walk_goes_on_where_all_is_well(changes: dict[str, Any]) -> None:
    body, session = walking()
    session.changes |= changes
    play(body, 60)
    assert state_of(body) is SafetyState.WALKING


@pytest.mark.parametrize(
    "changes", [{"tilt": (0.7, 0.0)}, {"gyro": np.array([0.0, -5.0, 0.0])}]
)
def test_falling_goes_limp_at_once(changes: dict[str, Any]) -> None:
    body, session = walking()
    session.changes |= changes
    play(body, 1)
    assert state_of(body) is SafetyState.LIMP and "falls" in body.reason
    play(body, 40)
    assert session.sent[-1] is None


def lost(body: JointBody, session: FakeSession, said: str) -> None:
    """The session ends with a reason, and the robot goes limp softly."""
    before = len(session.sent)
    with pytest.raises(SessionLost, match=said):
        play(body, 20)
    assert state_of(body) is SafetyState.LIMP
    if not session.broken:
        *fading, last = session.sent[before:]
        shares = [t.stiffness[1] / 80.0 for t in fading if t is not None]
        assert last is None and len(shares) > 20
        assert all(b < a for a, b in zip(shares, shares[1:], strict=False))


def test_silence_for_100_ms_ends_the_session() -> None:
    body, session = walking()
    began, session.silent = session.now, True
    lost(body, session, "no new report for 0.10 s")
    assert session.now - began == pytest.approx(0.1 + 0.5, abs=0.03)


def test_a_simulator_may_pause_for_seconds() -> None:
    session = FakeSession()
    session.robot.paced = False
    body, _ = body_of(session)
    play(body, 10)
    session.now += 9.0
    play(body, 1)
    assert state_of(body) is SafetyState.REACHING


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"joint_positions": [0, nan, 0, 0]}, "joint_positions must be finit"),
        (
            {"joint_positions": [0, 0, 0, degrees(0.5)]},
            r"hip is at 28.65 rad, outside its range .*degrees",
        ),
        ({"joint_velocities": [0, 0, inf, 0]}, "joint_velocities must be fin"),
        ({"gyro": (0.0, 0.0, degrees(1.0))}, r"gyro .*deg/s"),
        ({"tilt": (0.0, degrees(0.1))}, "tilt .*degrees"),
        ({"accelerometer": (0.0, nan, 9.8)}, "accelerometer must be finite"),
        ({"foot_forces": [nan, *[1.0] * 7]}, "foot_forces must be finite"),
        ({"sighting": Sighting(0.0, 28.0, 2.0)}, "bearing of the sighting"),
    ],
)
def test_implausible_reports_are_refused_and_end_the_session(
    changes: dict[str, Any], said: str
) -> None:
    body, session = walking()
    session.changes |= changes
    with pytest.raises(SessionLost, match=rf"refused: listen\(\) of .*{said}"):
        play(body, 1)
    assert body.refused >= 4


def test_one_damaged_report_is_passed_over() -> None:
    body, session = walking()
    listen, fine = session.listen, dict(session.changes)
    calls = 0

    def listens(patience: float, convert: Any) -> Any:
        nonlocal calls
        calls += 1
        session.changes = fine | ({"gyro": (nan, 0, 0)} if calls == 1 else {})
        return listen(patience, convert)

    session.listen = listens  # type: ignore[method-assign]
    play(body, 1)
    assert state_of(body) is SafetyState.WALKING and body.refused == 1


@pytest.mark.parametrize(
    ("jump", "said"),
    [
        (-60.0, "the time went back"),
        (3.0, "its times are 3.000 s ahead of the clock"),
        (nan, "the time must be finite"),
    ],
)
def test_times_that_jump_end_the_session(jump: float, said: str) -> None:
    body, session = walking()
    session.time += jump
    lost(body, session, said)


def test_a_control_that_was_away_finds_its_robot_limp() -> None:
    body, session = walking()
    session.now += 1.0
    session.time += 1.0
    session.changes["status"] = status(stiffness=np.full(4, 0.4))
    play(body, 1)
    assert state_of(body) is SafetyState.LIMP
    assert "no report was read for 1.0" in body.reason
    sent = session.sent[-1]
    assert sent is not None and sent.stiffness[1] < 0.4 * 80.0


def test_targets_with_nan_make_the_robot_limp() -> None:
    body, session = walking()
    play(body, 1, np.full(3, nan))
    assert state_of(body) is SafetyState.LIMP and "NaN or inf" in body.reason
    sent = session.sent[-1]
    assert sent is not None and np.isfinite(sent.angles).all()


def test_a_robot_rests_in_its_crouch_before_it_goes_limp() -> None:
    body, session = walking()
    press(session, body, STANCE)
    assert state_of(body) is SafetyState.STOPPING
    body.halted()
    assert state_of(body) is SafetyState.RESTING
    play(body, 200)
    assert state_of(body) is SafetyState.LIMP and body.reason == "rests"
    assert session.angles[1] == pytest.approx(1.5, abs=0.02)


def test_closing_leaves_the_robot_limp() -> None:
    body, session = walking()
    body.close()
    assert session.closed and session.sent[-1] is None


def test_a_broken_session_ends_and_is_closed() -> None:
    body, session = walking()
    session.broken = True
    lost(body, session, "broken")
    body.close()
    assert session.closed


def test_without_a_button_it_walks_when_ready_and_sees_its_opponent() -> None:
    body, session = body_of()
    session.changes = {"sighting": None}
    play(body, 80)
    assert state_of(body) is SafetyState.READY
    assert body.reason == "no sighting of the opponent"
    session.changes = {}
    session.hold = "hold the switch"
    play(body, 4)
    assert state_of(body) is SafetyState.READY
    assert body.reason == "hold the switch"
    session.hold = ""
    play(body, 4)
    assert state_of(body) is SafetyState.WALKING
    session.changes = {"sighting": Sighting(session.time - 0.6, 0.4, 0.7)}
    play(body, 1)
    assert state_of(body) is SafetyState.STOPPING


def test_the_papers_walk_needs_foot_forces() -> None:
    body, session = body_of(needs_forces=True)
    session.changes["foot_forces"] = np.full(8, nan)
    with pytest.raises(SessionLost, match=r"foot_forces are needed .*--legs"):
        play(body, 1)


class Described(FakeRobot):
    """NAO with the joints of its description."""

    joints = load_tree(load_robot("nao")).motors[::-1]
    gains = dict.fromkeys(joints, (50.0, 1.0))  # noqa: RUF012


def test_motors_have_the_ranges_of_the_model_and_gains() -> None:
    nao = load_robot("nao")
    motors = motors_of(Described(), nao)
    assert motors.names == tuple(Described.joints)[::-1]
    assert motors.order.tolist() == list(range(len(motors.names)))[::-1]
    knee = motors.names.index("LKneePitch")
    assert (motors.low[knee], motors.high[knee]) == (-0.0923279, 2.11255)
    assert motors.speed[knee] == nao.speed_limits["LKneePitch"]
    legs = {motors.names[at] for at in motors.legs}
    assert "LHipYawPitch" in legs and "HeadYaw" not in legs
    assert motors.stiffness[knee] == 50.0
    fewer = Described()
    fewer.gains = {}
    with pytest.raises(ConfigurationError, match="gains lack HeadYaw"):
        motors_of(fewer, nao)
    fewer.joints = Described.joints[1:]
    with pytest.raises(ConfigurationError, match="joints lack RAnkleRoll"):
        motors_of(fewer, nao)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"tick": 5.0}, r"tick must be in \[0.001, 0.1\] s, got 5.0"),
        ({"joints": "hip"}, "joints must be the names of the joints"),
        ({"paced": 1}, "paced must be True or False"),
        ({"gains": {"hip": (1.0,)}}, "gains of hip must be a stiffness"),
        ({"gains": {"hip": (nan, 1.0)}}, "gains of hip"),
    ],
)
def test_an_invalid_class_is_refused(
    changes: dict[str, Any], said: str
) -> None:
    kind = type("Changed", (FakeRobot,), changes)
    with pytest.raises(ConfigurationError, match=f"robot r.py:R: {said}"):
        check_joint_robot(kind, "robot r.py:R")
