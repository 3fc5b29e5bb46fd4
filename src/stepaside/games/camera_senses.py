"""Cameras, perception and its evaluation in a game with camera sensing."""

from collections.abc import Mapping, Sequence
from math import atan2

from ..core.errors import ConfigurationError

try:
    import cv2
except ImportError as error:
    raise ConfigurationError(
        "sensing with cameras needs OpenCV: pip install 'stepaside[vision]'"
    ) from error

from ..core.poses import Array, Sector
from ..perception.colour_detector import RED, TRIMS, ColourDetector
from ..perception.gaze import OFTEN, SELDOM, Glances, RoomScan
from ..perception.pipeline import Perception, build_perception
from ..planning import Direction
from ..robots.description import RobotDescription
from ..robots.head import load_head
from ..sim.camera_settings import RoomObject
from ..sim.ground_truth import GroundTruth
from ..sim.offscreen_rendering import (
    RAYCAST,
    OffscreenRenderer,
    choose_renderer,
)
from ..sim.sensor_suite import SensorSuite
from ..sim.simulated_robot import SimulatedRobot
from ..sim.world import World
from .game import GameInPlay, GameObserver
from .game_settings import GameSettings
from .player_settings import PlayerSettings
from .sight_evaluation import SightEvaluator
from .summary import PerceptionSummary, SightSummary


class CameraSenses:
    """Camera sensing of a game: renderer, perception of each robot.

    Attributes:
        renderer: Name of the renderer of the colour images.
        perceptions: Perception of each robot, by name.
    """

    def __init__(
        self,
        settings: GameSettings,
        description: RobotDescription,
        directions: Mapping[str, Direction],
        *,
        tick: float,
    ) -> None:
        """Prepare the perception of the robots of a game.

        All are of one model. A robot that perceives in this process has a
        driving direction; one that walks backward and has no camera on its
        torso scans the room behind.
        """
        # The simulation is sequential; threads of OpenCV would only wait.
        cv2.setNumThreads(1)
        self._settings, self._description = settings, description
        self._head = load_head(description)
        self.renderer = choose_renderer(settings.cameras.colour.renderer)
        self._screen: OffscreenRenderer | None = None
        self.perceptions = {
            name: self._perception(name, direction, tick)
            for name, direction in directions.items()
        }

    def _perception(
        self, name: str, direction: Direction, tick: float
    ) -> Perception:
        """Build the perception of a robot."""
        own, scan, glances = self._settings.player(name), None, None
        views = self._fixed_views(own)
        if self._settings.maps_room:
            backward = direction is Direction.BACKWARD and not views
            often = own.role == "evader" and not views
            scan = RoomScan(behind=backward)
            glances = Glances(tick, OFTEN if often else SELDOM)
        opponents = self._settings.sensed_opponents(own)
        return build_perception(
            self._description,
            self._head,
            # Of people no colour is known; they are told by their shape.
            ColourDetector(TRIMS.get(opponents[0].role, RED)),
            tick=tick,
            scan=scan,
            glances=glances,
            people=any(p.body == "person" for p in opponents),
            fixed_views=views,
        )

    def _has_depth(self, own: PlayerSettings) -> bool:
        """Return whether a robot has depth cameras."""
        return self._settings.maps_room or own.role == "evader"

    def _fixed_views(self, own: PlayerSettings) -> tuple[Sector, ...]:
        """Return the bearings that cameras on the torso of a robot show."""
        if not self._has_depth(own):
            return ()
        cameras, found = self._settings.cameras, []
        for mount in self._head.depth_mounts(rear=cameras.rear_camera):
            if mount.on_torso:
                x, y, _ = mount.axes_in_body[:, 0].tolist()
                half = 0.5 * cameras.depth_of(mount).across
                found.append(Sector(atan2(y, x), half))
        return tuple(found)

    def eyes_of(self, world: World, name: str) -> SensorSuite:
        """Return the cameras of a robot of a world."""
        own = self._settings.player(name)
        return SensorSuite(
            world,
            name,
            self._description,
            self._settings.cameras,
            self._shared_screen(world),
            self._settings.seed,
            with_depth=self._has_depth(own),
        )

    def _shared_screen(self, world: World) -> OffscreenRenderer | None:
        """Return the renderer of all robots; None for ray casting."""
        if self.renderer != RAYCAST and self._screen is None:
            camera = self._settings.cameras.colour.model()
            self._screen = OffscreenRenderer(
                world.model, camera.width, camera.height, self.renderer
            )
        return self._screen

    def evaluator_of(
        self,
        robot: SimulatedRobot,
        other: GroundTruth,
        things: Sequence[RoomObject] = (),
        *,
        wears_trim: bool,
    ) -> SightEvaluator:
        """Return the evaluation of a robot's sightings of its opponent.

        Things are other objects in view; the opponent may wear the colour
        that is known of its role.
        """
        return SightEvaluator(
            robot,
            other,
            self.perceptions[robot.name],
            self._head,
            [(thing.x, thing.y) for thing in things],
            wears_trim=wears_trim,
        )


class SightObserver(GameObserver):
    """Observer that evaluates the perception of each robot, by name."""

    def __init__(
        self,
        evaluators: Mapping[str, SightEvaluator],
        renderer: str,
        *,
        every: int,
    ) -> None:
        """Compare sightings with the truth in some ticks."""
        self.evaluators = dict(evaluators)
        self._renderer, self._every = renderer, every
        self._ticks = 0

    def before(self, game: GameInPlay) -> None:
        """Compare sightings with the true state, when a sample is due."""
        if self._ticks % self._every == 0:
            for evaluator in self.evaluators.values():
                evaluator.sample(game.world.time)
        self._ticks += 1

    def acted(self, game: GameInPlay) -> None:
        """Evaluate the detections of this tick."""
        for evaluator in self.evaluators.values():
            evaluator.evaluate_tick()

    def sight(self) -> dict[str, Array]:
        """Return estimated and true sightings, by name of the robot."""
        return {name: own.array() for name, own in self.evaluators.items()}

    def report(self) -> tuple[PerceptionSummary, dict[str, SightSummary]]:
        """Return errors and detection rates of all robots and of each."""
        tallies = [
            tally
            for evaluator in self.evaluators.values()
            for tally in (evaluator.colour, evaluator.depth)
        ]
        in_view = sum(t.in_view for t in tallies)
        by_robot = {name: e.summary() for name, e in self.evaluators.items()}
        detected = sum(t.detected for t in tallies)
        together = PerceptionSummary(
            camera=self._renderer,
            detection_rate=detected / in_view if in_view else None,
            false_detections=sum(t.false for t in tallies),
            lost_s=sum(own.lost_s for own in by_robot.values()),
        )
        return together, by_robot
