"""Recent history of a live game, for plots, traces and footsteps."""

from collections import deque
from math import degrees, inf, nan
from typing import TYPE_CHECKING

import mujoco
import numpy as np
from numpy.typing import NDArray

from ...core.poses import Pose
from ...games.approach_forecast import estimate_approach
from ...games.duel_circle import angle_between
from ...games.duel_settings import PLAYERS
from ...games.game import GameInPlay, GameObserver
from ...games.physics_world import PhysicsWorld
from ...games.player import Player, Snapshot
from ...locomotion.walk_snapshots import StepStarted
from ...planning import Foot
from ...strategies.approach import Approach
from .true_odometry import true_odometry

if TYPE_CHECKING:
    from ...perception.pipeline import FrameReport

PERIOD = 0.1  # between samples, in [s]
MAX_SAMPLES = 6000  # of the plots
MAX_OFFSETS = 100  # samples of the offset
MAX_TRACE = 1500  # points of a trace
MAX_STEPS = 100  # of each player
AXES = ("x [m]", "y [m]", "z [m]")
HINGE = mujoco.mjtJoint.mjJNT_HINGE
Footprint = tuple[Foot, Pose]  # and its landing pose in the world


class PlotHistory(GameObserver):
    """Observer of a game that keeps its recent history.

    Attributes:
        history: (time [s], distance [m], angle [deg]) of the last minutes,
            as the rules define the distance, with the angle between the
            headings of a duel; NaN where there is none.
        closest: Smallest distance at the samples so far, in [m].
        offsets: (time [s], x [m], y [m]) from the evader to the pursuer of a
            duel, in the world, of the last gait cycles.
        traces: Recent positions of CoM and ZMP in the world, in [m], by
            ``player/CoM`` and ``player/ZMP``.
        steps: Last footsteps of each player, by name; each where it was
            going to land when it began.
        signals: Further quantities of every sample in ``history``, in the
            order of ``labels``. Each of shape (labels,).
        labels: Names of these quantities, with units; empty at first.
        frames: Newest image of each camera with its detections, by player
            and camera.
    """

    def __init__(self) -> None:
        """Start with an empty history."""
        self.history: deque[tuple[float, float, float]] = deque(
            maxlen=MAX_SAMPLES
        )
        self.closest = inf
        self.offsets: deque[tuple[float, float, float]] = deque(
            maxlen=MAX_OFFSETS
        )
        self.traces: dict[str, deque[tuple[float, float]]] = {}
        self.steps: dict[str, deque[Footprint]] = {}
        self.signals: deque[NDArray[np.float32]] = deque(maxlen=MAX_SAMPLES)
        self.labels: tuple[str, ...] = ()
        self.frames: dict[str, FrameReport] = {}

    def before(self, game: GameInPlay) -> None:
        """Record a sample when one is due."""
        world = game.world
        assert isinstance(world, PhysicsWorld)
        every = max(1, round(PERIOD / world.physics.tick))
        if world.ticks == 0 or world.ticks % every:
            return
        snapshots = [player.snapshot() for player in world.players]
        distance, angle = game.distance, nan
        if tuple(s.name for s in snapshots) == PLAYERS:
            pursuer, evader = (np.array([s.place]) for s in snapshots)
            angle = degrees(float(angle_between(pursuer, evader)[0]))
            x, y = (pursuer - evader)[0, :2].tolist()
            self.offsets.append((world.time, x, y))
        if distance is not None:
            self.closest = min(self.closest, distance)
        apart = nan if distance is None else distance
        self.history.append((world.time, apart, angle))
        self._record_signals(world, snapshots)
        for snapshot in snapshots:
            self._trace(f"{snapshot.name}/CoM", snapshot.com[:2])
            # The ZMP is NaN while no foot is in contact.
            if snapshot.zmp is not None and np.isfinite(snapshot.zmp[0]):
                self._trace(f"{snapshot.name}/ZMP", snapshot.zmp)

    def _note_step(self, player: Player, begun: StepStarted) -> None:
        """Store where the footstep of a step will be."""
        odometry = true_odometry(player)
        if odometry is not None:
            steps = self.steps.setdefault(player.name, deque(maxlen=MAX_STEPS))
            steps.append((begun.foot, odometry.compose(begun.landing)))

    def _record_signals(
        self, world: PhysicsWorld, snapshots: list[Snapshot]
    ) -> None:
        """Record poses, joint angles, CoM and ZMP of a sample."""
        data, model = world.data, world.model
        joints = [j for j in range(model.njnt) if model.jnt_type[j] == HINGE]
        values: list[float] = []
        for snapshot in snapshots:
            zmp = (nan, nan) if snapshot.zmp is None else snapshot.zmp
            values += [*snapshot.com, snapshot.place.theta, *zmp]
        values += data.qpos[model.jnt_qposadr[joints]].tolist()
        self.signals.append(np.array(values, dtype=np.float32))
        if not self.labels:
            names = [snapshot.name for snapshot in snapshots]
            self.labels = (
                *(label for name in names for label in _labels_of(name)),
                *(f"{model.joint(j).name} [rad]" for j in joints),
            )

    def acted(self, game: GameInPlay) -> None:
        """Store the steps that begin, and the images that arrived."""
        assert isinstance(game.world, PhysicsWorld)
        for player in game.world.players:
            if player.begun is not None:
                self._note_step(player, player.begun)
            for report in player.reports:
                self.frames[f"{player.name}, {report.camera}"] = report

    def approach(self, cycle: float) -> Approach | None:
        """Return the approach of the pursuer over the last gait cycle.

        Args:
            cycle: Duration of a gait cycle, in [s].

        Returns:
            The approach; None before the first cycle has passed.
        """
        if not self.offsets:
            return None
        now, x, y = self.offsets[-1]
        for time, was_x, was_y in reversed(self.offsets):
            if now - time > cycle - 0.5 * PERIOD:
                return estimate_approach((was_x, was_y), (x, y), now - time)
        return None

    def _trace(self, name: str, position: tuple[float, float]) -> None:
        trace = self.traces.setdefault(name, deque(maxlen=MAX_TRACE))
        trace.append(position)


def _labels_of(player: str) -> list[str]:
    """Return the labels of the quantities of one player."""
    com = [f"{player}/CoM {axis}" for axis in AXES]
    zmp = [f"{player}/ZMP {axis}" for axis in AXES[:2]]
    return [*com, f"{player}/heading [rad]", *zmp]
