"""Construction of a perception from the parts that a game needs."""

from dataclasses import dataclass, field

import numpy as np

from ..core.poses import Array, Sector
from ..robots.body_pose import BodyKinematics
from ..robots.description import RobotDescription
from ..robots.head import HeadDescription, Mount
from .camera_pose import BodyPoseHistory, PoseHistory
from .colour_detector import ColourDetector
from .floor_map import FloorMap
from .gaze import Gaze, Glances, NoGlances
from .head_motion import HeadControl
from .people_selection import PeopleSelection
from .percept_stages import (
    DepthCameraStage,
    DepthUse,
    MappedFloorDepth,
    MappedSonarStage,
    OpenFloorDepth,
    SonarStage,
    TopCameraStage,
)
from .perception import Perception, PerceptStages, PosedPerception
from .room_scan import NoScan, RoomScan
from .target_selection import (
    RobotSelection,
    TargetSelection,
    UnnamedSelection,
)
from .track import PERSON_MOTION, ROBOT_MOTION
from .tracker import Tracker

# Longest time between updates when no image or echo arrives, so that tracks
# age and the head searches, in [s].
UPDATE_PERIOD = 0.1


@dataclass(frozen=True, slots=True, eq=False)
class FloorMapping:
    """Parts of a robot that maps the floor.

    Attributes:
        floor: Map to fill.
        scan: Scan of the room before the game.
        glances: Glances over the shoulders at the floor behind.
        awaits_start: Whether a signal starts the game; otherwise it begins
            with the end of the scan.
    """

    floor: FloorMap = field(default_factory=FloorMap)
    scan: RoomScan | NoScan = field(default_factory=NoScan)
    glances: Glances | NoGlances = field(default_factory=NoGlances)
    awaits_start: bool = False


def build_perception(
    description: RobotDescription,
    head: HeadDescription,
    detector: ColourDetector,
    *,
    tick: float,
    mapping: FloorMapping | None = None,
    people: bool = False,
    unnamed: int = 0,
    fixed_views: tuple[Sector, ...] = (),
) -> Perception:
    """Build the perception of a robot.

    Args:
        description: Description of the robot.
        head: Description of its head.
        detector: Detector of the opponent in colour images.
        tick: Control period, in [s].
        mapping: Parts of a robot that maps the floor; None on an open floor.
        people: Whether people, who wear no trim, may approach.
        unnamed: Number of opponents if there are more robots than one
            opponent, which all wear the trim and are not told apart; else 0.
        fixed_views: Bearings that cameras on the torso show.
    """
    # Walls and obstacles of a map rest, so a robot's motion may be smooth.
    calm = mapping is not None and not people
    tracker = Tracker(
        ROBOT_MOTION if calm or unnamed else PERSON_MOTION,
        several=unnamed > 0,
    )
    selection: TargetSelection = RobotSelection(tracker)
    if people:
        selection = PeopleSelection(tracker)
    elif unnamed:
        selection = UnnamedSelection(tracker, unnamed)
    depth: DepthUse = OpenFloorDepth(tracker, near_walls=people)
    sonar = SonarStage(head.sonars, tracker, selection)
    if mapping is not None:
        floor = mapping.floor
        depth = MappedFloorDepth(tracker, selection, floor, walked_only=people)
        sonar = MappedSonarStage(head.sonars, tracker, selection, floor)
    used = mapping or FloorMapping()
    return Perception(
        BodyPoseHistory(BodyKinematics(description, head), tick),
        PerceptStages(
            TopCameraStage(
                *(head.top, detector, tracker),
                near=calm,
                most=max(1, unnamed),
            ),
            DepthCameraStage(head.depth, depth),
            sonar,
        ),
        tracker,
        selection,
        HeadControl(
            Gaze(head.coupling, tick),
            glances=used.glances,
            scan=used.scan,
            awaits_start=mapping is not None and used.awaits_start,
        ),
        None if mapping is None else mapping.floor,
        # A person at 1 m/s needs a decision before the next image arrives.
        update_period=0.0 if people else UPDATE_PERIOD,
        fixed_views=fixed_views,
    )


def build_posed_perception(
    detector: ColourDetector,
    coupling: Array,
    *,
    camera_height: float,
    tick: float,
) -> PosedPerception:
    """Build the perception of a robot that gives the poses of its camera.

    Args:
        detector: Detector of the opponent in colour images.
        coupling: Rows of yaw, minimum and maximum pitch of the head, in
            [rad]. Shape (3, n).
        camera_height: Height of the camera, in [m].
        tick: Period of the updates, in [s].
    """
    tracker = Tracker(PERSON_MOTION)
    selection = RobotSelection(tracker)
    at_head = Mount(np.zeros(3), np.eye(3))
    return PosedPerception(
        PoseHistory(tick),
        PerceptStages(
            TopCameraStage(at_head, detector, tracker, near=False),
            DepthCameraStage(
                [at_head], OpenFloorDepth(tracker, near_walls=False)
            ),
            SonarStage({}, tracker, selection),
        ),
        tracker,
        selection,
        HeadControl(
            Gaze(coupling, tick, camera_height),
            glances=NoGlances(),
            scan=NoScan(),
        ),
        update_period=UPDATE_PERIOD,
    )
