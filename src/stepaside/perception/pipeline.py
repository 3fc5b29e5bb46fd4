"""Perception: from images to sightings and motion of the head.

Each image is evaluated with the pose of the body at its exposure: detections
become observations, and these update tracks and map. Then the opponent is
selected among the tracks. This happens when an image arrives, or an update
period ends; at other ticks only the head moves.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

from ..core.history import History
from ..core.poses import Array, Pose, Sector, wrap_angle
from ..robots.description import RobotDescription
from ..robots.head import HeadDescription, Mount
from ..robots.robot_tree import NAO_SIZE, BodySize
from .body_pose import BodyKinematics, BodyPose, camera_pose
from .camera_model import CameraPose
from .colour_detector import ColourDetection, ColourDetector
from .depth_detector import DepthScene, detect_obstacles
from .floor_map import FloorMap
from .gaze import GazeTarget, Glances, HeadControl, RoomScan
from .images import (
    AnyPercept,
    ColourImage,
    DepthImage,
    LidarScan,
)
from .measurement import RobotState, Sighting
from .observations import (
    angle_of,
    is_opponent,
    observe_obstacle,
    observe_shadow,
    observe_trim,
)
from .target_selection import (
    MAX_GAZE_AGE,
    PeopleSelection,
    TargetSelection,
)
from .track import (
    PERSON_MOTION,
    ROBOT_MOTION,
    Observation,
    TargetTrack,
    Tracker,
)

POSE_MEMORY = 1.0  # how long past poses are stored, in [s]
MAX_AGE = 0.5  # of the opponent's position when the map is updated, in [s]
NEAR_MARGIN = 0.1  # beyond the near limit: measured in part only, in [m]
MIN_SHADOW = 0.12  # width of a shadow that starts a track, in [rad]
TRIM_TIP = 0.0105  # lowest part of trim, too narrow to be seen, in [m]
USABLE_VIEW = 0.85  # fraction of the half view in which a track must appear
# Longest time between updates when no image arrives, so that tracks
# age and the head searches, in [s].
UPDATE_PERIOD = 0.1


@dataclass(frozen=True, slots=True, eq=False)
class FrameReport:
    """Detections in one image."""

    image: ColourImage | DepthImage
    # directions of the detections from the camera axis [rad], positive
    # leftward
    azimuths: tuple[float, ...]
    # detection in a colour image, if any; that of the tallest
    colour: ColourDetection | None = None
    depth: DepthScene | None = None  # obstacles and shadows in a depth image

    @property
    def camera(self) -> str:
        """Name of the camera: ``colour``, ``depth``, ``depth 1`` and on."""
        if isinstance(self.image, ColourImage):
            return "colour"
        number = self.image.number
        return f"depth {number}" if number else "depth"


@dataclass(slots=True, eq=False)
class Perception:
    """Perception of one robot: its parts, and what it knows."""

    detector: ColourDetector  # detector of the opponent in colour images
    selection: TargetSelection  # selection of the opponent among the tracks
    head: HeadControl
    top: Mount  # mount of the colour camera
    depth: Sequence[Mount]  # mounts of the depth cameras, by number
    size: BodySize = NAO_SIZE
    # kinematics of the body; None for a robot that gives the poses of its
    # camera
    kinematics: BodyKinematics | None = None
    # map of the floor; None on an open floor, where every object may be an
    # opponent
    floor: FloorMap | None = None
    people: bool = False  # whether people may approach
    # bearings that cameras on the torso show
    fixed_views: tuple[Sector, ...] = ()
    # functions that give the pose of the body, of the last second
    poses: History[Callable[[], BodyPose]] = field(
        default_factory=lambda: History(POSE_MEMORY)
    )
    # estimate of the opponent at the last update; None if lost
    sighting: Sighting | None = None
    # target of the gaze; None while the head searches
    gaze_target: GazeTarget | None = None
    # detections in the images that arrived at the last tick
    reports: list[FrameReport] = field(default_factory=list)
    _next_update: float = 0.0
    _heading: float = 0.0
    _watched: bool = False

    @property
    def tracker(self) -> Tracker:
        """Tracks of all objects."""
        return self.selection.tracker

    @property
    def body(self) -> BodyPose | None:
        """Latest pose of the body; None before the first measurement."""
        pose = self.poses.latest
        return None if pose is None else pose()

    @property
    def views(self) -> tuple[Sector, ...]:
        """Range of the head, and bearings that cameras on the torso show."""
        return (Sector(0.0, self.head.reach), *self.fixed_views)

    @property
    def searching(self) -> bool:
        """Whether the head searches, and no camera on the torso watches."""
        return self.gaze_target is None and not self._watched

    def see(
        self,
        measurement: RobotState,
        pose_support_in_odometry: Pose,
        left_supports: bool,
        tilt: tuple[float, float],
    ) -> Sighting | None:
        """Return the latest sighting of the opponent after a tick, if any."""
        assert self.kinematics is not None
        pose, time = self.kinematics.pose, measurement.time
        foot = pose_support_in_odometry, left_supports
        joints = measurement.joint_positions
        self.poses.note(time, partial(pose, time, joints, *foot, tilt))
        return self._process(time, measurement.percepts)

    def see_from(
        self, body: BodyPose, percepts: Sequence[AnyPercept]
    ) -> Sighting | None:
        """Process the images of a robot whose poses are noted; see `see`."""
        self.note_pose(body)
        return self._process(body.time, percepts)

    def note_pose(self, body: BodyPose) -> None:
        """Store a pose of the body, which may be earlier than the latest."""
        self.poses.note(body.time, lambda: body)

    def aim(self, joint_targets: Array) -> None:
        """Write the targets of the head joints, in [rad], in place."""
        assert self.kinematics is not None
        joint_targets[self.kinematics.yaw] = self.head.yaw
        joint_targets[self.kinematics.pitch] = self.head.pitch

    def _process(
        self, now: float, percepts: Sequence[AnyPercept]
    ) -> Sighting | None:
        self.reports.clear()
        arrived = [p for p in percepts if not isinstance(p, LidarScan)]
        # A person at 1 m/s needs a decision before the next image arrives.
        if arrived or self.people or now >= self._next_update:
            self._next_update = now + UPDATE_PERIOD - 1e-9
            for percept in arrived:
                body = self.poses.at(percept.time)()
                if isinstance(percept, ColourImage):
                    report = _take_colour(percept, body, self)
                else:
                    report = _take_depth(percept, body, self)
                self.reports.append(report)
            self._select(now, self.poses.at(now)())
        self.head.move(now, self._heading, self.gaze_target)
        return self.sighting

    def _select(self, now: float, body: BodyPose) -> None:
        """Select the opponent, and the target of the gaze."""
        pose = body.pose_torso_in_odometry
        x, y, self._heading = pose
        main = self.selection.main(now, x, y)
        self.sighting = self.gaze_target = None
        self._watched = main is not None and main.is_watched(now)
        if self.head.scans:
            return
        chosen = self.selection.look(main, now, x, y)
        if chosen is not None:
            seen = self.selection.sighting(chosen, now, pose)
            u, v, up = camera_pose(body, self.top).position_in_odometry
            away = chosen.distance_from(float(u), float(v), now)
            self.gaze_target = GazeTarget(
                seen.bearing, away, chosen.height, float(up)
            )
        if main is not None:
            self.sighting = self.selection.sighting(main, now, pose)


def _take_colour(
    image: ColourImage, body: BodyPose, state: Perception
) -> FrameReport:
    """Detect the opponent's trim."""
    camera, tracker = camera_pose(body, state.top), state.tracker
    found = state.detector.detect(image)
    updated: list[TargetTrack] = []
    azimuths: tuple[float, ...] = ()
    if found is not None:
        # In a room an image edge may hide a part of a robot that is near.
        near = state.floor is not None and not state.people
        appearance, tracks = state.detector.appearance, tracker.tracks
        observation = observe_trim(
            *(image, found, camera, appearance, tracks), near=near
        )
        updated = tracker.observe([observation])
        azimuths = (-angle_of(image, found.column),)
    record_misses(
        tracker, updated, image, camera, max_identity_age=MAX_GAZE_AGE
    )
    return FrameReport(image, azimuths, colour=found)


def _take_depth(
    image: DepthImage, body: BodyPose, state: Perception
) -> FrameReport:
    """Detect obstacles and shadows, on an open or on a mapped floor."""
    mount = state.depth[image.number]
    camera = camera_pose(body, mount)
    scene = detect_obstacles(image, camera, state.size)
    on_floor = _on_open_floor if state.floor is None else _on_mapped_floor
    updated = on_floor(image, scene, camera, state)
    if mount.on_torso:
        for track in updated:
            track.watched_at = image.time
    azimuths = tuple(o.azimuth for o in scene.obstacles)
    azimuths += tuple(s.azimuth for s in scene.shadows)
    return FrameReport(image, azimuths, depth=scene)


def _on_open_floor(
    image: DepthImage, scene: DepthScene, camera: CameraPose, state: Perception
) -> list[TargetTrack]:
    """Update tracks where every object may be an opponent.

    An object that an image edge cuts may be a piece of a wall, and starts no
    track; where people may approach, it updates only tracks that have walked.
    """
    tracker = state.tracker
    parts: dict[bool, list[Observation]] = {True: [], False: []}
    for obstacle in scene.obstacles:
        parts[obstacle.whole].append(observe_obstacle(image, obstacle))
    updated = tracker.observe(parts[True])
    updated += tracker.observe(
        parts[False], may_start=False, walked_only=state.people
    )
    record_misses(tracker, updated, image, camera)
    for shadow in scene.shadows:
        # A wide shadow without any track may be an unnoticed opponent.
        may_start = shadow.width > MIN_SHADOW and not any(
            track.confirmed for track in tracker.tracks
        )
        wall = state.people and not shadow.whole
        updated += tracker.observe(
            [observe_shadow(image, shadow, camera, tracker.tracks)],
            may_start=may_start and not wall,
            walked_only=wall,
        )
    return updated


def _on_mapped_floor(
    image: DepthImage, scene: DepthScene, camera: CameraPose, state: Perception
) -> list[TargetTrack]:
    """Update the map, then the track of the opponent.

    Only trim starts a track. An object updates the track of the opponent if
    it is near its predicted position and not on the map.
    """
    floor, tracker, time = state.floor, state.tracker, image.time
    assert floor is not None
    main = state.selection.main(time, *camera.position_torso_in_odometry)
    opponent = None if main is None else main.position_at(time)
    sure = main is not None and time - main.observed_at < MAX_AGE
    floor.take(image, camera, opponent if sure else None, state.size)
    observations = [
        observe_obstacle(image, obstacle)
        for obstacle in scene.obstacles
        if is_opponent(obstacle, floor, opponent)
    ]
    updated = tracker.observe(
        observations, may_start=False, walked_only=state.people
    )
    blind = image.near + NEAR_MARGIN
    record_misses(tracker, updated, image, camera, blind_distance=blind)
    return updated


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

    The frame shows nothing up to the blind distance [m].
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


def build_perception(
    description: RobotDescription,
    head: HeadDescription,
    detector: ColourDetector,
    *,
    tick: float,
    scan: RoomScan | None = None,
    glances: Glances | None = None,
    people: bool = False,
    fixed_views: tuple[Sector, ...] = (),
) -> Perception:
    """Build the perception of a robot, whose opponents are of its model.

    One that scans the room maps its floor. People wear no trim.
    """
    # Walls and obstacles of a map rest, so a robot's motion may be smooth.
    calm = scan is not None and not people
    motion = ROBOT_MOTION if calm else PERSON_MOTION
    tracker = Tracker(motion)
    selection = (PeopleSelection if people else TargetSelection)(tracker)
    kinematics = BodyKinematics(description, head)
    size = kinematics.forward.tree.size
    low, high = size.trim
    detector.appearance = replace(
        detector.appearance, top=high, bottom=low + TRIM_TIP
    )
    return Perception(
        detector,
        selection,
        HeadControl(
            *(head.pitch_limits, tick, size), glances=glances, scan=scan
        ),
        head.top,
        head.depth_cameras,
        size,
        kinematics,
        None if scan is None else FloorMap(),
        people=people,
        fixed_views=fixed_views,
    )


def build_posed_perception(
    detector: ColourDetector, coupling: Array, *, tick: float
) -> Perception:
    """Build the perception of a robot that gives the poses of its camera."""
    at_head = Mount((0.0, 0.0, 0.0))
    gaze = HeadControl(coupling, tick, NAO_SIZE)
    selection = TargetSelection(Tracker(PERSON_MOTION))
    return Perception(detector, selection, gaze, at_head, [at_head])
