"""Signals of robots that a run folder does not hold, from a repeated game.

A duel or a walk follows from its configuration, bit by bit. Playing it again
gives what was not recorded: joint velocities and efforts, exact IMU and foot
forces, plans, the memory of the strategy, and camera images.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, fields, is_dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from ..core.poses import Array, Pose
from ..core.row_table import RowTable
from ..locomotion.locomotion import StepStarted
from ..perception.images import ColourImage, DepthImage
from .game import GameInPlay, GameObserver, Progress, play
from .game_settings import GameSettings
from .outcome import Outcome
from .physics_world import PhysicsWorld
from .recorded_game import RecordedGame
from .recorder import samples_every
from .robot_player import RobotPlayer
from .run import Run

Image = ColourImage | DepthImage


class PlannedFootsteps(NamedTuple):
    """Footsteps of a maneuver, planned when its first step begins."""

    time: float  # at which the first step begins [s]
    footsteps: Array
    """Rows (side: 1 left, -1 right; x [m], y [m], heading [rad]) in the
    world."""


@dataclass(frozen=True, slots=True, eq=False)
class RobotSignals:
    """Signals of one robot, a row per sample of its run; None if unknown.

    Those of a repeated game are true: without sensor errors. Those of a play
    are measurements of the robot.
    """

    torso_velocity: Array | None = None
    """Linear in the world [m/s], angular in the torso [rad/s]."""
    joint_velocity: Array | None = None  # in the order of qpos [rad/s]
    joint_effort: Array | None = None  # motor torques at the joints [N m]
    gyro: Array | None = None  # in the torso [rad/s]
    accelerometer: Array | None = None  # specific force, in the torso [m/s^2]
    foot_forces: Array | None = None  # as ``RobotState.foot_forces`` [N]
    com_velocity: Array | None = None  # (x, y) in the world [m/s]
    target_names: tuple[str, ...] = ()  # of the actuated joints
    joint_targets: Array | None = None  # that control sends to them [rad]
    dcm: Array | None = None  # in the world [m], of a walk by maneuvers
    plans: tuple[PlannedFootsteps, ...] = ()
    phases: tuple[tuple[float, str], ...] = ()
    """Time [s] and new phase, "standing" or "walking", at each change."""
    strategy: Mapping[str, Array] = field(default_factory=dict)
    """Numbers of the strategy by name: sighting, desired heading, entries of
    its memory; NaN where there is none."""
    images: tuple[Image, ...] = ()  # with the times of their exposure


class RepeatedGame(NamedTuple):
    """Signals of a game that was played again.

    They are empty, with a reason, if the game differed from its run, or
    cannot be repeated.
    """

    robots: Mapping[str, RobotSignals]
    reason: str = ""


class RobotSignalRecord:
    """Signals of one robot while its game is played."""

    def __init__(self, player: RobotPlayer) -> None:
        """Begin without samples."""
        self._player = player
        self._log = player.robot.sensor_log()
        self._numbers: list[dict[str, float]] = []
        self._plans: list[PlannedFootsteps] = []
        self._phases: list[tuple[float, str]] = []
        self._images: list[Image] = []
        self._targets = RowTable(len(player.robot.joint_names))
        self._awaits_targets = False

    def sample(self, now: float) -> None:
        """Sample the present state."""
        self._log.add()
        self._awaits_targets = True
        phase = self._player.scheme.phase.value
        if not self._phases or self._phases[-1][1] != phase:
            self._phases.append((now, phase))
        self._numbers.append(dict(_strategy_numbers(self._player)))

    def act(self, now: float) -> None:
        """Record targets, a plan that begins, and images that were taken."""
        if self._awaits_targets:
            self._awaits_targets = False
            self._targets.append()[:] = self._player.scheme.joint_targets
        begun = self._player.begun
        if begun is not None:
            self._plans.append(self._plan(self._player, begun))
        eyes = self._player.robot.eyes
        for percept in () if eyes is None else eyes.exposed:
            if isinstance(percept, ColourImage | DepthImage):
                if percept.time >= now - 1e-9:
                    self._images.append(percept)

    def _plan(
        self, player: RobotPlayer, begun: StepStarted
    ) -> PlannedFootsteps:
        frame = player.frame.compose(player.scheme.walk.plan_frame)
        rows = [
            (float(step.foot.value), *frame.compose(Pose(*pose)))
            for step in begun.plan.footsteps
            for pose in [(step.x, step.y, step.theta)]
        ]
        return PlannedFootsteps(begun.started, np.array(rows))

    def signals(self, com: Array) -> RobotSignals:
        """Return the signals, with the recorded CoM. Shape (n, 3)."""
        count = len(com)
        self._log.truncate(count)
        arrays = self._log.arrays()
        dcm = None
        if self._player.plans:
            eta = self._player.scheme.locomotion.gait.eta
            dcm = com[:, :2] + arrays["com_velocity"] / eta
        targets = self._targets.rows[:count]
        # No command follows the last sample of a finished game.
        missing = targets[-1:].repeat(count - len(targets), axis=0)
        keys = dict.fromkeys(key for row in self._numbers for key in row)
        strategy = {
            key: np.array(
                [row.get(key, np.nan) for row in self._numbers[:count]]
            )
            for key in keys
        }
        return RobotSignals(
            **arrays,
            target_names=self._player.robot.joint_names,
            joint_targets=np.concatenate([targets, missing]),
            dcm=dcm,
            plans=tuple(self._plans),
            phases=tuple(self._phases),
            strategy=strategy,
            images=tuple(self._images),
        )


class SignalRecorder(GameObserver):
    """Observer that records the signals of all robots.

    Samples are taken when :class:`Recorder` takes its own.
    """

    def __init__(self) -> None:
        """Begin without a match."""
        self._records: dict[str, RobotSignalRecord] = {}
        self._last = -1.0

    def before(self, game: GameInPlay) -> None:
        """Take a sample when one is due."""
        world = game.world
        assert isinstance(world, PhysicsWorld)
        if not self._records:
            self._records = {
                player.name: RobotSignalRecord(player)
                for player in world.players
                if isinstance(player, RobotPlayer)
            }
        if world.ticks % samples_every(world) == 0:
            self._sample(world.time)

    def acted(self, game: GameInPlay) -> None:
        """Record plans and images of this tick."""
        for record in self._records.values():
            record.act(game.world.time)

    def ended(self, game: GameInPlay) -> None:
        """Take the last sample, unless one of this instant exists."""
        if self._last < game.world.time:
            self._sample(game.world.time)

    def _sample(self, now: float) -> None:
        self._last = now
        for record in self._records.values():
            record.sample(now)

    def signals(self, run: Run) -> dict[str, RobotSignals]:
        """Return the signals of all robots of a run, by name."""
        return {
            name: record.signals(run.tracks[name].com)
            for name, record in self._records.items()
        }


def repeat_game(
    run: Run, report: Callable[[Progress], None] | None = None
) -> RepeatedGame:
    """Play a game again and record the signals of its robots.

    Raises:
        StepAsideError: If the settings cannot be met on this computer, for
            example for want of a renderer.
        KeyboardInterrupt: If it was interrupted.
    """
    recorder = SignalRecorder()
    settings = run.settings
    if not isinstance(settings, GameSettings) or not run.robots:
        return RepeatedGame({}, f"a {run.game} cannot be repeated")
    game = RecordedGame(settings, (recorder,))
    game.rules = replace(game.rules, duration=run.duration)
    play(game, report=report)
    if game.outcome is Outcome.INTERRUPTED:
        raise KeyboardInterrupt
    again, times = game.recorder.tracks(), game.recorder.times
    for name in run.robots:
        then, now = run.tracks[name].qpos, again[name].qpos
        if then is None or now is None:
            return RepeatedGame({}, f"{name} has no recorded joint angles")
        if not np.array_equal(times, run.times) or not np.array_equal(
            then, now
        ):
            return RepeatedGame(
                {},
                f"played again, {name} moved differently: its commands came "
                "from elsewhere, or this computer calculates differently",
            )
    return RepeatedGame(recorder.signals(run))


def _strategy_numbers(player: RobotPlayer) -> Iterator[tuple[str, float]]:
    """Yield name and value of the numbers of a player's strategy."""
    scheme = player.scheme
    sighting = scheme.sighting
    if sighting is not None:
        yield "sighting_bearing_rad", sighting.bearing
        yield "sighting_distance_m", sighting.distance
    if player.plans:
        plan = player.scheme.walk.plan
        if plan is not None:
            yield "desired_heading_rad", plan.bearing
    yield "pace", scheme.decisions.pace
    for name, value in _entries(scheme.decisions.memory):
        if isinstance(value, bool | int | float):
            yield f"memory_{name}", float(value)


def _entries(memory: Any) -> Iterator[tuple[str, Any]]:
    """Yield the named entries of a strategy's memory."""
    if hasattr(memory, "_asdict"):
        yield from memory._asdict().items()
    elif is_dataclass(memory):
        for entry in fields(memory):
            yield entry.name, getattr(memory, entry.name)
