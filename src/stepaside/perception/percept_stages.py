"""Stages of perception: each percept is detected, observed and tracked."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

from ..core.poses import wrap_angle
from ..robots.body_pose import BodyPose
from ..robots.head import Mount
from .camera_pose import CameraPose, camera_pose
from .colour_detector import ColourDetection, ColourDetector
from .depth_detector import DepthScene, detect_obstacles
from .floor_map import FloorMap
from .images import ColourImage, DepthImage, SonarEcho
from .observations import (
    angle_of,
    is_opponent,
    observe_obstacle,
    observe_shadow,
    observe_trim,
)
from .sonar import is_valid_echo, may_be_mapped, observe_echo
from .target_selection import MAX_GAZE_AGE, TargetSelection
from .track import Observation, TargetTrack
from .tracker import Tracker

MAX_AGE = 0.5  # of the opponent's position when the map is updated, in [s]
NEAR_MARGIN = 0.1  # beyond the near limit: measured in part only, in [m]
MIN_SHADOW = 0.12  # width of a shadow that starts a track, in [rad]
USABLE_VIEW = 0.85  # fraction of the half view in which a track must appear


@dataclass(frozen=True, slots=True, eq=False)
class FrameReport:
    """Detections in one image.

    Attributes:
        image: The image.
        azimuths: Directions of the detections from the camera axis, in
            [rad], positive leftward.
        colour: Detection in a colour image, if any; that of the tallest.
        depth: Obstacles and shadows in a depth image.
    """

    image: ColourImage | DepthImage
    azimuths: tuple[float, ...]
    colour: ColourDetection | None = None
    depth: DepthScene | None = None

    @property
    def camera(self) -> str:
        """Name of the camera: ``colour``, ``depth``, ``depth 1`` and on."""
        if isinstance(self.image, ColourImage):
            return "colour"
        number = self.image.number
        return f"depth {number}" if number else "depth"


def record_misses(
    tracker: Tracker,
    updated: Sequence[object],
    image: ColourImage | DepthImage,
    camera: CameraPose,
    *,
    max_identity_age: float = float("inf"),
    blind_distance: float = 0.0,
) -> None:
    """Count a miss for each track that a frame should show and does not.

    Args:
        tracker: Tracker.
        updated: Tracks that the frame has updated.
        image: The image.
        camera: Pose of the camera at its exposure.
        max_identity_age: Time since a track last had the opponent's
            appearance up to which the frame should show it, in [s].
        blind_distance: Distance from the camera up to which the frame shows
            nothing, in [m].
    """
    half = USABLE_VIEW * abs(angle_of(image, 0.0))
    x, y = camera.position_in_odometry[:2].tolist()
    ahead, time = camera.heading_in_odometry, image.time
    for track in tracker.tracks:
        if track in updated or time - track.identified_at > max_identity_age:
            continue
        if track.distance_from(x, y, time) < blind_distance:
            continue
        if abs(wrap_angle(track.bearing_from(x, y, time) - ahead)) < half:
            track.record_frame(False)


class TopCameraStage:
    """Colour images of the top camera: detect the opponent's trim."""

    def __init__(
        self,
        mount: Mount,
        detector: ColourDetector,
        tracker: Tracker,
        *,
        near: bool,
        most: int = 1,
    ) -> None:
        """Combine the parts.

        Args:
            mount: Mount of the camera on the head.
            detector: Detector of the opponent.
            tracker: Tracker.
            most: Greatest number of opponents in an image.
            near: Whether an image edge may hide a part of the opponent
                without cutting a patch, see :func:`observe_trim`.
        """
        self._mount, self._detector, self._tracker = mount, detector, tracker
        self._near, self._most = near, most

    def process(self, image: ColourImage, body: BodyPose) -> FrameReport:
        """Update the tracks with an image.

        Args:
            image: The image.
            body: Pose of the body at its exposure.
        """
        camera, tracker = camera_pose(body, self._mount), self._tracker
        detected = self._detector.detect_all(image, most=self._most)
        azimuths = tuple(-angle_of(image, found.column) for found in detected)
        observations = [
            observe_trim(
                image,
                found,
                camera,
                self._detector.appearance,
                tracker.tracks,
                near=self._near,
            )
            for found in detected
        ]
        updated = tracker.observe(observations)
        record_misses(
            tracker, updated, image, camera, max_identity_age=MAX_GAZE_AGE
        )
        tallest = detected[0] if detected else None
        return FrameReport(image, azimuths, colour=tallest)


class DepthUse(Protocol):
    """Use of what a depth image shows."""

    def take(
        self, image: DepthImage, scene: DepthScene, camera: CameraPose
    ) -> list[TargetTrack]:
        """Update tracks and map.

        Args:
            image: The image.
            scene: Obstacles and shadows in it.
            camera: Pose of the camera at its exposure.

        Returns:
            Tracks that were updated or started.
        """


class DepthCameraStage:
    """Depth images: detect obstacles and shadows."""

    def __init__(self, mounts: Sequence[Mount], use: DepthUse) -> None:
        """Combine the parts.

        Args:
            mounts: Mounts of the cameras, by number.
            use: Use of the detections.
        """
        self._mounts, self._use = mounts, use

    def process(self, image: DepthImage, body: BodyPose) -> FrameReport:
        """Update tracks and map with an image.

        Args:
            image: The image.
            body: Pose of the body at its exposure.
        """
        mount = self._mounts[image.number]
        camera = camera_pose(body, mount)
        scene = detect_obstacles(image, camera)
        updated = self._use.take(image, scene, camera)
        if mount.on_torso:
            for track in updated:
                track.watched_at = image.time
        azimuths = tuple(o.azimuth for o in scene.obstacles)
        azimuths += tuple(s.azimuth for s in scene.shadows)
        return FrameReport(image, azimuths, depth=scene)


class OpenFloorDepth:
    """Depth on an open floor: every object may be an opponent.

    An object that an image edge cuts may be a piece of a wall, and starts no
    track.
    """

    def __init__(self, tracker: Tracker, *, near_walls: bool) -> None:
        """Update a tracker.

        Args:
            tracker: Tracker.
            near_walls: Whether what an image edge cuts updates only tracks
                that have walked.
        """
        self._tracker, self._near_walls = tracker, near_walls

    def take(
        self, image: DepthImage, scene: DepthScene, camera: CameraPose
    ) -> list[TargetTrack]:
        """Update the tracks with obstacles, then with shadows."""
        tracker = self._tracker
        parts: dict[bool, list[Observation]] = {True: [], False: []}
        for obstacle in scene.obstacles:
            seen = observe_obstacle(image, obstacle)
            parts[obstacle.whole].append(seen)
        updated = tracker.observe(parts[True])
        updated += tracker.observe(
            parts[False], may_start=False, walked_only=self._near_walls
        )
        record_misses(tracker, updated, image, camera)
        for shadow in scene.shadows:
            # A wide shadow without any track may be an unnoticed opponent.
            may_start = shadow.width > MIN_SHADOW and not any(
                track.confirmed for track in tracker.tracks
            )
            wall = self._near_walls and not shadow.whole
            updated += tracker.observe(
                [observe_shadow(image, shadow, camera, tracker.tracks)],
                may_start=may_start and not wall,
                walked_only=wall,
            )
        return updated


class MappedFloorDepth:
    """Depth on a floor that is mapped: objects are obstacles of the map.

    Only trim starts a track. An object updates the track of the opponent if
    it is near its predicted position and not on the map.
    """

    def __init__(
        self,
        tracker: Tracker,
        selection: TargetSelection,
        floor: FloorMap,
        *,
        walked_only: bool,
    ) -> None:
        """Update a tracker and a map.

        Args:
            tracker: Tracker.
            selection: Selection of the opponent.
            floor: Map of the floor.
            walked_only: Whether to update only tracks that have walked.
        """
        self._tracker, self._selection = tracker, selection
        self._floor, self._walked_only = floor, walked_only

    def take(
        self, image: DepthImage, scene: DepthScene, camera: CameraPose
    ) -> list[TargetTrack]:
        """Update the map, then the track of the opponent."""
        tracker, time = self._tracker, image.time
        main = self._selection.main(time, *camera.position_torso_in_odometry)
        opponent = None if main is None else main.position_at(time)
        sure = main is not None and time - main.observed_at < MAX_AGE
        self._floor.take(image, camera, opponent if sure else None)
        observations = [
            observe_obstacle(image, obstacle)
            for obstacle in scene.obstacles
            if is_opponent(obstacle, self._floor, opponent)
        ]
        updated = tracker.observe(
            observations, may_start=False, walked_only=self._walked_only
        )
        blind = image.near + NEAR_MARGIN
        record_misses(tracker, updated, image, camera, blind_distance=blind)
        return updated


class SonarStage:
    """Sonar echoes: distance of the opponent where no camera gives one."""

    def __init__(
        self,
        mounts: Mapping[str, Mount],
        tracker: Tracker,
        selection: TargetSelection,
    ) -> None:
        """Combine the parts.

        Args:
            mounts: Mounts of the sonars on the torso, by name.
            tracker: Tracker.
            selection: Selection of the opponent.
        """
        self._mounts, self._tracker = mounts, tracker
        self._selection = selection

    def process(self, echo: SonarEcho, body: BodyPose) -> None:
        """Update the track of the opponent with an echo.

        Args:
            echo: The echo.
            body: Pose of the body at its time.
        """
        if not is_valid_echo(echo) or self._is_ambiguous(echo, body):
            return
        track = self._selection.main(
            echo.time, *body.pose_torso_in_odometry[:2]
        )
        mount = self._mounts[echo.sonar]
        observation = observe_echo(echo, mount, body, track)
        if observation is not None:
            self._tracker.observe([observation], may_start=track is None)

    def _is_ambiguous(self, echo: SonarEcho, body: BodyPose) -> bool:
        """Return whether an echo may be of anything but the opponent."""
        return False


class MappedSonarStage(SonarStage):
    """Sonar echoes where walls and obstacles of a map give echoes, too."""

    def __init__(
        self,
        mounts: Mapping[str, Mount],
        tracker: Tracker,
        selection: TargetSelection,
        floor: FloorMap,
    ) -> None:
        """Combine the parts.

        Args:
            mounts: Mounts of the sonars on the torso, by name.
            tracker: Tracker.
            selection: Selection of the opponent.
            floor: Map of the floor.
        """
        super().__init__(mounts, tracker, selection)
        self._floor = floor

    def _is_ambiguous(self, echo: SonarEcho, body: BodyPose) -> bool:
        """Return whether no opponent is tracked, or the map explains it."""
        track = self._selection.main(
            echo.time, *body.pose_torso_in_odometry[:2]
        )
        mount = self._mounts[echo.sonar]
        return track is None or may_be_mapped(echo, mount, body, self._floor)
