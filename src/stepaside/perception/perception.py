"""Perception: sightings of the opponent from images and echoes, and gaze."""

from collections import deque
from collections.abc import Sequence
from math import atan2

from ..core.poses import Array, Pose, wrap_angle
from ..robots.body_pose import BodyKinematics, BodyPose
from ..robots.description import RobotDescription
from ..robots.forward_kinematics import ForwardKinematics
from ..robots.head import HeadDescription
from .bottom_camera import BottomCamera
from .colour_detector import Appearance, ColourDetector
from .depth_detector import detect_obstacles
from .floor_map import FloorMap
from .frame_report import FrameReport
from .gaze import Gaze, Glances
from .images import ColourImage, DepthImage, Percept, SonarEcho
from .measurement import Measurement, Sighting
from .observations import (
    angle_of,
    camera_of,
    observe_obstacles,
    observe_shadow,
    observe_trim,
)
from .people_selection import PeopleSelection
from .room_scan import RoomScan
from .sonar import is_valid_echo, observe_echo
from .target_selection import MAX_GAZE_AGE, RobotSelection, TargetSelection
from .track import PERSON_MOTION, ROBOT_MOTION, Observation, TargetTrack
from .tracker import Tracker

POSE_MEMORY = 1.0  # how long past poses are stored, in [s]
MAX_AGE = 0.5  # of the opponent's position when the map is updated, in [s]
NEAR_MARGIN = 0.1  # beyond the near limit: measured in part only, in [m]
MIN_SHADOW = 0.12  # width of a shadow that starts a track, in [rad]


class Perception:
    """Detection and tracking of the opponent in odometry, with gaze control.

    Attributes:
        body: Pose of the body from its own measurements; None before the
            first.
        sighting: Estimate of the opponent at the last tick; None if lost.
        searching: Whether the head scans for the opponent.
        reports: Detections in the images that arrived at the last tick.
        forward: Kinematics of the measured body, shared with balance.
        floor: Map of the floor, if there is one.
        around: Scan of the room before a game begins.
        started: Whether the game has begun; a robot that maps the floor
            scans until then.
    """

    def __init__(
        self,
        description: RobotDescription,
        head: HeadDescription,
        appearance: Appearance,
        *,
        tick: float,
        floor: FloorMap | None = None,
        glances: float | None = None,
        people: bool = False,
        awaits_start: bool = False,
    ) -> None:
        """Set up the perception of a robot.

        Args:
            description: Description of the robot.
            head: Description of its head.
            appearance: Appearance of the opponent.
            tick: Control period, in [s].
            floor: Map of the floor to fill, which needs a scan of the room
                first; None for no map.
            glances: Time between two glances over the shoulders at the floor
                behind, in [s]; None for no glances.
            people: Whether people, who wear no trim, may approach.
            awaits_start: Whether a signal starts the game; otherwise it
                begins with the end of the scan.
        """
        self._selection: TargetSelection = (
            PeopleSelection() if people else RobotSelection()
        )
        self._people = people
        self.floor = floor
        self.around = RoomScan()
        self.started = not awaits_start
        self._bottom_camera = BottomCamera(
            head.bottom, people=people, floor=floor
        )
        self._glances = None if glances is None else Glances(tick, glances)
        self._head = head
        self.forward = ForwardKinematics(description, head.body)
        self._kinematics = BodyKinematics(description, head, self.forward)
        self._detector = ColourDetector(appearance)
        self._gaze = Gaze(head.coupling, tick)
        self._calm = floor is not None and not people
        self._tracker = Tracker(ROBOT_MOTION if self._calm else PERSON_MOTION)
        self._poses: deque[BodyPose] = deque(maxlen=round(POSE_MEMORY / tick))
        self.body: BodyPose | None = None
        self.sighting: Sighting | None = None
        self.searching = True
        self.reports: list[FrameReport] = []

    def see(
        self,
        measurement: Measurement,
        support: Pose,
        left_supports: bool,
        tilt: tuple[float, float],
    ) -> Sighting | None:
        """Process the measurement of one tick.

        Args:
            measurement: Values of the sensors.
            support: Pose of the support foot in odometry.
            left_supports: Whether that is the left foot.
            tilt: Roll and pitch of the torso, in [rad].

        Returns:
            Sighting of the opponent; None if it is lost.
        """
        body = self._kinematics.pose(
            measurement.time,
            measurement.joint_positions,
            support,
            left_supports,
            tilt,
        )
        return self._process(measurement, body)

    @property
    def head_joints(self) -> tuple[int, int]:
        """Indices of the head joints, yaw and pitch."""
        return self._kinematics.yaw, self._kinematics.pitch

    @property
    def gaze(self) -> tuple[float, float]:
        """Target yaw and pitch of the head, in [rad]."""
        return self._gaze.yaw, self._gaze.pitch

    @property
    def is_ready(self) -> bool:
        """Whether the scan of the room, if any, is complete."""
        return self.floor is None or not self.around.lasts(self._gaze)

    @property
    def looking(self) -> bool:
        """Whether the scan lasts, or the robot waits for the game to start."""
        waits = self.floor is not None and not self.started
        return waits or not self.is_ready

    def looks_low(self) -> bool:
        """Return whether the next image should be from the bottom camera."""
        if self.body is None:
            return False
        now, (x, y, _) = self.body.time, self.body.torso
        main = self._selection.main(self._tracker, now, x, y)
        # A search for the opponent needs all images of the top camera.
        lost = self.sighting is None and not self.looking
        return self._bottom_camera.wanted(self.body, main, lost=lost)

    def _process(
        self, measurement: Measurement, body: BodyPose
    ) -> Sighting | None:
        now = measurement.time
        self.body = body
        self._poses.append(body)
        self.reports.clear()
        for percept in measurement.percepts:
            self._process_percept(percept, self._pose_at(percept.time), now)
        track = self._selection.main(self._tracker, now, *body.torso[:2])
        self.sighting = None
        if self.looking:
            self.around.look(self._gaze, now, body.torso.theta)
            return None
        self._move_gaze(now, body, track)
        if track is not None:
            x, y, heading = body.torso
            bearing = wrap_angle(track.bearing_from(x, y, now) - heading)
            distance = track.distance_from(x, y, now)
            who = track.number if self._people else 0
            settled = self._selection.settled(track, now, x, y)
            spread = track.deviation_at(now)
            self.sighting = Sighting(
                now, bearing, distance, who, settled, spread
            )
        return self.sighting

    def aim(self, joint_targets: Array) -> None:
        """Write the targets of the head joints, in [rad], in place."""
        joint_targets[self._kinematics.yaw] = self._gaze.yaw
        joint_targets[self._kinematics.pitch] = self._gaze.pitch

    def _move_gaze(
        self, now: float, body: BodyPose, track: TargetTrack | None
    ) -> None:
        """Move the gaze to the selected track, or scan."""
        x, y, heading = body.torso
        tracks = self._tracker.tracks
        chosen = self._selection.look(tracks, track, now, x, y)
        self.searching = chosen is None
        if chosen is None:
            self._gaze.search()
            return
        distance = chosen.distance_from(x, y, now)
        bearing = chosen.bearing_from(x, y, now) - heading
        if self._glances is not None:
            bearing = self._glances.direction(bearing, distance)
        self._gaze.follow(bearing, distance, chosen.height)

    def _pose_at(self, time: float) -> BodyPose:
        known = (p for p in reversed(self._poses) if p.time <= time + 1e-9)
        return next(known, self._poses[0])

    def _process_percept(
        self, percept: Percept, body: BodyPose, now: float
    ) -> None:
        if isinstance(percept, ColourImage):
            self._process_colour(percept, body, now)
        elif isinstance(percept, DepthImage):
            self._process_depth(percept, body, now)
        else:
            self._process_echo(percept, body, now)

    def _process_colour(
        self, image: ColourImage, body: BodyPose, now: float
    ) -> None:
        if image.low:
            self._process_bottom(image, body)
            return
        position, axes = camera_of(body, self._head.top)
        own = body.torso[:2]
        main = None
        if self.floor is not None:
            main = self._selection.main(self._tracker, now, *own)
        tracks = self._tracker.tracks
        self._bottom_camera.learn(
            image,
            position,
            axes,
            own,
            tracks,
            main,
        )
        found = self._detector.detect(image)
        azimuths: tuple[float, ...] = ()
        observations: list[Observation] = []
        if found is not None:
            azimuths = (-angle_of(image, found.column),)
            view = (
                image,
                found,
                position,
                axes,
                self._detector.appearance,
            )
            observations = [observe_trim(*view, tracks, near=self._calm)]
        self.reports.append(FrameReport(image, azimuths, colour=found))
        self._observe(
            observations,
            image,
            position,
            axes,
            by_appearance=True,
        )

    def _process_bottom(self, image: ColourImage, body: BodyPose) -> None:
        observations, report = self._bottom_camera.see(image, body)
        self.reports.append(report)
        self._tracker.observe(observations, may_start=False, walked_only=True)

    def _process_depth(
        self, image: DepthImage, body: BodyPose, now: float
    ) -> None:
        position, axes = camera_of(body, self._head.depth)
        own = body.torso[:2]
        scene = detect_obstacles(
            image,
            position,
            axes,
            own,
        )
        azimuths = tuple(o.azimuth for o in scene.obstacles)
        azimuths += tuple(s.azimuth for s in scene.shadows)
        self.reports.append(FrameReport(image, azimuths, depth=scene))
        opponent = None
        if self.floor is not None:
            main = self._selection.main(self._tracker, now, *own)
            opponent = None if main is None else main.position_at(image.time)
            sure = main is not None and now - main.observed_at < MAX_AGE
            self.floor.take(
                image,
                position,
                axes,
                own,
                opponent if sure else None,
            )
        whole, cut = observe_obstacles(
            image, scene.obstacles, self.floor, opponent
        )
        self._observe(
            whole,
            image,
            position,
            axes,
            by_appearance=False,
            cut=cut,
        )
        for shadow in scene.shadows if self.floor is None else ():
            tracks = self._tracker.tracks
            # A wide shadow without any track may be an unnoticed opponent.
            may_start = shadow.width > MIN_SHADOW and not any(
                track.confirmed for track in tracks
            )
            near = observe_shadow(image, shadow, position, tracks)
            # A shadow that an image edge cuts may be a wall: among people
            # it updates only tracks that have walked.
            wall = self._people and not shadow.whole
            self._tracker.observe(
                [near], may_start=may_start and not wall, walked_only=wall
            )

    def _process_echo(
        self, echo: SonarEcho, body: BodyPose, now: float
    ) -> None:
        """Update the track with an echo when no camera gives a distance."""
        if not is_valid_echo(echo):
            return
        track = self._selection.main(self._tracker, now, *body.torso[:2])
        mount = self._head.sonars[echo.sonar]
        observation = observe_echo(echo, mount, body, track, self.floor, now)
        if observation is not None:
            self._tracker.observe([observation], may_start=track is None)

    def _observe(
        self,
        observations: list[Observation],
        image: ColourImage | DepthImage,
        position: Array,
        axes: Array,
        *,
        by_appearance: bool,
        cut: Sequence[Observation] = (),
    ) -> None:
        """Update tracks, and count a miss for those that should be visible."""
        updated = self._tracker.observe(observations)
        updated += self._tracker.observe(
            cut, may_start=False, walked_only=self._people
        )
        ahead = atan2(axes[1, 0], axes[0, 0])
        half = 0.85 * abs(angle_of(image, 0.0))
        x, y = float(position[0]), float(position[1])
        for track in self._tracker.tracks:
            is_old = image.time - track.identified_at > MAX_GAZE_AGE
            if track in updated or (by_appearance and is_old):
                continue
            if self.floor is not None and isinstance(image, DepthImage):
                # Too near for the depth camera.
                if (
                    track.distance_from(x, y, image.time)
                    < image.near + NEAR_MARGIN
                ):
                    continue
            offset = wrap_angle(track.bearing_from(x, y, image.time) - ahead)
            if abs(offset) < half:
                track.record_frame(False)
