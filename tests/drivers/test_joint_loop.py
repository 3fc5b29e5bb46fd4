"""Test the joint loop: states, limits, refusals and its log."""

from math import degrees, inf, nan
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from joint_fakes import (
    MOTORS,
    STANCE,
    STRATEGY,
    TICK,
    FakeRobot,
    Game,
    status,
    walking,
)
from stepaside.core.errors import ConfigurationError, ModelError
from stepaside.drivers.joint_motion import (
    HOT,
    MIN_STIFFNESS,
    WARM,
    derate_stiffness,
    motors_of,
)
from stepaside.drivers.method_thread import SessionLost
from stepaside.drivers.safety import SafetyState
from stepaside.drivers.scheme_factory import policy_gains
from stepaside.perception.images import LidarScan
from stepaside.perception.measurement import Sighting
from stepaside.robots.description import load_robot
from stepaside.robots.tree_cache import load_tree
from stepaside.strategies import StandStill


def test_a_robot_stands_up_slowly_and_walks_by_its_button() -> None:
    game = Game()
    session = game.session
    session.angles = np.array([0.3, 1.5, 0.0, -0.2])  # of gripper and knee
    game.play(110)
    assert game.state is SafetyState.READY
    np.testing.assert_allclose(session.angles[[3, 1, 2]], STANCE, atol=0.02)
    sent = [t for t in session.sent if t is not None]
    shares = [t.stiffness[1] / 80.0 for t in sent]
    assert shares[0] == pytest.approx(TICK) and shares[60] == 1.0
    np.testing.assert_allclose(sent[0].angles[1], 1.5, atol=0.02)
    speeds = np.abs(np.diff([t.angles for t in sent], axis=0)) / TICK
    assert speeds[:, 1].max() <= 0.5 + 1e-9
    assert all(t.stiffness[0] == 0.0 for t in sent)  # not described
    game.press()
    assert [state.value for state in session.robot.shown] == [
        *("limp", "reaching", "ready", "walking")
    ]


def test_a_stiff_robot_keeps_its_posture_if_the_first_image_fails() -> None:
    class Blind:
        hindrance = ""

        def take(self, now: float) -> None:
            raise SessionLost("no camera")

    game = Game(open_eyes=lambda robot: Blind())
    session = game.session
    session.changes["status"] = status(stiffness=np.ones(4))
    session.angles = np.array([0.3, 0.5, 0.1, -0.2])
    angles = session.angles.copy()
    with pytest.raises(SessionLost, match="no camera"):
        game.play(1)
    sent = [each.angles for each in session.sent if each is not None]
    assert len(sent) > 1  # stiffness falls slowly
    np.testing.assert_array_equal(
        np.array(sent)[:, 1:], [angles[1:]] * len(sent)
    )


def test_control_moves_the_joints_only_while_it_walks() -> None:
    game = Game()
    wanted = STANCE + np.array([0.05, 0.05, 0.0])
    game.play(60, wanted)
    (scheme,) = game.schemes
    assert scheme.read == []
    order = MOTORS.order
    np.testing.assert_allclose(game.sent.angles[order], STANCE, atol=1e-6)
    game.press()
    game.play(5, wanted)
    np.testing.assert_allclose(game.sent.angles[order], wanted, atol=1e-6)
    times = [read.time for read in scheme.read]
    np.testing.assert_allclose(times, TICK * np.arange(6), atol=1e-9)


def test_time_counts_ticks_also_of_reports_that_are_missing() -> None:
    game = walking()
    session = game.session
    session.time += 2 * TICK
    session.now += 2 * TICK
    session.changes["percepts"] = (LidarScan(session.time, np.zeros((0, 3))),)
    game.play(1)
    read = game.schemes[-1].read[-1]
    assert read.time == pytest.approx(3 * TICK)
    assert read.sighting is not None
    assert read.sighting[:3] == pytest.approx((read.time, 0.4, 0.7))
    assert read.percepts[0].time == pytest.approx(read.time - TICK)


def test_targets_stay_in_range_and_within_the_speed_of_their_motor() -> None:
    game = walking()
    game.play(60, np.array([5.0, -5.0, 5.0]))
    hip, knee, neck = game.sent.angles[MOTORS.order]
    assert hip == pytest.approx(0.99) and knee == pytest.approx(0.01)
    assert neck == pytest.approx(60 * TICK * 0.25, rel=0.1)
    sent = [t.angles for t in game.session.sent if t is not None]
    speeds = np.abs(np.diff(sent, axis=0))[:, MOTORS.order] / TICK
    assert np.all(speeds <= MOTORS.speed + 1e-9)


def test_a_hot_joint_has_half_its_torque() -> None:
    def share(degrees: float, heat: float = 0.0) -> float:
        hot = status(temperature=np.full(4, degrees), heat=np.full(4, heat))
        return float(derate_stiffness(np.ones(4), hot)[0])

    assert share(20.0) == share(WARM) == 1.0
    assert share(HOT) == share(HOT + 50.0) == MIN_STIFFNESS
    half = 0.5 * (1.0 + MIN_STIFFNESS)
    assert share(0.5 * (WARM + HOT)) == pytest.approx(half)
    assert share(20.0, heat=3.0) == 0.0


def lost(game: Game, said: str) -> None:
    """The session ends with a reason, and the robot goes limp softly."""
    session = game.session
    before = len(session.sent)
    with pytest.raises(SessionLost, match=said):
        game.play(20)
    assert game.state is SafetyState.LIMP
    if not session.broken:
        *fading, last = session.sent[before:]
        shares = [t.stiffness[1] / 80.0 for t in fading if t is not None]
        assert last is None and len(shares) > 20
        assert all(b < a for a, b in zip(shares, shares[1:], strict=False))


def test_silence_for_100_ms_ends_the_session() -> None:
    game = walking()
    began, game.session.silent = game.session.now, True
    lost(game, "no new report for 0.10 s")
    passed = game.session.now - began
    assert passed == pytest.approx(0.1 + 0.5, abs=0.03)


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
        (
            {"status": status(temperature=np.full(4, nan))},
            "temperature must be finite",
        ),
        ({"status": status(heat=np.full(4, nan))}, "heat must be finite"),
        ({"sighting": Sighting(0.0, 28.0, 2.0)}, "bearing of the sighting"),
    ],
)
def test_implausible_reports_are_refused_and_end_the_session(
    changes: dict[str, Any], said: str
) -> None:
    game = walking()
    game.session.changes |= changes
    lost(game, rf"refused: listen\(\) of .*{said}")
    assert game.loop.refused >= 4


def test_one_damaged_report_is_passed_over() -> None:
    game = walking()
    game.session.once = {"gyro": (nan, 0.0, 0.0)}
    game.play(1)
    assert game.state is SafetyState.WALKING and game.loop.refused == 1


def test_a_joint_that_jumps_stops_the_walk() -> None:
    """The report that jumps is refused; other ones go on."""
    game = walking()
    far = game.session.angles + np.array([0.0, 0.0, 0.0, 0.5])
    game.session.once = {"joint_positions": far}
    game.play(1)
    assert game.state is SafetyState.STOPPING and game.loop.refused == 1
    assert game.reason == "hip jumped by 0.50 rad in 0.020 s"


@pytest.mark.parametrize(
    ("jump", "said"),
    [
        (-60.0, "the time went back"),
        (3.0, "its times are 3.000 s ahead of the clock"),
        (nan, "the time must be finite"),
    ],
)
def test_times_that_jump_end_the_session(jump: float, said: str) -> None:
    game = walking()
    game.session.time += jump
    lost(game, said)


def test_a_robot_rests_in_its_crouch_before_it_goes_limp() -> None:
    """Control is told to stop, and the next walk has a scheme of its own."""
    game = walking()
    assert game.loop.tick().state is SafetyState.WALKING
    game.press()
    assert game.state is SafetyState.STOPPING
    assert isinstance(game.schemes[0].decisions.strategy, StandStill)
    assert game.play(1).state is SafetyState.RESTING
    assert len(game.schemes) == 1
    tick = game.play(200)
    assert tick.state is SafetyState.LIMP and game.reason == "rests"
    assert game.session.angles[1] == pytest.approx(1.5, abs=0.02)
    assert len(game.schemes) == 2
    assert game.schemes[1].decisions.strategy is STRATEGY


def test_a_robot_that_was_lifted_stands_and_walks_anew_by_the_button() -> None:
    game = walking()
    game.session.changes["foot_forces"] = np.zeros(8)
    tick = game.play(40)
    assert tick.state is SafetyState.READY and "are lifted" in tick.reason
    del game.session.changes["foot_forces"]
    assert game.play(5).state is SafetyState.READY
    game.press()
    game.play(1)
    assert game.state is SafetyState.WALKING
    times = [read.time for read in game.schemes[1].read]
    np.testing.assert_allclose(times, [0.0, TICK], atol=1e-9)


def test_a_broken_session_ends_and_is_closed() -> None:
    game = walking()
    game.session.broken = True
    lost(game, "broken")
    game.loop.close()
    assert game.session.closed


class Described(FakeRobot):
    """NAO with the joints of its description."""

    joints = load_tree(load_robot("nao")).motors[::-1]  # type: ignore[assignment]
    gains = dict.fromkeys(joints, (50.0, 1.0))  # noqa: RUF012


def test_gains_of_a_policy_replace_those_of_its_joints() -> None:
    policy: Any = SimpleNamespace(
        joints=("neck", "hip"), stiffness=(7.0, 8.0), damping=(0.7, 0.8)
    )
    stiffness, damping = policy_gains(policy, MOTORS)
    assert stiffness.tolist() == [8.0, 80.0, 7.0]
    assert damping.tolist() == [0.8, 2.0, 0.7]
    assert MOTORS.stiffness[0] == 100.0
    with pytest.raises(ModelError, match="'hip' has no motor"):
        policy_gains(policy, MOTORS._replace(names=("neck", "knee", "arm")))


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
