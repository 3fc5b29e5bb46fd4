"""Test the robot behind LoLA as control sees it, on a clock set by hand."""

from collections.abc import Iterable
from typing import Any

import numpy as np
import pytest

from lola_fakes import (
    JOINTS,
    STANCE,
    Clock,
    FakeLink,
    counted,
    pressed,
    sensor_frame,
)
from stepaside.drivers.guardian_process import SessionLost
from stepaside.drivers.joint.joint_body import (
    JointBody,
    JointInterface,
    SystemClock,
)
from stepaside.drivers.joint.safety_state_machine import RobotState
from stepaside.drivers.lola.conventions import CODEC, joint_frame_of
from stepaside.drivers.lola.lights import COLOURS
from stepaside.drivers.lola.lola_frames import pack_sensors
from stepaside.drivers.lola.nao_joints import LEGS, NAMES, NAO_MOTORS, TICK
from stepaside.drivers.lola.sight_socket import (
    SightClient,
    SightMessage,
    pack_sight,
)
from stepaside.perception.measurement import Sighting

FINE = pack_sensors(sensor_frame())
TO_READY = 100 * [FINE]  # warm up, and a second of growing stiffness
START = [pack_sensors(pressed()), FINE]


def body_of(
    script: Iterable[Any], **changes: Any
) -> tuple[JointBody, FakeLink, Clock]:
    clock = Clock()
    link = FakeLink(clock, script)
    body = JointBody(
        JointInterface(link, NAO_MOTORS, CODEC),
        dict(zip(JOINTS, STANCE, strict=True)),
        clock=SystemClock(clock, clock.pause),
        **changes,
    )
    return body, link, clock


def play(body: JointBody, ticks: int, targets: Any = STANCE) -> None:
    for _ in range(ticks):
        body.read()
        body.write(targets)
        body.step()


def walking(
    script: Iterable[Any] = (), **changes: Any
) -> tuple[JointBody, FakeLink, Clock]:
    body, link, clock = body_of([*TO_READY, *START, *script], **changes)
    play(body, 102)
    assert body.state is RobotState.WALKING
    return body, link, clock


def test_a_robot_that_stands_is_ready_after_a_second_and_walks_by_button() -> (
    None
):
    body, link, _ = body_of([*TO_READY, *START])
    shown: list[RobotState] = []
    for _ in range(102):
        play(body, 1)
        if not shown or shown[-1] is not body.state:
            shown.append(body.state)
    assert shown == [
        RobotState.LIMP,
        RobotState.REACHING,
        RobotState.READY,
        RobotState.WALKING,
    ]
    assert link.sent[-1].lights["Chest"] == COLOURS[RobotState.WALKING]


def test_the_first_frames_are_answered_without_a_command() -> None:
    """They may be all zeros; a silent client would stop some worlds."""
    body, link, _ = body_of(2 * [FINE])
    play(body, 2)
    for answer in link.sent:
        assert answer.position is None
        assert answer.stiffness is not None and answer.stiffness.max() == 0.0


def test_stiffness_grows_from_where_the_joints_are() -> None:
    sits = sensor_frame()
    sits.position[NAMES.index("LKneePitch")] = 2.0
    body, link, _ = body_of(20 * [sits])
    play(body, 20)
    first = next(a for a in link.sent if a.position is not None)
    assert first.position is not None and first.stiffness is not None
    np.testing.assert_allclose(first.position, sits.position, atol=0.007)
    assert 0.0 < first.stiffness.max() < 0.05


def test_control_moves_the_joints_only_while_it_walks() -> None:
    body, link, _ = body_of([*TO_READY, *START, FINE])
    wanted = STANCE + 0.02
    play(body, 101, wanted)
    held = link.sent[-1].position
    assert held is not None
    np.testing.assert_allclose(held[:23], STANCE, atol=1e-6)
    play(body, 2, wanted)
    moved = link.sent[-1].position
    assert moved is not None
    np.testing.assert_allclose(moved[:23], wanted, atol=1e-6)


def test_time_is_zero_where_walking_begins_and_counts_frames() -> None:
    body, link, clock = body_of([*TO_READY, *START, FINE, [FINE, FINE], FINE])
    for _ in range(102):
        time = body.read().time
        body.write(STANCE)
    assert time == 0.0
    # The two that came at once are two ticks, of which the newest counts.
    times = [body.read().time for _ in range(3)]
    np.testing.assert_allclose(times, [TICK, 3 * TICK, 4 * TICK])


def test_a_few_bad_frames_are_passed_over() -> None:
    broken = b"\x00" * 896
    body, link, _ = walking([*3 * [broken], FINE, broken, FINE])
    play(body, 2)
    assert body.state is RobotState.WALKING and body.refused == 4


def state_of(body: JointBody) -> RobotState:
    """Return the state now."""
    return body.state


def lost(body: JointBody, link: FakeLink, said: str) -> None:
    """The session ends with a reason, and the robot goes limp softly."""
    before = len(link.sent)
    with pytest.raises(SessionLost, match=said):
        play(body, 100)
    assert body.state is RobotState.LIMP
    fading = [a.stiffness for a in link.sent[before:]]
    shares = [float(s.max()) for s in fading if s is not None]
    if not link.broken:
        assert shares[-1] == 0.0 and len(shares) > 30
        assert all(b < a for a, b in zip(shares[1:], shares[2:], strict=False))


def test_silence_for_100_ms_ends_the_session() -> None:
    body, link, clock = walking()
    began = clock.now
    lost(body, link, "no valid frame for 0.100 s")
    assert clock.now - began == pytest.approx(0.1 + 0.5, abs=0.03)


def test_endless_garbage_ends_the_session_as_silence_does() -> None:
    body, link, clock = walking(10_000 * [b"\xff" * 896])
    lost(body, link, "no valid frame for 0.1.*refused")


@pytest.mark.parametrize(
    "change",
    [
        {"angles": (0.7, 0.0)},
        {"angles": (0.0, -0.7)},
        {"gyroscope": np.array([5.0, 0.0, 0.0])},
    ],
)
def test_falling_goes_limp_at_once(change: dict[str, Any]) -> None:
    body, link, _ = walking(60 * [sensor_frame(**change)])
    play(body, 1)
    assert body.state is RobotState.LIMP
    play(body, 59)
    stiffness = link.sent[-1].stiffness
    assert stiffness is not None and stiffness.max() == 0.0


def moved(count: int, **changes: Any) -> list[Any]:
    """Frames of a robot whose legs move."""
    frames = []
    for i in range(count):
        frame = sensor_frame(**changes)
        frame.position[LEGS] += 0.1 * np.sin(0.3 * i)
        frames.append(frame)
    return frames


def touching(at: int) -> list[Any]:
    touch = [0.0] * 14
    touch[at] = 1.0
    return 30 * [sensor_frame(touch=tuple(touch))]


def drawing(joint: str, current: float) -> list[Any]:
    drawn = np.zeros(25)
    drawn[NAMES.index(joint)] = current
    return 60 * [sensor_frame(current=drawn)]


@pytest.mark.parametrize(
    ("frames", "word"),
    [
        (60 * [sensor_frame(fsr=np.zeros(8))], "are lifted"),
        (60 * [sensor_frame(battery=(0.02, 0.0, 0.0, 36.0))], "2 %"),
        (60 * [sensor_frame(current=np.full(25, 6.0))], "current"),
        (drawing("RKneePitch", 3.5), "current"),
        (drawing("LWristYaw", -0.6), "current"),
        (touching(4), "bumper"),
        (touching(5), "bumper"),
        (touching(9), "bumper"),
        (touching(10), "bumper"),
        (60 * [sensor_frame(accelerometer=np.zeros(3))], "accelerometer"),
        (
            60 * [sensor_frame(accelerometer=np.array([0.0, 0.0, 9.81]))],
            "accelerometer reads a tilt of 180 deg",
        ),
        (moved(60), "accelerometer reading is constant"),
    ],
)
def test_a_walk_ends_when_a_sensor_says_that_it_must(
    frames: list[Any], word: str
) -> None:
    body, _, _ = walking(frames)
    play(body, len(frames))
    assert body.state is RobotState.STOPPING and word in body.reason


@pytest.mark.parametrize(
    "frames",
    [
        drawing("RKneePitch", 2.0),  # a hard landing, within the motor
        drawing("LHand", 9.0),  # of which nothing is published
        touching(0)[:1],
        touching(1),  # the head's buttons
        60 * [sensor_frame(battery=(0.12, 0.0, 0.0, 36.0))],
        [
            frame._replace(
                accelerometer=np.array([0.0, 0.02 * (i % 2), -9.81])
            )
            for i, frame in enumerate(moved(60))
        ],
    ],
)
def test_a_walk_goes_on_where_all_is_well(frames: list[Any]) -> None:
    body, _, _ = walking(frames)
    play(body, len(frames))
    assert body.state is RobotState.WALKING


def test_turning_about_the_vertical_is_no_fall() -> None:
    turning = sensor_frame(gyroscope=np.array([0.0, 0.0, 5.0]))
    body, _, _ = walking([turning])
    play(body, 1)
    assert body.state is RobotState.WALKING


def test_a_control_that_was_away_finds_its_robot_limp() -> None:
    body, link, clock = walking(10 * [FINE])
    weak = sensor_frame(stiffness=np.full(25, 0.4))
    clock.now += 1.0
    link.queue = 83 * [pack_sensors(weak)]
    body.frame = joint_frame_of(weak)
    play(body, 1)
    assert body.state is RobotState.LIMP
    assert "no frame was read for 1.0" in body.reason
    stiffness = link.sent[-1].stiffness
    assert stiffness is not None and stiffness.max() < 0.4


def test_a_queue_that_was_left_is_read_to_its_newest_frame() -> None:
    body, link, clock = walking()
    last = sensor_frame(sonar=(0.5, 0.5))
    clock.now += 5 * TICK
    link.queue = [FINE] * 4 + [pack_sensors(last)]
    assert body.read().percepts[0].distance == 0.5  # type: ignore[union-attr]
    assert body.state is RobotState.WALKING


def test_targets_with_nan_make_the_robot_limp() -> None:
    body, link, _ = walking(2 * [FINE])
    play(body, 1, np.full(23, np.nan))
    assert body.state is RobotState.LIMP and "NaN or inf" in body.reason
    assert link.sent[-1].position is not None
    assert np.all(np.isfinite(link.sent[-1].position))


def test_the_button_stops_and_control_says_when_it_stands() -> None:
    rest = 600 * [FINE]
    body, link, _ = walking([*START, *rest])
    followed = link.sent[-1].position
    assert followed is not None

    def follow(answer: Any) -> None:
        if answer.position is not None:
            moved = sensor_frame(position=answer.position)
            link.script = iter([moved] * 3)

    play(body, 2)
    assert body.state is RobotState.STOPPING
    body.halted()
    assert state_of(body) is RobotState.RESTING
    link.follow = follow
    link.script = iter(rest)
    for _ in range(600):
        play(body, 1)
        if state_of(body) is RobotState.LIMP:
            break
    assert state_of(body) is RobotState.LIMP and body.reason == "rests"


def test_a_dry_run_commands_nothing_but_lights() -> None:
    body, link, _ = body_of([*TO_READY, *START, *TO_READY], dry_run=True)
    play(body, 150)
    assert body.state is RobotState.WALKING
    body.close()
    for answer in link.sent:
        assert answer.position is None and answer.stiffness is None
        assert answer.sonar is None and answer.lights


def test_closing_the_session_leaves_the_robot_limp() -> None:
    body, link, _ = walking()
    body.close()
    assert link.closed
    stiffness = link.sent[-1].stiffness
    assert stiffness is not None and stiffness.max() == 0.0


def test_a_broken_link_ends_the_session_and_is_closed() -> None:
    body, link, _ = walking(5 * [FINE])
    link.broken = True
    lost(body, link, "broken")
    body.close()
    assert link.closed


def test_a_frame_from_the_future_ends_the_session() -> None:
    script = [counted(n) for n in range(150)]
    body, link, clock = body_of([*script, counted(200)])
    play(body, 150)
    lost(body, link, "frame 200 came after frame 149")


def test_a_frame_that_comes_twice_ends_the_session() -> None:
    script = [counted(n) for n in range(150)]
    body, link, clock = body_of([*script, counted(149)])
    play(body, 150)
    lost(body, link, "frame 149 came after frame 149")


def test_a_world_in_lock_step_may_think_for_seconds() -> None:
    frames = [counted(n, lock_step=True) for n in range(5)]
    script: list[Any] = [*frames[:4], *400 * [None], frames[4]]
    body, _, _ = body_of(script)
    play(body, 5)
    assert body.state is RobotState.REACHING


def test_sightings_come_with_their_frame_and_with_their_age() -> None:
    clock = Clock()
    messages = FakeLink(clock)
    body, link, _ = walking(4 * [FINE], sight=SightClient(messages))
    begun = 101  # the frame that was walked first
    messages.queue = [
        pack_sight(SightMessage(begun + 1, 0.05, 0.3, 0.9)),
        pack_sight(SightMessage(begun + 2, 0.0, 0.4, 0.8)),  # early
        b"\x00" * 32,  # garbage
        pack_sight(SightMessage(begun, 0.0, 9.9, 0.8)),  # no bearing
        pack_sight(SightMessage(begun, 0.0, 0.1, 0.1)),  # out of order
        pack_sight(SightMessage(begun + 99, 0.0, 0.1, 0.1)),  # the future
    ]
    assert body.read().sighting == Sighting(TICK - 0.05, 0.3, 0.9)
    assert body.read().sighting == Sighting(2 * TICK, 0.4, 0.8)
    late = pack_sight(SightMessage(begun + 3, 0.0, 0.5, 0.7))
    messages.queue = [late]  # dropped messages block no later ones
    assert body.read().sighting == Sighting(3 * TICK, 0.5, 0.7)
    messages.broken = True
    assert body.read().sighting == Sighting(3 * TICK, 0.5, 0.7)
    body.close()
    assert messages.closed
