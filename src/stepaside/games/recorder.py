"""Recorder of a game in physics: one trajectory per player."""

from array import array
from typing import TYPE_CHECKING, Any

import numpy as np

from ..core.poses import Array, Pose
from ..locomotion.locomotion import StepStarted
from ..perception.images import ColourImage, DepthImage
from .floor_world import PERIOD
from .game import GameInPlay, GameObserver
from .physics_world import PhysicsWorld
from .players import Player, RobotPlayer
from .summary import PlanningSummary
from .trajectory import Trajectory

if TYPE_CHECKING:
    from ..locomotion.zmp.mpc import MpcResult


class PlayerRecord:
    """Samples, steps and images of one player."""

    def __init__(self, player: Player, *, closely: bool) -> None:
        """Begin an empty record; see :class:`Recorder`."""
        self._player, self._closely = player, closely
        self._widths: dict[str, int] = {}
        self._values = array("d")  # of all samples, one after the other
        self._numbers: list[dict[str, float]] = []
        self._plans: list[tuple[float, ...]] = []
        self._images: list[ColourImage | DepthImage] = []
        self.begun: list[StepStarted] = []
        self.solved: list[MpcResult] = []

    def sample(self) -> None:
        """Sample the present state."""
        player = self._player
        found = player.sample(closely=self._closely)
        if not self._widths:
            self._widths = {name: np.size(own) for name, own in found.items()}
        parts: list[Any] = [
            own if isinstance(own, np.ndarray) else array("d", own)
            for own in found.values()
        ]
        self._values.frombytes(b"".join(parts))
        if self._closely and isinstance(player, RobotPlayer):
            from .close_samples import strategy_numbers

            self._numbers.append(dict(strategy_numbers(player.scheme)))

    def act(self, now: float) -> None:
        """Record the step that begins at this tick, and its images."""
        player, walk = self._player, self._player.maneuvers
        if not isinstance(player, RobotPlayer):
            return
        begun = player.walk.begun
        if begun is not None:
            self.begun.append(begun)
        if not self._closely:
            return
        if walk is not None and walk.balance.solved is not None:
            self.solved.append(walk.balance.solved)
        if walk is not None and begun is not None:
            frame = player.frame.compose(walk.plan_frame)
            for number, step in enumerate(begun.plan.footsteps):
                pose = frame.compose(Pose(step.x, step.y, step.theta))
                row = begun.started, number, step.foot.value, *pose
                self._plans.append(row)
        for percept in player.robot.eyes.exposed if player.robot.eyes else ():
            if isinstance(percept, ColourImage | DepthImage):
                if percept.time >= now - 1e-9:
                    self._images.append(percept)

    def track(self, count: int) -> Trajectory:
        """Return the trajectory of the first samples."""
        ends = np.cumsum([*self._widths.values()])
        rows = np.array(self._values).reshape(-1, ends[-1])[:count]
        parts = np.split(rows, ends[:-1], axis=1)
        arrays = dict(zip(self._widths, parts, strict=True))
        if isinstance(self._player, RobotPlayer):
            arrays = self._player.robot.trajectory(arrays)
        for name in ("place", "torso"):
            arrays[name][:, 2] = np.unwrap(arrays[name][:, 2])
        if "qpos" in arrays:
            arrays["qpos"] = arrays["qpos"].astype(np.float32)
        if "estimate" in arrays and np.isnan(arrays["estimate"]).all():
            del arrays["estimate"]
        player, numbers = self._player, self._numbers[:count]
        if player.frame is not None:
            arrays["landings"] = self._landings(player.frame)
            for name in arrays.keys() & {"com_reference", "zmp_reference"}:
                arrays[name] = player.frame.transform_points(arrays[name])
        if isinstance(player, RobotPlayer) and player.robot.pushes:
            arrays["pushes"] = np.array(player.robot.pushes)
        if self._plans:
            arrays["plans"] = np.array(self._plans)
        keys = dict.fromkeys(key for row in numbers for key in row)
        strategy = {
            key: np.array([row.get(key, np.nan) for row in numbers])
            for key in keys
        }
        return Trajectory(
            **arrays, strategy=strategy, images=tuple(self._images)
        )

    def _landings(self, frame: Pose) -> Array:
        rows = [
            (step.landing_time, step.foot.value, *frame.compose(step.landing))
            for step in self.begun
        ]
        return np.array(rows, dtype=np.float64).reshape(-1, 5)


class Recorder(GameObserver):
    """Observer of a game in physics that samples all players."""

    def __init__(self, world: PhysicsWorld, *, closely: bool = False) -> None:
        """Record the players of a world, closely with all their signals."""
        self._world = world
        # Control ticks between samples.
        self.every = max(1, round(PERIOD / world.physics.tick))
        self._times: list[float] = []
        self._records = {
            player.name: PlayerRecord(player, closely=closely)
            for player in world.players
        }

    @property
    def times(self) -> Array:
        """Times of the samples, in [s]. Shape (n,)."""
        return np.array(self._times)

    def before(self, game: GameInPlay) -> None:
        """Take a sample when one is due."""
        if self._world.ticks % self.every == 0:
            self._sample()

    def acted(self, game: GameInPlay) -> None:
        """Record the steps that begin at this tick."""
        for record in self._records.values():
            record.act(self._world.time)

    def ended(self, game: GameInPlay) -> None:
        """Take the last sample, unless one of this instant exists."""
        if not self._times or self._times[-1] < self._world.time:
            self._sample()

    def _sample(self) -> None:
        for record in self._records.values():
            record.sample()
        self._times.append(self._world.time)

    def tracks(self) -> dict[str, Trajectory]:
        """Return the trajectories recorded so far, by name of the player."""
        count = len(self._times)
        return {name: own.track(count) for name, own in self._records.items()}

    @property
    def solved(self) -> "list[MpcResult]":
        """Results of the MPC of all players that are recorded closely."""
        return [each for own in self._records.values() for each in own.solved]

    def planning(self) -> PlanningSummary:
        """Return what is known of the plans of all players."""
        begun = [step for rec in self._records.values() for step in rec.begun]
        plans = [step.plan for step in begun]
        times = sorted(
            1e6 * step.planning_time
            for step in begun
            if step.planning_time is not None
        )
        median, late = (
            times[round(share * (len(times) - 1))] if times else None
            for share in (0.5, 0.99)
        )
        return PlanningSummary(
            steps=len(begun),
            replans=len(times),
            min_zmp_margin_m=min(
                (p.margin(p.schedule.first_step_duration) for p in plans),
                default=None,
            ),
            median_us=median,
            p99_us=late,
        )
