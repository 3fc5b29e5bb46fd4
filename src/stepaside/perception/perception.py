"""From percepts to a line of sight, and from it to where the head looks."""

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
from .sonar import is_heard, observe_echo
from .target_selection import UNSEEN, RobotSelection, TargetSelection
from .track import ANYBODY, WALKER, Observation, TargetTrack
from .tracker import Tracker

MEMORY = 1.0  # how long past poses are kept, in [s]
SURE = 0.5  # age up to which the other is known to be where it is, in [s]
EDGE = 0.1  # beyond the near limit, where somebody is measured in part, in [m]
BROAD = 0.12  # shadow of somebody who was not seen before, in [rad]


class Perception:
    """Sees the other, follows it in odometry and keeps looking at it.

    Attributes:
        body: Where the body is by its own measurements; None before the
            first.
        sighting: The other as it is believed to be now; None if lost.
        searching: Whether it is lost and looked for.
        reports: What the images that arrived at the last tick show.
        forward: Kinematics of the measured body, for balance to share.
        floor: Map of the floor, if it keeps one.
        around: Its look around, before a game begins.
        started: Whether the game has begun; a robot that maps the floor
            keeps scanning before.
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
        """Know the own body and what the other looks like.

        Args:
            description: The robot.
            head: Its head.
            appearance: The other's look, if it is the one that is known.
            tick: Control period, in [s].
            floor: Map of the floor to keep; who keeps one looks around first.
            glances: Time between two looks over its shoulders, to see the
                floor that it walks backward onto, in [s]; None for none.
            people: Whether people come, who wear no trim.
            awaits_start: Whether a signal starts the game; otherwise it
                begins with the end of the scan.
        """
        self._attention: TargetSelection = (
            PeopleSelection() if people else RobotSelection()
        )
        self._people = people
        self.floor = floor
        self.around = RoomScan()
        self.started = not awaits_start
        self._lower = BottomCamera(head.bottom, people=people, floor=floor)
        self._glances = None if glances is None else Glances(tick, glances)
        self._head = head
        self.forward = ForwardKinematics(description, head.body)
        self._kinematics = BodyKinematics(description, head, self.forward)
        self._detector = ColourDetector(appearance)
        self._gaze = Gaze(head.coupling, tick)
        self._calm = floor is not None and not people
        self._tracker = Tracker(WALKER if self._calm else ANYBODY)
        self._poses: deque[BodyPose] = deque(maxlen=round(MEMORY / tick))
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
        """Take in what the sensors give at one tick.

        Args:
            measurement: What they give.
            support: Pose of the standing foot in odometry.
            left_supports: Whether that is the left one.
            tilt: Roll and pitch of the torso, in [rad].

        Returns:
            Where the other is now, as far as is known.
        """
        now, joints = measurement.time, measurement.joint_positions
        body = self._kinematics.pose(now, joints, support, left_supports, tilt)
        return self._see(measurement, body)

    @property
    def head_joints(self) -> tuple[int, int]:
        """Numbers of the joints that turn the head: yaw and pitch."""
        return self._kinematics.yaw, self._kinematics.pitch

    @property
    def gaze(self) -> tuple[float, float]:
        """Yaw and pitch to which the head is to turn, in [rad]."""
        return self._gaze.yaw, self._gaze.pitch

    @property
    def is_ready(self) -> bool:
        """Whether the scan of the room, if any, is complete."""
        return self.floor is None or not self.around.lasts(self._gaze)

    @property
    def looking(self) -> bool:
        """Whether it looks around, before it says anything of the other."""
        waits = self.floor is not None and not self.started
        return waits or not self.is_ready

    def looks_low(self) -> bool:
        """Whether the lower camera of the head is asked for an image."""
        if self.body is None:
            return False
        now, (x, y, _) = self.body.time, self.body.torso
        main = self._attention.main(self._tracker, now, x, y)
        # Who has lost the other needs all images of the upper one.
        lost = self.sighting is None and not self.looking
        return self._lower.wanted(self.body, main, lost=lost)

    def _see(
        self, measurement: Measurement, body: BodyPose
    ) -> Sighting | None:
        now = measurement.time
        self.body = body
        self._poses.append(body)
        self.reports.clear()
        for percept in measurement.percepts:
            self._take(percept, self._pose_at(percept.time), now)
        track = self._attention.main(self._tracker, now, *body.torso[:2])
        self.sighting = None
        if self.looking:
            self.around.look(self._gaze, now, body.torso.theta)
            return None
        self._look(now, body, track)
        if track is not None:
            x, y, heading = body.torso
            bearing = wrap_angle(track.turned_to(x, y, now) - heading)
            away = track.away_from(x, y, now)
            who = track.number if self._people else 0
            settled = self._attention.settled(track, now, x, y)
            spread = track.deviation_at(now)
            self.sighting = Sighting(now, bearing, away, who, settled, spread)
        return self.sighting

    def aim(self, joint_targets: Array) -> None:
        """Write where the head turns into joint targets, in [rad]."""
        joint_targets[self._kinematics.yaw] = self._gaze.yaw
        joint_targets[self._kinematics.pitch] = self._gaze.pitch

    def _look(
        self, now: float, body: BodyPose, track: TargetTrack | None
    ) -> None:
        """Look at what counts, at what may come to count, or about."""
        x, y, heading = body.torso
        tracks = self._tracker.tracks
        chosen = self._attention.look(tracks, track, now, x, y)
        self.searching = chosen is None
        if chosen is None:
            self._gaze.search()
            return
        distance = chosen.away_from(x, y, now)
        bearing = chosen.turned_to(x, y, now) - heading
        if self._glances is not None:
            bearing = self._glances.turned(bearing, distance)
        self._gaze.follow(bearing, distance, chosen.height)

    def _pose_at(self, time: float) -> BodyPose:
        known = (p for p in reversed(self._poses) if p.time <= time + 1e-9)
        return next(known, self._poses[0])

    def _take(self, percept: Percept, body: BodyPose, now: float) -> None:
        if isinstance(percept, ColourImage):
            self._take_colour(percept, body, now)
        elif isinstance(percept, DepthImage):
            self._take_depth(percept, body, now)
        else:
            self._hear(percept, body, now)

    def _take_colour(
        self, image: ColourImage, body: BodyPose, now: float
    ) -> None:
        if image.low:
            self._take_low(image, body)
            return
        place, axes = camera_of(body, self._head.top)
        own, other = body.torso[:2], None
        if self.floor is not None:
            other = self._attention.main(self._tracker, now, *own)
        tracks = self._tracker.tracks
        self._lower.learn(image, place, axes, own, tracks, other)
        found = self._detector.detect(image)
        azimuths: tuple[float, ...] = ()
        seen: list[Observation] = []
        if found is not None:
            azimuths = (-angle_of(image, found.column),)
            view = image, found, place, axes, self._detector.appearance
            seen = [observe_trim(*view, tracks, near=self._calm)]
        self.reports.append(FrameReport(image, azimuths, colour=found))
        self._observe(seen, image, place, axes, named=True)

    def _take_low(self, image: ColourImage, body: BodyPose) -> None:
        seen, report = self._lower.see(image, body)
        self.reports.append(report)
        self._tracker.observe(seen, founds=False, walkers=True)

    def _take_depth(
        self, image: DepthImage, body: BodyPose, now: float
    ) -> None:
        place, axes = camera_of(body, self._head.depth)
        own = body.torso[:2]
        scene = detect_obstacles(image, place, axes, own)
        azimuths = tuple(o.azimuth for o in scene.obstacles)
        azimuths += tuple(s.azimuth for s in scene.shadows)
        self.reports.append(FrameReport(image, azimuths, depth=scene))
        there = None
        if self.floor is not None:
            other = self._attention.main(self._tracker, now, *own)
            there = None if other is None else other.place_at(image.time)
            sure = other is not None and now - other.seen_at < SURE
            self.floor.take(image, place, axes, own, there if sure else None)
        whole, cut = observe_obstacles(
            image, scene.obstacles, self.floor, there
        )
        self._observe(whole, image, place, axes, named=False, cut=cut)
        for shadow in scene.shadows if self.floor is None else ():
            tracks = self._tracker.tracks
            # Something that came so near unseen is somebody too.
            founds = shadow.width > BROAD and not any(
                track.confirmed for track in tracks
            )
            near = observe_shadow(image, shadow, place, tracks)
            # What the edge cuts may be a wall: of people it tells only of
            # those who were seen to come.
            wall = self._people and not shadow.whole
            self._tracker.observe(
                [near], founds=founds and not wall, walkers=wall
            )

    def _hear(self, echo: SonarEcho, body: BodyPose, now: float) -> None:
        """Hear how far away is what no camera measures any more."""
        if not is_heard(echo):
            return
        track = self._attention.main(self._tracker, now, *body.torso[:2])
        mount = self._head.sonars[echo.sonar]
        heard = observe_echo(echo, mount, body, track, self.floor, now)
        if heard is not None:
            self._tracker.observe([heard], founds=track is None)

    def _observe(
        self,
        seen: list[Observation],
        image: ColourImage | DepthImage,
        place: Array,
        axes: Array,
        *,
        named: bool,
        cut: Sequence[Observation] = (),
    ) -> None:
        """Update tracks, and count those that a frame should have shown."""
        updated = self._tracker.observe(seen)
        updated += self._tracker.observe(
            cut, founds=False, walkers=self._people
        )
        ahead = atan2(axes[1, 0], axes[0, 0])
        half = 0.85 * abs(angle_of(image, 0.0))
        x, y = float(place[0]), float(place[1])
        for track in self._tracker.tracks:
            late = image.time - track.identified_at > UNSEEN
            if track in updated or (named and late):
                continue
            if self.floor is not None and isinstance(image, DepthImage):
                # What is so near it does not measure.
                if track.away_from(x, y, image.time) < image.near + EDGE:
                    continue
            off = wrap_angle(track.turned_to(x, y, image.time) - ahead)
            if abs(off) < half:
                track.count(False)
