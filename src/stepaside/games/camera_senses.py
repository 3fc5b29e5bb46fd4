"""Cameras, perception and its evaluation in a game with camera sensing."""

from collections.abc import Iterable, Mapping
from math import atan2, radians

import numpy as np

from ..core.errors import ConfigurationError

try:
    import cv2
except ImportError as error:
    raise ConfigurationError(
        "sensing with cameras needs OpenCV: pip install 'stepaside[vision]'"
    ) from error


from ..core.poses import Array, Sector, wrap_angle, wrap_angles
from ..perception.colour_detector import RED, TRIMS, ColourDetector
from ..perception.gaze import OFTEN, SELDOM, Glances, RoomScan
from ..perception.images import (
    AnyPercept,
    ColourImage,
    DepthImage,
    LidarScan,
    Percept,
)
from ..perception.measurement import Sighting
from ..perception.pipeline import FrameReport, Perception, build_perception
from ..planning import Direction
from ..robots.description import RobotDescription
from ..robots.head import HeadDescription, Mount, load_head
from ..sim.ground_truth import GroundTruth, torsos_apart
from ..sim.offscreen_rendering import (
    RAYCAST,
    OffscreenRenderer,
    choose_renderer,
)
from ..sim.sensor_suite import SensorSuite
from ..sim.simulated_robot import SimulatedRobot
from ..sim.world import World
from ..strategies.strategy import Strategy
from .game import GameInPlay, GameObserver
from .game_settings import GameSettings
from .player_settings import PlayerSettings
from .summary import SightSummary

MATCH_ANGLE = radians(10.0)  # within which a detection matches the truth
MISLED_ANGLE = radians(20.0)  # bearing error from which a robot is misled
NEAR_MARGIN = 0.15  # beyond the near limit at which a body is in range, [m]


class SightEvaluator(GameObserver):
    """Comparison of a robot's detections and sightings with the truth."""

    def __init__(
        self,
        robot: SimulatedRobot,
        other: GroundTruth,
        perception: Perception,
        head: HeadDescription,
        things: list[tuple[float, float]],
        *,
        wears_trim: bool,
        every: int,
    ) -> None:
        """Evaluate one robot, with positions (x, y) of other things, in [m].

        Colour frames cannot detect an opponent without the trim of a robot.
        Sightings are sampled after a number of control ticks.
        """
        self._wears_trim, self._every = wears_trim, every
        self._robot, self._other = robot, other
        self._perception, self._head = perception, head
        self._things = things
        self._true: dict[Percept, tuple[float, bool, list[float]]] = {}
        # Images with the opponent in view, those of them that detected it,
        # and detections that match no object.
        self.in_view = self.detected = self.false = 0
        self._sighting: Sighting | None = None
        self._true_sighting = (np.nan, np.nan)
        self._rows: list[tuple[float, ...]] = []

    def before(self, game: GameInPlay) -> None:
        """Record the latest sighting, if due, and the truth at its time."""
        if self._robot.world.ticks % self._every:
            return
        sighting, estimated = self._sighting, (np.nan, np.nan)
        true = self._truth() if sighting is None else self._true_sighting
        if sighting is not None:
            estimated = (sighting.bearing, sighting.distance)
        lost = float(sighting is None or self._perception.searching)
        self._rows.append((game.world.time, *estimated, *true, lost))

    def acted(self, game: GameInPlay) -> None:
        """Evaluate a tick, after perception and before physics."""
        eyes = self._robot.eyes
        for percept in () if eyes is None else eyes.exposed:
            self.record_truth(percept)
        for report in self._perception.reports:
            self.evaluate(report)
        sighting = self._perception.sighting
        if sighting is not self._sighting:
            self._sighting, self._true_sighting = sighting, self._truth()

    def record_truth(self, percept: AnyPercept) -> None:
        """Store the truth at the instant at which an image is taken."""
        if isinstance(percept, LidarScan):
            return
        head, is_colour = self._head, isinstance(percept, ColourImage)
        if isinstance(percept, DepthImage):
            mount = head.depth_cameras[percept.number]
        else:
            mount = head.top
        position, axes = self._camera(mount)
        height = float(self._other.position_com_in_world[2])
        target = np.array([*self._other.position_torso_in_world, height])
        point = axes.T @ (target - position)
        in_view = percept.camera.sees(point)
        in_view &= self._wears_trim or not is_colour
        if isinstance(percept, DepthImage):
            distance = float(np.hypot(*point[:2]))
            in_view &= percept.near + NEAR_MARGIN < distance < percept.far
        others = [
            _azimuth(axes.T @ (np.array([x, y, 0.2]) - position))
            for x, y in self._things
        ]
        self._true[percept] = (_azimuth(point), in_view, others)

    def evaluate(self, report: FrameReport) -> None:
        """Compare the detections of an image with the truth."""
        truth = self._true.pop(report.image, None)
        if truth is None:
            return
        azimuth, in_view, others = truth
        matches = [
            abs(wrap_angle(a - azimuth)) < MATCH_ANGLE for a in report.azimuths
        ]
        if in_view:
            self.in_view += 1
            self.detected += any(matches)
        # The depth camera also detects objects, which are not false.
        allowed = [] if isinstance(report.image, ColourImage) else others
        for angle, fits in zip(report.azimuths, matches, strict=True):
            if not fits and not any(
                abs(wrap_angle(angle - thing)) < 2.0 * MATCH_ANGLE
                for thing in allowed
            ):
                self.false += 1

    def _truth(self) -> tuple[float, float]:
        """Return the present bearing, in [rad], and distance, in [m]."""
        own, other = self._robot.truth, self._other
        x, y = own.position_torso_in_world
        u, v = other.position_torso_in_world
        bearing = wrap_angle(atan2(v - y, u - x) - own.heading_in_world)
        return bearing, torsos_apart(own, other)

    def array(self) -> Array:
        """Return ``sight`` of a trajectory; truth at the time of sighting."""
        return np.array(self._rows, dtype=np.float64).reshape(-1, 6)

    def summary(self) -> SightSummary:
        """Return the errors of the sightings."""
        rows = self.array()
        bearing_error = np.abs(wrap_angles(rows[:, 1] - rows[:, 3]))
        distance_error = np.abs(rows[:, 2] - rows[:, 4])
        period = float(np.diff(rows[:2, 0])[0]) if len(rows) > 1 else 0.0
        known = np.isfinite(bearing_error)
        median, late, away = None, None, None
        if known.any():
            errors = np.degrees(bearing_error[known])
            median, late = np.quantile(errors, (0.5, 0.95)).tolist()
            away = float(np.median(distance_error[known]))
        misled = bearing_error[known] > MISLED_ANGLE
        return SightSummary(
            bearing_error_median_deg=median,
            bearing_error_p95_deg=late,
            distance_error_median_m=away,
            misled_s=float(misled.sum() * period),
            lost_s=float(rows[:, 5].sum() * period),
        )

    def _camera(self, mount: Mount) -> tuple[Array, Array]:
        name = f"{self._robot.name}/{self._head.body_of(mount)}"
        body = self._robot.world.data.body(name)
        axes = body.xmat.reshape(3, 3)
        place = body.xpos + axes @ mount.position_in_body
        return place, axes @ mount.axes_in_body


def _azimuth(point: Array) -> float:
    return atan2(float(point[1]), float(point[0]))


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
        strategies: Mapping[str, Strategy],
        *,
        tick: float,
    ) -> None:
        """Prepare the perception of the robots of a game.

        All are of one model. A robot that perceives in this process has a
        strategy; one that walks backward and has no camera on its torso scans
        the room behind.
        """
        # The simulation is sequential; threads of OpenCV would only wait.
        cv2.setNumThreads(1)
        self._settings, self._description = settings, description
        self._head = load_head(description)
        self.renderer = choose_renderer(settings.cameras.colour.renderer)
        self._screen: OffscreenRenderer | None = None
        self.perceptions = {
            own.name: self._perception(own, strategies[own.name], tick)
            for own in settings.sensing_by("cameras")
            if own.name in strategies
        }

    def _perception(
        self, own: PlayerSettings, strategy: Strategy, tick: float
    ) -> Perception:
        """Build the perception of a robot."""
        views, scan, glances = self._fixed_views(own), None, None
        if self._settings.maps_room:
            backward = strategy.direction is Direction.BACKWARD and not views
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
                half = 0.5 * cameras.rear.across
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
            size = self._settings.cameras.colour
            self._screen = OffscreenRenderer(
                world.model, size.width, size.height, self.renderer
            )
        return self._screen

    def evaluators(
        self,
        robots: Iterable[SimulatedRobot],
        truths: Mapping[str, GroundTruth],
        every: int,
    ) -> dict[str, SightEvaluator]:
        """Return the evaluation of robots' sightings of their opponents.

        Of several opponents a sighting does not say whom it shows.
        """
        settings, found = self._settings, {}
        things = [(thing.x, thing.y) for thing in settings.scene.things]
        for robot in robots:
            perception = self.perceptions.get(robot.name)
            others = settings.sensed_opponents(settings.player(robot.name))
            if perception is not None and len(others) == 1:
                found[robot.name] = SightEvaluator(
                    *(robot, truths[others[0].name], perception),
                    *(self._head, things),
                    wears_trim=others[0].body == "robot",
                    every=every,
                )
        return found
