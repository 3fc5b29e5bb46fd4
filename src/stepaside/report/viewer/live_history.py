"""Recent history of a live game, for plots, traces and footsteps."""

from collections import deque
from math import degrees, inf, nan
from typing import TYPE_CHECKING

import numpy as np

from ...core.poses import Array, Pose
from ...games.game import GameInPlay, GameObserver
from ...games.physics_world import PhysicsWorld
from ...games.player_settings import PLAYERS
from ...games.players import Player, RobotPlayer
from ...games.recorded_game import RecordedGame
from ...games.trajectory import angle_between
from ...planning import Foot

if TYPE_CHECKING:  # vision is an extra of its own
    from ...perception.pipeline import FrameReport

PERIOD = 0.1  # between samples, in [s]
MAX_RECORDED = 600.0  # simulated time that is recorded, in [s]
MAX_SAMPLES = 6000  # of the plots
MAX_TRACE = 1500  # points of a trace
MAX_STEPS = 60  # footsteps of each player


def true_odometry(player: Player) -> Pose | None:
    """Return the pose of a robot's odometry in the world, as of now.

    It is the pose in which the supporting sole of the plan is where it is in
    simulation: plans drawn in it begin at the robot's foot, though its
    odometry drifts. None for a player that does not plan.
    """
    walk = player.maneuvers
    if walk is None or not isinstance(player, RobotPlayer):
        return None
    step = walk.step(player.robot.world.time)
    stance, foot = player.robot.stance, step.swing.other
    sole = stance.left_sole if foot is Foot.LEFT else stance.right_sole
    return sole.compose(step.support.inverse())


class LiveHistory(GameObserver):
    """Observer of a game that keeps its recent history.

    Attributes:
        history: (time [s], distance [m], angle [deg]) of the last minutes,
            as the rules define the distance, with the angle between the
            headings of a duel; NaN where there is none.
        closest: Smallest distance at the samples so far, in [m].
        traces: Recent positions of CoM and ZMP in the world, in [m], by
            layer and player.
        steps: Last footsteps of each player, by name; each where it was
            going to land when it began: rows (side, x, y, heading).
        frames: Newest image of each camera with its detections, by player
            and camera.
    """

    def __init__(self) -> None:
        """Start with an empty history."""
        self.history = deque[tuple[float, float, float]](maxlen=MAX_SAMPLES)
        self.closest = inf
        self.traces: dict[tuple[str, str], deque[Array]] = {}
        self.steps: dict[str, deque[Array]] = {}
        self.frames: dict[str, FrameReport] = {}

    def before(self, game: GameInPlay) -> None:
        """Record a sample when one is due."""
        world = game.world
        assert isinstance(world, PhysicsWorld)
        if isinstance(game, RecordedGame) and world.time <= MAX_RECORDED:
            game.recorder.before(game)
        every = max(1, round(PERIOD / world.physics.tick))
        if world.ticks == 0 or world.ticks % every:
            return
        distance, angle = game.distance, nan
        if tuple(player.name for player in world.players) == PLAYERS:
            pursuer, evader = (
                np.array([player.place_in_world]) for player in world.players
            )
            angle = degrees(float(angle_between(pursuer, evader)[0]))
        apart = nan if distance is None else distance
        self.closest = min(self.closest, inf if distance is None else apart)
        self.history.append((world.time, apart, angle))
        for player in world.players:
            x, y, _ = player.truth.position_com_in_world.tolist()
            self._trace("CoM trace", player.name, (x, y))
            # The ZMP is NaN while no foot is in contact.
            if not isinstance(player, RobotPlayer):
                continue
            zmp = player.robot.measured_zmp()
            if np.isfinite(zmp[0]):
                self._trace("ZMP trace", player.name, zmp)

    def _trace(
        self, layer: str, name: str, point: Array | tuple[float, ...]
    ) -> None:
        new = deque[Array](maxlen=MAX_TRACE)
        self.traces.setdefault((layer, name), new).append(np.array(point))

    def acted(self, game: GameInPlay) -> None:
        """Store the steps that begin, and the images that arrived."""
        assert isinstance(game.world, PhysicsWorld)
        if isinstance(game, RecordedGame) and game.world.time <= MAX_RECORDED:
            game.recorder.acted(game)
        for player in game.world.players:
            if not isinstance(player, RobotPlayer):
                continue
            begun = player.walk.begun
            odometry = true_odometry(player) if begun else None
            if begun is not None and odometry is not None:
                pose = odometry.compose(begun.landing)
                row = np.array([begun.foot.value, *pose])
                new = deque[Array](maxlen=MAX_STEPS)
                self.steps.setdefault(player.name, new).append(row)
            if player.perception is None:
                continue
            for report in player.perception.reports:
                self.frames[f"{player.name}, {report.camera}"] = report
