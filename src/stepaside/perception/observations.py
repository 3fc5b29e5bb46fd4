"""Observations in odometry, with covariance, from detections."""

from collections.abc import Sequence
from math import atan2, cos, hypot, radians, sin

from ..core.poses import Array, wrap_angle
from ..robots.body_pose import BodyPose
from ..robots.head import Mount
from .colour_detector import Appearance, ColourDetection
from .depth_detector import DetectedObstacle, Shadow
from .floor_map import FloorMap
from .images import ColourImage, DepthImage
from .ranging import WIDTH, range_of_trim, range_of_width
from .track import Observation, TargetTrack

MIN_CONFIDENCE = 0.8  # at which the height of the trim gives the distance
DEFAULT_DISTANCE = 1.2  # without measurement or track, in [m]
MIN_DISTANCE = 0.35  # of an opponent, in [m]
DEVIATION_WIDTH = 0.35  # of a distance from the width, relative
DEVIATION_TRACK = 0.6  # of a distance from the track, in [m]
# Bounds of the distance of a shadow: beyond the near limit of the depth
# camera at most, and from the camera at least, in [m].
SHADOW_MARGIN = 0.15
MIN_SHADOW_DISTANCE = 0.45
DEVIATION_UNKNOWN = 3.0  # of a distance without any measurement, in [m]
DEVIATION_BOUND = 0.15  # of a distance clipped to those bounds, in [m]
BODY_RADIUS = 0.35  # from the axis of a player to a part of it, in [m]
DEVIATION_AXIS = 0.03  # from the middle of visible trim to the axis, in [m]
DEVIATION_PART = 0.15  # of the axis of a partly measured object, in [m]


def observe_trim(
    image: ColourImage,
    found: ColourDetection,
    position_camera_in_odometry: Array,
    axes_camera_in_odometry: Array,
    appearance: Appearance,
    tracks: Sequence[TargetTrack],
    *,
    near: bool = False,
) -> Observation:
    """Return the observation of a robot from its trim in an image.

    The distance follows from the height of the trim when all of it is in
    view, roughly from its width when the robot is too near for that, and
    from the track otherwise.

    Args:
        image: The image.
        found: Detection of the trim.
        position_camera_in_odometry: Position of the camera, in [m].
                Shape (3,).
        axes_camera_in_odometry: Its axes (forward, left, up) as columns.
            Shape (3, 3).
        appearance: Appearance of the robot.
        tracks: All tracks.
        near: Whether it may be so near that an image edge hides a part
            without cutting a patch. The middle of the visible trim is then
            not the axis, and sway would look like a change of distance.
    """
    camera = image.camera
    middle = 0.5 * (found.top + found.bottom)
    x, y, _ = (
        axes_camera_in_odometry @ camera.ray(found.column, middle)
    ).tolist()
    bearing = atan2(y, x)
    hidden = 0.0
    if near:
        hidden = _hidden_angle(
            image,
            found,
            _distance_of_track(
                tracks, image.time, bearing, position_camera_in_odometry
            ),
        )
        bearing = wrap_angle(bearing - 0.5 * hidden)
    distance = None
    whole = not (found.cut_above or found.cut_below)
    if whole and found.confidence >= MIN_CONFIDENCE:
        distance = range_of_trim(
            axes_camera_in_odometry @ camera.ray(found.column, found.top),
            axes_camera_in_odometry @ camera.ray(found.column, found.bottom),
            float(position_camera_in_odometry[2]),
            appearance,
        )
    ranged = distance is not None
    along = DEVIATION_TRACK
    if distance is not None:
        along = 0.02 + 0.05 * distance
    elif not (found.cut_aside or hidden) and found.cut_below:
        distance = range_of_width(
            angle_of(image, found.right) - angle_of(image, found.left)
        )
        along = DEVIATION_WIDTH * distance
    else:
        distance = _distance_of_track(
            tracks, image.time, bearing, position_camera_in_odometry
        )
        if distance <= MIN_DISTANCE:
            along = 0.1
    aside = 0.005 if not found.cut_aside else 0.06
    across = 0.003 + max(aside, 0.5 * abs(hidden)) * distance
    return Observation(
        image.time,
        float(position_camera_in_odometry[0] + distance * cos(bearing)),
        float(position_camera_in_odometry[1] + distance * sin(bearing)),
        bearing,
        along,
        max(across, DEVIATION_AXIS) if near else across,
        True,
        ranged,
    )


def _hidden_angle(
    image: ColourImage, found: ColourDetection, distance: float
) -> float:
    """Return the angle of trim beyond an edge, positive rightward.

    Args:
        image: The image.
        found: Detection of the trim.
        distance: Distance of the robot, in [m].
    """
    left, right = angle_of(image, found.left), angle_of(image, found.right)
    missing = max(0.0, WIDTH / distance - (right - left))
    edge = -angle_of(image, 0.0)
    beyond_left, beyond_right = edge + left < missing, edge - right < missing
    return missing * (float(beyond_right) - float(beyond_left))


def observe_obstacle(
    image: DepthImage, obstacle: DetectedObstacle
) -> Observation:
    """Return the observation of an obstacle."""
    aside = 0.03 if obstacle.whole else 0.12
    return Observation(
        image.time,
        obstacle.x,
        obstacle.y,
        obstacle.bearing,
        0.03,
        aside,
        False,
        True,
        obstacle.height,
    )


def observe_obstacles(
    image: DepthImage,
    obstacles: Sequence[DetectedObstacle],
    floor: FloorMap | None,
    position_opponent_in_odometry: tuple[float, float] | None = None,
) -> tuple[list[Observation], list[Observation]]:
    """Return the observations of obstacles.

    An obstacle that an image edge cuts may be a piece of a wall, and starts
    no track. With a map of the floor only trim starts a track, and obstacles
    are used only if they are near the opponent and not on the map.

    Args:
        image: The image.
        obstacles: Obstacles in it.
        floor: Map of the floor, if there is one.
        position_opponent_in_odometry: Predicted position of the opponent,
            in [m].

    Returns:
        Observations that may start a track, and those that may not.
    """
    if floor is not None:
        obstacles = [
            t
            for t in obstacles
            if not floor.is_occupied(t.x, t.y)
            and position_opponent_in_odometry is not None
            and hypot(
                t.x - position_opponent_in_odometry[0],
                t.y - position_opponent_in_odometry[1],
            )
            < BODY_RADIUS
        ]
    whole, cut = (
        [
            observe_obstacle(image, obstacle)
            for obstacle in obstacles
            if (obstacle.whole and floor is None) is may_start
        ]
        for may_start in (True, False)
    )
    return whole, cut


def observe_shadow(
    image: DepthImage,
    shadow: Shadow,
    position_camera_in_odometry: Array,
    tracks: Sequence[TargetTrack],
) -> Observation:
    """Return the observation of an object too near for a distance.

    Unless a part of it was measured, its distance lies between the smallest
    possible one and the near limit. Only the bearing is measured, so the
    distance of the track is returned with a negligible weight.

    Args:
        image: The image.
        shadow: Shadow in it.
        position_camera_in_odometry: Position of the camera, in [m].
                Shape (3,).
        tracks: All tracks.
    """
    far = image.near + SHADOW_MARGIN
    memory = _distance_of_track(
        tracks, image.time, shadow.bearing, position_camera_in_odometry
    )
    ranged = shadow.nearest is not None
    if shadow.nearest is not None:
        distance, along = shadow.nearest, DEVIATION_PART
    else:
        distance = min(max(memory, MIN_SHADOW_DISTANCE), far)
        along = DEVIATION_UNKNOWN if distance == memory else DEVIATION_BOUND
    return Observation(
        image.time,
        float(position_camera_in_odometry[0] + distance * cos(shadow.bearing)),
        float(position_camera_in_odometry[1] + distance * sin(shadow.bearing)),
        shadow.bearing,
        along,
        0.08 * distance,
        False,
        ranged,
    )


def camera_of(body: BodyPose, mount: Mount) -> tuple[Array, Array]:
    """Return the position and axes of a head camera in odometry.

    Args:
        body: Pose of the body.
        mount: Mount of the camera on the head.

    Returns:
        Position, in [m], shape (3,), and axes as columns, shape (3, 3).
    """
    position_camera_in_odometry = (
        body.head_place + body.head_axes @ mount.place
    )
    return position_camera_in_odometry, body.head_axes @ mount.axes


def angle_of(image: ColourImage | DepthImage, column: float) -> float:
    """Return the angle of a column from the centre, positive rightward."""
    camera = image.camera
    return atan2(column - 0.5 * camera.width, camera.focal_x)


def _distance_of_track(
    tracks: Sequence[TargetTrack],
    time: float,
    bearing: float,
    position_camera_in_odometry: Array,
) -> float:
    """Return the distance of the track in a direction, in [m]."""
    x, y = (
        float(position_camera_in_odometry[0]),
        float(position_camera_in_odometry[1]),
    )
    for track in tracks:
        off = wrap_angle(track.bearing_from(x, y, time) - bearing)
        if abs(off) < radians(20.0):
            return max(track.distance_from(x, y, time), MIN_DISTANCE)
    return DEFAULT_DISTANCE
