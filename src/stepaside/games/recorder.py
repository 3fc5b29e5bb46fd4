"""Recorder of a match: one trajectory per player."""

import numpy as np

from ..core.poses import Array, Pose
from ..locomotion.locomotion import StepStarted
from ..planning import Foot
from ..sim.world import World
from .game import GameInPlay, GameObserver
from .physics_world import PhysicsWorld
from .player import Player
from .summary import PlanningSummary
from .trajectory import Trajectory

PERIOD = 0.02  # between samples, in [s]


def samples_every(world: World) -> int:
    """Return the number of control ticks between samples."""
    return max(1, round(PERIOD / world.physics.tick))


class PlayerRecord:
    """Samples and steps of one player."""

    def __init__(self, player: Player, *, closely: bool) -> None:
        """Begin an empty record; see :class:`Recorder`."""
        self._player = player
        self.log = player.motion_log(closely=closely)
        self.begun: list[StepStarted] = []

    def track(self) -> Trajectory:
        """Return the recorded trajectory."""
        arrays = self.log.arrays()
        for name in ("place", "torso"):
            arrays[name][:, 2] = np.unwrap(arrays[name][:, 2])
        player = self._player
        if player.frame is not None:
            arrays["landings"] = self._landings(player.frame)
        if player.pushes:
            arrays["pushes"] = np.array(player.pushes)
        return Trajectory(**arrays)

    def _landings(self, frame: Pose) -> Array:
        rows = [
            (
                step.landing_time,
                1.0 if step.foot is Foot.LEFT else -1.0,
                *frame.compose(step.landing),
            )
            for step in self.begun
        ]
        return np.array(rows, dtype=np.float64).reshape(-1, 5)


class Recorder(GameObserver):
    """Observer of a game in physics that samples all players."""

    def __init__(self, world: PhysicsWorld, *, closely: bool = False) -> None:
        """Record the players of a world, closely with foot states."""
        self._world = world
        self.every = samples_every(world)  # control ticks between samples
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
        for player in self._world.players:
            if player.begun is not None:
                self._records[player.name].begun.append(player.begun)

    def ended(self, game: GameInPlay) -> None:
        """Take the last sample, unless one of this instant exists."""
        for record in self._records.values():
            # An interrupt may have cut the last sample short.
            record.log.truncate(len(self._times))
        if not self._times or self._times[-1] < self._world.time:
            self._sample()

    def _sample(self) -> None:
        for record in self._records.values():
            record.log.add()
        self._times.append(self._world.time)

    def tracks(self) -> dict[str, Trajectory]:
        """Return the trajectories recorded so far, by name of the player."""
        return {name: rec.track() for name, rec in self._records.items()}

    def planning(self) -> PlanningSummary:
        """Return what is known of the plans of all players."""
        begun = [step for rec in self._records.values() for step in rec.begun]
        plans = [step.plan for step in begun]
        times = [s.planning_time for s in begun if s.planning_time is not None]
        median, late = None, None
        if times:
            # np.median and np.quantile would import numpy.ma for it.
            at = np.array([0.5, 0.99]) * (len(times) - 1)
            sorted_times = 1e6 * np.sort(times)
            ranks = np.arange(len(times))
            median, late = np.interp(at, ranks, sorted_times).tolist()
        return PlanningSummary(
            steps=len(begun),
            replans=len(times),
            max_com_velocity_jump_m_s=max(
                (step.velocity_jump for step in begun), default=0.0
            ),
            min_zmp_margin_m=min(
                (p.margin(p.schedule.first_step_duration) for p in plans),
                default=None,
            ),
            median_us=median,
            p99_us=late,
        )
