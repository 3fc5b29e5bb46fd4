"""Perception on synthetic images of a robot at a known pose."""

from math import cos, sin
from typing import Any

import numpy as np
import pytest

from stepaside.core.poses import Pose
from stepaside.perception import pipeline as module
from stepaside.perception.camera_model import CameraModel
from stepaside.perception.colour_detector import RED, ColourDetection
from stepaside.perception.depth_detector import (
    DepthScene,
    DetectedObstacle,
    Shadow,
)
from stepaside.perception.floor_map import FloorMap
from stepaside.perception.gaze import GazeTarget, RoomScan
from stepaside.perception.images import ColourImage, DepthImage
from stepaside.perception.measurement import RobotState
from stepaside.perception.pipeline import FrameReport, build_perception
from stepaside.perception.track import Observation, TargetTrack
from stepaside.robots.description import RobotDescription, load_robot
from stepaside.robots.head import HeadDescription, load_head

TICK = 0.02


NAO = load_robot("nao")


HEAD = load_head(NAO)


CAMERA = CameraModel(160, 120, 140.0, 140.0)


SUPPORT = Pose(1.0, -2.0, 0.7)


UP = np.array([0.0, 0.0, 9.81])


JOINTS = NAO.compile().nu


class FakeDetector:
    """Finds what it is told in every image."""

    appearance = RED

    def __init__(self) -> None:
        self.found: ColourDetection | None = None

    def detect(self, image: ColourImage) -> ColourDetection | None:
        """Find what was told."""
        return self.found


class Eyes:
    """Perception of a robot that stands somewhere, turned."""

    def __init__(
        self,
        *,
        floor: FloorMap | None = None,
        scan: RoomScan | None = None,
        people: bool = False,
        robot: RobotDescription = NAO,
        head: HeadDescription = HEAD,
    ) -> None:
        self.detector = FakeDetector()
        detector: Any = self.detector
        self.perception = build_perception(
            robot, head, detector, tick=TICK, scan=scan, people=people
        )
        self.perception.floor = floor or self.perception.floor
        self.reports: list[FrameReport] = []  # of all ticks so far
        self.support = SUPPORT

    @property
    def target(self) -> GazeTarget | None:
        """Target of the gaze."""
        return self.perception.gaze_target

    @property
    def tracks(self) -> list[TargetTrack]:
        """Everything followed."""
        return self.perception.tracker.tracks

    @property
    def torso(self) -> Pose:
        """Pose of the torso in odometry."""
        assert self.perception.body is not None
        return self.perception.body.pose_torso_in_odometry

    def see(
        self,
        time: float,
        *percepts: Any,
        tilt: tuple[float, float] = (0.0, 0.0),
    ) -> Any:
        """Take in one tick; without percepts, an image of a wall."""
        percepts = percepts or (colour(time),)
        angles, still = np.zeros(JOINTS), np.zeros(3)
        seen = self.perception.see(
            RobotState(time, angles, still, UP, np.zeros(8), None, percepts),
            self.support,
            True,
            tilt,
        )
        self.reports += self.perception.reports
        return seen

    def know(
        self,
        x: float,
        y: float,
        velocity: tuple[float, float] = (0.0, 0.0),
        **changes: Any,
    ) -> TargetTrack:
        """Track an object at a position in odometry."""
        values: dict[str, Any] = {
            "time": 0.0,
            "identified": True,
            "ranged": True,
        } | changes
        track = TargetTrack(
            Observation(
                x_in_odometry=x,
                y_in_odometry=y,
                bearing=0.0,
                along=0.02,
                across=0.02,
                **values,
            ),
            velocity_in_odometry=velocity,
        )
        track.confirmed = True
        self.tracks.append(track)
        return track

    def beside(self, distance: float, bearing: float) -> tuple[float, float]:
        """Place at a distance from the torso, aside of its heading."""
        x, y, heading = self.torso
        angle = heading + bearing
        return x + distance * cos(angle), y + distance * sin(angle)


def colour(time: float) -> ColourImage:
    shape = CAMERA.height, CAMERA.width, 3
    return ColourImage(time, CAMERA, np.zeros(shape, np.uint8))


def depth(time: float) -> DepthImage:
    return DepthImage(time, CAMERA, np.zeros((2, 2), np.float32), 0.8, 3.5)


def trim(column: float) -> ColourDetection:
    """Person whose feet are cut off: the width determines the distance."""
    return ColourDetection(
        column,
        40.0,
        80.0,
        column - 15.0,
        column + 15.0,
        1.0,
        False,
        True,
        False,
    )


def obstacle(x: float, y: float, azimuth: float = 0.0) -> DetectedObstacle:
    return DetectedObstacle(x, y, 1.0, 0.0, azimuth, 0.2, 0.5, True)


def show(
    monkeypatch: pytest.MonkeyPatch, *things: DetectedObstacle | Shadow
) -> list[tuple[Any, ...]]:
    """Let every depth image show some things; notes what it is given."""
    given: list[tuple[Any, ...]] = []
    obstacles = tuple(t for t in things if isinstance(t, DetectedObstacle))
    shadows = tuple(t for t in things if isinstance(t, Shadow))

    def detect(*arguments: Any) -> DepthScene:
        given.append(arguments)
        return DepthScene(obstacles, shadows)

    monkeypatch.setattr(module, "detect_obstacles", detect)
    return given
