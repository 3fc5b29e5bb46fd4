"""Perception: sightings of the opponent from images and echoes, and gaze."""

from collections.abc import Sequence
from dataclasses import dataclass

from ..core.poses import Array, Pose, Sector, wrap_angle
from ..robots.body_pose import BodyPose
from .camera_pose import BodyPoseHistory, PoseHistory
from .floor_map import FloorMap
from .head_motion import GazeTarget, HeadControl
from .images import (
    AnyPercept,
    ColourImage,
    DepthImage,
    LidarScan,
    Percept,
    SonarEcho,
)
from .measurement import Measurement, Sighting
from .percept_stages import (
    DepthCameraStage,
    FrameReport,
    SonarStage,
    TopCameraStage,
)
from .target_selection import TargetSelection, UnnamedSelection
from .track import TargetTrack
from .tracker import Tracker


@dataclass(frozen=True, slots=True, eq=False)
class PerceptStages:
    """Stages for each kind of percept.

    Attributes:
        top: Colour images of the top camera.
        depth: Depth images.
        sonar: Echoes.
    """

    top: TopCameraStage
    depth: DepthCameraStage
    sonar: SonarStage

    def process(self, percept: Percept, body: BodyPose) -> FrameReport | None:
        """Update tracks and map with an image or echo.

        Args:
            percept: The image or echo.
            body: Pose of the body at its time.

        Returns:
            Detections in an image; None for an echo.
        """
        if isinstance(percept, ColourImage):
            return self.top.process(percept, body)
        if isinstance(percept, DepthImage):
            return self.depth.process(percept, body)
        self.sonar.process(percept, body)
        return None


class PosedPerception:
    """Pipeline from images and echoes to sightings of the opponent and gaze.

    Each image updates tracks and map with the body pose at its exposure.
    Then the target is selected. This happens when an image or echo arrives,
    or an update period ends; at other ticks only the head moves.

    Attributes:
        poses: Past poses of the body.
        tracker: Tracks of all objects.
        head: Motion of the head.
        sighting: Estimate of the opponent at the last update; None if lost.
        unnamed: Sightings of all recognised robots by their numbers, where
            several wear one trim; else empty.
        gaze_target: Target of the gaze; None while the head searches.
        reports: Detections in the images that arrived at the last tick.
        floor: Map of the floor, if there is one.
    """

    def __init__(
        self,
        poses: PoseHistory,
        stages: PerceptStages,
        tracker: Tracker,
        selection: TargetSelection,
        head: HeadControl,
        floor: FloorMap | None = None,
        *,
        fixed_views: tuple[Sector, ...] = (),
        update_period: float,
    ) -> None:
        """Combine the parts; see :mod:`.perception_builder`.

        Args:
            poses: Past poses of the body.
            stages: Stages that process images and echoes.
            tracker: Tracker that the stages update.
            selection: Selection of the target among its tracks.
            head: Motion of the head.
            floor: Map of the floor that the stages fill, if any.
            fixed_views: Bearings that cameras on the torso show.
            update_period: Longest time between two selections of the target,
                by tracks predicted to the present, in [s]; 0 for every tick.
        """
        self.poses, self.tracker, self.floor = poses, tracker, floor
        self.head, self._fixed_views = head, fixed_views
        self._stages, self._selection = stages, selection
        self._update_period, self._next_update = update_period, 0.0
        self._heading, self._watched = 0.0, False
        self.sighting: Sighting | None = None
        self.unnamed: tuple[Sighting, ...] = ()
        self.gaze_target: GazeTarget | None = None
        self.reports: list[FrameReport] = []

    @property
    def body(self) -> BodyPose | None:
        """Latest pose of the body; None before the first measurement."""
        return self.poses.latest

    @property
    def views(self) -> tuple[Sector, ...]:
        """Range of the head, and bearings that cameras on the torso show."""
        return (Sector(0.0, self.head.reach), *self._fixed_views)

    @property
    def searching(self) -> bool:
        """Whether the head searches, and no camera on the torso watches."""
        return self.gaze_target is None and not self._watched

    def see_from(
        self, body: BodyPose, percepts: Sequence[AnyPercept]
    ) -> Sighting | None:
        """Process the images of a robot whose pose is known.

        Args:
            body: Pose of the body now; those of the exposures have been
                added to ``poses``.
            percepts: Images and echoes that have arrived.

        Returns:
            Latest sighting of the opponent; None if it is lost.
        """
        self.poses.add_pose(body)
        return self._process(body.time, percepts)

    def _process(
        self, now: float, percepts: Sequence[AnyPercept]
    ) -> Sighting | None:
        self.reports.clear()
        # A LoLA frame brings a value of each sonar, though most often none.
        arrived = [
            percept
            for percept in percepts
            if not isinstance(percept, LidarScan) and not _is_empty(percept)
        ]
        if arrived or now >= self._next_update:
            self._next_update = now + self._update_period - 1e-9
            for percept in arrived:
                body = self.poses.at(percept.time)
                report = self._stages.process(percept, body)
                if report is not None:
                    self.reports.append(report)
            self._select(now, self.poses.at(now))
        self.head.move(now, self._heading, self.gaze_target)
        return self.sighting

    def _select(self, now: float, body: BodyPose) -> None:
        """Select the opponent, and the target of the gaze."""
        x, y, heading = body.pose_torso_in_odometry
        self._heading = heading
        main = self._selection.main(now, x, y)
        self.sighting = self.gaze_target = None
        self._watched = main is not None and main.is_watched(now)
        self.unnamed = ()
        if self.head.scans:
            return
        chosen = self._selection.look(main, now, x, y)
        if chosen is not None:
            bearing, distance = _bearing_and_distance(chosen, body, now)
            self.gaze_target = GazeTarget(bearing, distance, chosen.height)
        if main is not None:
            self.sighting = self._sighting_of(main, body, now)
        if isinstance(self._selection, UnnamedSelection):
            self.unnamed = tuple(
                self._sighting_of(track, body, now)
                for track in self._selection.recognised(now)
            )

    def _sighting_of(
        self, track: TargetTrack, body: BodyPose, now: float
    ) -> Sighting:
        """Return the sighting of a track at a time, in [s]."""
        x, y, _ = body.pose_torso_in_odometry
        bearing, distance = _bearing_and_distance(track, body, now)
        return Sighting(
            now,
            bearing,
            distance,
            self._selection.target_id(track),
            self._selection.settled(track, now, x, y),
            track.deviation_at(now),
        )


class Perception(PosedPerception):
    """Perception of a body whose pose follows from its joints.

    Attributes:
        poses: Past poses of the body, with its kinematics.
    """

    poses: BodyPoseHistory

    def see(
        self,
        measurement: Measurement,
        pose_support_in_odometry: Pose,
        left_supports: bool,
        tilt: tuple[float, float],
    ) -> Sighting | None:
        """Process the measurement of one tick.

        Args:
            measurement: Values of the sensors.
            pose_support_in_odometry: Pose of the support foot.
            left_supports: Whether that is the left foot.
            tilt: Roll and pitch of the torso, in [rad].

        Returns:
            Latest sighting of the opponent; None if it is lost.
        """
        time, joints = measurement.time, measurement.joint_positions
        support = pose_support_in_odometry
        self.poses.add(time, joints, support, left_supports, tilt)
        return self._process(time, measurement.percepts)

    def see_level(
        self, measurement: Measurement, pose_in_odometry: Pose
    ) -> Sighting | None:
        """Process a measurement of a level robot with its own walk.

        Args:
            measurement: Values of its sensors.
            pose_in_odometry: Pose of the robot.

        Returns:
            Latest sighting of the opponent; None if it is lost.
        """
        time, joints = measurement.time, measurement.joint_positions
        self.poses.add_level(time, joints, pose_in_odometry)
        return self._process(time, measurement.percepts)

    def aim(self, joint_targets: Array) -> None:
        """Write the targets of the head joints, in [rad], in place."""
        kinematics = self.poses.kinematics
        joint_targets[kinematics.yaw] = self.head.yaw
        joint_targets[kinematics.pitch] = self.head.pitch


def _bearing_and_distance(
    track: TargetTrack, body: BodyPose, now: float
) -> tuple[float, float]:
    """Return the bearing from the torso, in [rad], and distance, in [m]."""
    x, y, heading = body.pose_torso_in_odometry
    bearing = wrap_angle(track.bearing_from(x, y, now) - heading)
    return bearing, track.distance_from(x, y, now)


def _is_empty(percept: Percept) -> bool:
    """Return whether a percept is the absence of an echo."""
    return isinstance(percept, SonarEcho) and percept.distance is None
