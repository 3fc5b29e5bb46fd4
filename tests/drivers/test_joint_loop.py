"""Test the joint loop with a fake control scheme."""

import errno
import io
import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from lola_fakes import JOINTS, STANCE, Clock, FakeLink, pressed, sensor_frame
from stepaside.control.strategy_runner import StrategyRunner
from stepaside.core.errors import ConfigurationError, ReachError, StrategyError
from stepaside.core.poses import Pose
from stepaside.drivers.joint.joint_body import (
    JointBody,
    JointInterface,
    SystemClock,
)
from stepaside.drivers.joint.joint_loop import JointLoop
from stepaside.drivers.joint.safety_state_machine import RobotState
from stepaside.drivers.lola.conventions import CODEC
from stepaside.drivers.lola.lola_frames import pack_sensors
from stepaside.drivers.lola.nao_joints import NAO_MOTORS
from stepaside.drivers.play_log import PlayLog
from stepaside.drivers.row_file import read_rows
from stepaside.drivers.status_line import StatusLine
from stepaside.locomotion.walk_snapshots import Phase, WalkState
from stepaside.perception.measurement import Sighting
from stepaside.planning import Foot, GaitSettings
from stepaside.robots.body_reference import BodyReference
from stepaside.strategies import Evasion, StandStill, Strategy

FINE = pack_sensors(sensor_frame())
PRESS = [pack_sensors(pressed()), FINE]
TO_READY = 100 * [FINE]
WISH = Evasion()


def standing_still() -> WalkState:
    """Nothing planned, on both feet."""
    left, right = Pose(0.0, 0.05, 0.0), Pose(0.0, -0.05, 0.0)
    return WalkState(
        phase=Phase.STANDING,
        gait=GaitSettings(),
        plan=None,
        plan_frame=Pose(0.0, 0.0, 0.0),
        plan_started=0.0,
        left_foot=left,
        right_foot=right,
        first_foot=Foot.LEFT,
        reference=BodyReference(
            (0.0, 0.0, 0.27), (*left[:2], 0.0, 0.0), (*right[:2], 0.0, 0.0)
        ),
        zmp_reference=(0.0, 0.0),
        torso_heading=0.0,
        estimate=None,
        solved=None,
        adapted=0,
    )


class FakeMind:
    """Control that walks until its strategy wants nothing more."""

    def __init__(self, strategy: Strategy) -> None:
        self.decisions = StrategyRunner(strategy, GaitSettings(), 0.012)
        self.phase = Phase.STANDING
        self.joint_targets = STANCE
        self.kinematics = SimpleNamespace(joint_names=JOINTS)
        self.times: list[float] = []
        self.fails: Exception | None = None
        self.begun = None
        self.sighting: Sighting | None = None
        self.locomotion, self.state = self, standing_still()
        self.pose = Pose(0.0, 0.0, 0.0)

    def update(self, measurement: Any) -> Any:
        """Walk."""
        self.times.append(measurement.time)
        if self.fails is not None:
            raise self.fails
        self.decisions.headings.note(measurement.time, 0.0)
        self.decisions.templates.note(measurement.time, Pose(0.0, 0.0, 0.0))
        near = self.sighting = Sighting(measurement.time, 0.0, 0.1)
        going = self.decisions.starts(measurement.time, near)
        self.phase = Phase.WALKING if going else Phase.STANDING
        return STANCE + 0.01


class Game:
    """Joint loop with a fake robot and fake control schemes."""

    def __init__(self, script: list[Any], **changes: Any) -> None:
        self.minds: list[FakeMind] = []
        self.link = FakeLink(Clock(), script)

        def open_body(scheme: Any) -> JointBody:
            clock = self.link.clock
            names = scheme.kinematics.joint_names
            return JointBody(
                JointInterface(self.link, NAO_MOTORS, CODEC),
                dict(zip(names, scheme.joint_targets, strict=True)),
                clock=SystemClock(clock, clock.pause),
                **changes,
            )

        def make(strategy: Any) -> Any:
            self.minds.append(FakeMind(strategy))
            return self.minds[-1]

        self.playing = JointLoop(open_body, WISH, make, **changes)

    def play(self, ticks: int) -> Any:
        """Play some ticks, and return the last."""
        for _ in range(ticks):
            tick = self.playing.tick()
        return tick


def test_control_runs_only_in_states_that_follow_it() -> None:
    game = Game([*TO_READY, *PRESS, *5 * [FINE]])
    game.play(101)
    (mind,) = game.minds
    assert mind.times == []
    game.play(6)
    np.testing.assert_allclose(mind.times, 0.012 * np.arange(6))


def test_the_button_stops_the_walk_and_the_next_has_a_new_scheme() -> None:
    game = Game([*TO_READY, *PRESS, *3 * [FINE], *PRESS, *3 * [FINE]])
    assert game.play(105).phase is Phase.WALKING
    game.play(2)  # pressed and let go: control is told, and walks on
    assert game.playing.body.state is RobotState.STOPPING
    assert isinstance(game.minds[0].decisions.strategy, StandStill)
    assert game.play(1).state is RobotState.RESTING
    assert len(game.minds) == 1
    game.playing.body.fail("lies on its belly")
    game.play(1)
    assert len(game.minds) == 2
    assert game.minds[1].decisions.strategy is WISH


def test_a_robot_that_was_lifted_stands_and_walks_anew_by_the_button() -> None:
    lifted = pack_sensors(sensor_frame(fsr=np.zeros(8)))
    script = [*TO_READY, *PRESS, *40 * [lifted], *5 * [FINE], *PRESS, FINE]
    game = Game(script)
    tick = game.play(142)
    assert tick.state is RobotState.READY and "are lifted" in tick.reason
    assert game.play(5).state is RobotState.READY
    assert len(game.minds) == 2
    game.play(3)
    assert game.playing.body.state is RobotState.WALKING
    assert game.minds[1].decisions.strategy is WISH
    np.testing.assert_allclose(game.minds[1].times, [0.0, 0.012])


@pytest.mark.parametrize("kind", ["footing", "strategy", "falling"])
def test_control_that_gives_up_lets_the_robot_go_limp(kind: str) -> None:
    game = Game([*TO_READY, *PRESS, *5 * [FINE]])
    game.play(103)
    if kind == "footing":
        game.minds[0].fails = ReachError("a leg is too short")
    elif kind == "strategy":
        game.minds[0].fails = StrategyError("KeyError: 'x'")
    else:
        game.minds[0].update = lambda _: STANCE  # type: ignore[method-assign, assignment]
        game.minds[0].phase = Phase.FALLEN
    tick = game.play(1)
    assert tick.state is RobotState.LIMP
    said = {"footing": "too short", "strategy": "'x'", "falling": "a fall"}
    assert said[kind] in tick.reason


def test_a_dry_run_thinks_and_moves_nothing() -> None:
    game = Game([*TO_READY], dry_run=True)
    game.play(50)
    assert len(game.minds[0].times) > 40
    assert all(answer.position is None for answer in game.link.sent)


def test_the_log_keeps_every_tick_and_why_states_changed(
    tmp_path: Path,
) -> None:
    log = PlayLog(tmp_path / "log", {"role": "pursuer"})
    game = Game([*TO_READY, *PRESS])
    for _ in range(102):
        log.note(game.playing.tick())
    log.close()
    arrays = read_rows(tmp_path / "log")
    assert arrays["joint_positions"].shape == (102, 23)
    assert arrays["sighting"].shape == (102, 3)
    words = json.loads((tmp_path / "log" / "play.json").read_text())
    changes = [change["state"] for change in words["changes"]]
    assert changes == ["limp", "reaching", "ready", "walking"]
    assert words["changes"][-1]["reason"] == "chest button"
    assert words["states"][int(arrays["state"][-1])] == "walking"
    assert words["role"] == "pursuer"


def test_a_folder_with_something_in_it_is_not_written_over(
    tmp_path: Path,
) -> None:
    (tmp_path / "mine").write_text("")
    with pytest.raises(
        ConfigurationError, match="record must be a new or an empty folder"
    ):
        PlayLog(tmp_path, {})


class Terminal(io.StringIO):
    """A terminal."""

    def isatty(self) -> bool:
        """Be one."""
        return True


class HungUp(Terminal):
    """Terminal that has hung up."""

    def write(self, text: str) -> int:
        """Fail as the system does."""
        raise OSError(errno.EIO, "Input/output error")


def test_a_terminal_that_hung_up_does_not_end_the_walk() -> None:
    game = Game([*TO_READY, *PRESS])
    line = StatusLine(HungUp(), clock=game.link.clock)
    for _ in range(102):
        line.note(game.playing.tick())
    line.close()
    assert game.playing.body.state is RobotState.WALKING


@pytest.mark.parametrize("stream", [io.StringIO(), Terminal()])
def test_the_line_says_each_change_and_on_terminals_five_times_a_second(
    stream: io.StringIO,
) -> None:
    game = Game([*TO_READY, *PRESS])
    line = StatusLine(stream, clock=game.link.clock)
    for _ in range(102):
        line.note(game.playing.tick())
    line.close()
    said = stream.getvalue()
    for word in ("limp", "reaching", "ready", "walking (chest button)"):
        assert word in said
    assert said.count("\n") == (5 if stream.isatty() else 4)
    wanted = (8, 14) if stream.isatty() else (4, 4)
    assert wanted[0] <= said.count(" s  ") <= wanted[1]
    assert "opponent not detected" in said
