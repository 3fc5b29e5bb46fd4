"""Test the joint loop with a fake control scheme."""

import errno
import io
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from joint_fakes import MOTORS, STANCE, TICK, FakeSession, status
from stepaside.control.strategy_runner import StrategyRunner
from stepaside.core.errors import ConfigurationError, ReachError, StrategyError
from stepaside.core.poses import Pose
from stepaside.drivers.joint_body import JointBody
from stepaside.drivers.joint_loop import JointLoop
from stepaside.drivers.play_log import PlayLog
from stepaside.drivers.row_file import read_rows
from stepaside.drivers.safety_states import SafetyState
from stepaside.drivers.status_line import StatusLine
from stepaside.locomotion.walk_snapshots import Phase, WalkState
from stepaside.perception.measurement import Sighting
from stepaside.planning import Foot, GaitSettings
from stepaside.robots.body_reference import BodyReference
from stepaside.strategies import Evasion, StandStill, Strategy

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
        self.decisions = StrategyRunner(strategy, GaitSettings())
        self.phase = Phase.STANDING
        self.joint_targets = STANCE
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

    def __init__(self, *, dry_run: bool = False) -> None:
        self.minds: list[FakeMind] = []
        self.session = session = FakeSession()
        made: Any = session

        def open_body(scheme: Any) -> JointBody:
            return JointBody(
                made,
                MOTORS,
                scheme.joint_targets,
                dry_run=dry_run,
                clock=session.clock,
            )

        def make(strategy: Any) -> Any:
            self.minds.append(FakeMind(strategy))
            return self.minds[-1]

        self.playing = JointLoop(open_body, WISH, make, dry_run=dry_run)

    def play(self, ticks: int) -> Any:
        """Play some ticks, and return the last."""
        for _ in range(ticks):
            tick = self.playing.tick()
        return tick

    def press(self) -> Any:
        """Press the button, and let it go."""
        for pressed in (True, False):
            self.session.changes["status"] = status(pressed=pressed)
            tick = self.play(1)
        return tick

    @property
    def state(self) -> SafetyState:
        """State of the robot."""
        return self.playing.body.state


def walking() -> Game:
    """Return a game whose robot has begun to walk."""
    game = Game()
    game.play(60)
    assert game.press().state is SafetyState.WALKING
    return game


def test_control_runs_only_in_states_that_follow_it() -> None:
    game = Game()
    game.play(60)
    (mind,) = game.minds
    assert mind.times == []
    game.press()
    game.play(5)
    np.testing.assert_allclose(mind.times, TICK * np.arange(6))


def test_the_button_stops_the_walk_and_the_next_has_a_new_scheme() -> None:
    game = walking()
    assert game.play(3).phase is Phase.WALKING
    game.press()  # control is told, and walks on
    assert game.state is SafetyState.STOPPING
    assert isinstance(game.minds[0].decisions.strategy, StandStill)
    assert game.play(1).state is SafetyState.RESTING
    assert len(game.minds) == 1
    game.playing.body.fail("lies on its belly")
    game.play(1)
    assert len(game.minds) == 2
    assert game.minds[1].decisions.strategy is WISH


def test_a_robot_that_was_lifted_stands_and_walks_anew_by_the_button() -> None:
    game = walking()
    game.session.changes["foot_forces"] = np.zeros(8)
    tick = game.play(40)
    assert tick.state is SafetyState.READY and "are lifted" in tick.reason
    del game.session.changes["foot_forces"]
    assert game.play(5).state is SafetyState.READY
    assert len(game.minds) == 2
    game.press()
    game.play(1)
    assert game.state is SafetyState.WALKING
    assert game.minds[1].decisions.strategy is WISH
    np.testing.assert_allclose(game.minds[1].times, [0.0, TICK])


@pytest.mark.parametrize("kind", ["footing", "strategy", "falling"])
def test_control_that_gives_up_lets_the_robot_go_limp(kind: str) -> None:
    game = walking()
    if kind == "footing":
        game.minds[0].fails = ReachError("a leg is too short")
    elif kind == "strategy":
        game.minds[0].fails = StrategyError("KeyError: 'x'")
    else:
        game.minds[0].update = lambda _: STANCE  # type: ignore[assignment, method-assign]
        game.minds[0].phase = Phase.FALLEN
    tick = game.play(1)
    assert tick.state is SafetyState.LIMP
    said = {"footing": "too short", "strategy": "'x'", "falling": "a fall"}
    assert said[kind] in tick.reason


def test_a_dry_run_thinks_and_moves_nothing() -> None:
    game = Game(dry_run=True)
    game.play(50)
    assert len(game.minds[0].times) > 40


def test_a_robot_without_a_button_is_given_up_once_it_is_limp() -> None:
    game = walking()
    game.playing.body.fail("why not")
    game.play(1)
    assert game.playing.given_up == ""  # its button starts it again
    game.session.changes["status"] = None
    game.play(1)
    assert game.playing.given_up == "the robot was released: why not"


def test_leaving_ends_with_a_limp_robot() -> None:
    game = walking()
    game.playing.leave("asked")
    assert game.play(1).state is SafetyState.STOPPING
    for _ in range(200):
        game.play(1)
        if game.playing.ended:
            break
    assert game.playing.ended and game.state is SafetyState.LIMP


def note_walk(game: Game, observer: Any) -> None:
    """Note 62 ticks, at the last of which the robot walks."""
    for i in range(62):
        pressed = i == 60
        game.session.changes["status"] = status(pressed=pressed)
        observer.note(game.playing.tick())


def test_the_log_keeps_every_tick_and_why_states_changed(
    tmp_path: Path,
) -> None:
    log = PlayLog(tmp_path / "log", {"role": "pursuer"})
    game = Game()
    note_walk(game, log)
    log.close()
    arrays = read_rows(tmp_path / "log")
    assert arrays["joint_positions"].shape == (62, 3)
    assert arrays["sighting"].shape == (62, 3)
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
    game = Game()
    line = StatusLine(HungUp(), clock=game.session.clock.read)
    note_walk(game, line)
    line.close()
    assert game.state is SafetyState.WALKING


@pytest.mark.parametrize("stream", [io.StringIO(), Terminal()])
def test_the_line_says_each_change_and_on_terminals_five_times_a_second(
    stream: io.StringIO,
) -> None:
    game = Game()
    line = StatusLine(stream, clock=game.session.clock.read)
    note_walk(game, line)
    line.close()
    said = stream.getvalue()
    for word in ("limp", "reaching", "ready", "walking (chest button)"):
        assert word in said
    assert said.count("\n") == (5 if stream.isatty() else 4)
    wanted = (8, 14) if stream.isatty() else (4, 4)
    assert wanted[0] <= said.count(" s  ") <= wanted[1]
