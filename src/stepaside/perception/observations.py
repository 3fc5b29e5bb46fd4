"""Observations in odometry, with covariance, from detections."""

from collections.abc import Sequence
from math import atan2, cos, hypot, radians, sin

from ..core.poses import Array, wrap_angle
from .camera_model import CameraPose
from .colour_detector import Appearance, ColourDetection
from .depth_detector import DetectedObstacle, Shadow
from .floor_map import FloorMap
from .images import ColourImage, DepthImage
from .track import Observation, TargetTrack

TRIM_FORWARD = 0.05  # from the axis to the lower end of the trim, in [m]
TRIM_WIDTH = 0.25  # of trim, seen obliquely, in [m]
# Range of distances from trim, in [m].
TRIM_NEAREST = 0.2
TRIM_FARTHEST = 4.0
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
    camera: CameraPose,
    appearance: Appearance,
    tracks: Sequence[TargetTrack],
    *,
    near: bool = False,
) -> Observation:
    """Return the observation of a robot from its trim in an image.

    The distance follows from the height of the trim when all of it is in
    view, from its lower end if only that is, roughly from its width when the
    robot is too near for that, and from the track otherwise. So near that an
    image edge may hide a part without cutting a patch, the middle of the
    visible trim is not the axis.
    """
    middle = 0.5 * (found.top + found.bottom)
    x, y, _ = camera.ray(image.camera, found.column, middle).tolist()
    bearing = atan2(y, x)
    hidden = 0.0
    if near:
        away = _distance_of_track(tracks, image.time, bearing, camera)
        hidden = _hidden_angle(image, found, away)
        bearing = wrap_angle(bearing - 0.5 * hidden)
    distance = _distance_by_height(image, found, camera, appearance)
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
        distance = _distance_of_track(tracks, image.time, bearing, camera)
        if distance <= MIN_DISTANCE:
            along = 0.1
    if found.cut_below:
        distance = min(
            distance, _distance_by_end(image, found, camera, appearance)
        )
    aside = 0.005 if not found.cut_aside else 0.06
    across = 0.003 + max(aside, 0.5 * abs(hidden)) * distance
    return Observation(
        image.time,
        *_place(camera, bearing, distance),
        bearing,
        along,
        max(across, DEVIATION_AXIS) if near else across,
        identified=True,
        ranged=ranged,
    )


def _distance_by_height(
    image: ColourImage,
    found: ColourDetection,
    camera: CameraPose,
    appearance: Appearance,
) -> float | None:
    """Return the distance by the height of trim; None if a part is hidden."""
    if found.cut_below or found.confidence < MIN_CONFIDENCE:
        return None
    if found.cut_above:
        return _distance_by_end(image, found, camera, appearance)
    return range_of_trim(
        camera.ray(image.camera, found.column, found.top),
        camera.ray(image.camera, found.column, found.bottom),
        float(camera.position_in_odometry[2]),
        appearance,
    )


def _distance_by_end(
    image: ColourImage,
    found: ColourDetection,
    camera: CameraPose,
    appearance: Appearance,
) -> float:
    """Return the distance by the lowest trim in view; at most, if cut."""
    x, y, z = camera.ray(image.camera, found.column, found.bottom).tolist()
    below = float(camera.position_in_odometry[2]) - appearance.bottom
    slope = max(-z / hypot(x, y), below / TRIM_FARTHEST)
    return float(TRIM_FORWARD + below / slope)


def _hidden_angle(
    image: ColourImage, found: ColourDetection, distance: float
) -> float:
    """Return the angle of trim beyond an edge, positive rightward."""
    left, right = angle_of(image, found.left), angle_of(image, found.right)
    missing = max(0.0, TRIM_WIDTH / distance - (right - left))
    edge = -angle_of(image, 0.0)
    beyond_left, beyond_right = edge + left < missing, edge - right < missing
    return missing * (float(beyond_right) - float(beyond_left))


def observe_obstacle(
    image: DepthImage, obstacle: DetectedObstacle
) -> Observation:
    """Return the observation of an obstacle."""
    return Observation(
        image.time,
        *obstacle.position,
        *(obstacle.bearing, 0.03, 0.03 if obstacle.whole else 0.12),
        identified=False,
        ranged=True,
        height=obstacle.height,
    )


def is_opponent(
    obstacle: DetectedObstacle,
    floor: FloorMap,
    position_opponent_in_odometry: tuple[float, float] | None,
) -> bool:
    """Return whether an obstacle may be the opponent, not on the map."""
    if position_opponent_in_odometry is None:
        return False
    (x, y), (u, v) = position_opponent_in_odometry, obstacle.position
    return hypot(u - x, v - y) < BODY_RADIUS and not floor.is_occupied(u, v)


def observe_shadow(
    image: DepthImage,
    shadow: Shadow,
    camera: CameraPose,
    tracks: Sequence[TargetTrack],
) -> Observation:
    """Return the observation of an object too near for a distance.

    Unless a part of it was measured, its distance lies between the smallest
    possible one and the near limit. Only the bearing is measured, so the
    distance of the track is returned with a negligible weight.
    """
    far = image.near + SHADOW_MARGIN
    bearing = camera.heading_in_odometry + shadow.azimuth
    memory = _distance_of_track(tracks, image.time, bearing, camera)
    ranged = shadow.nearest is not None
    if shadow.nearest is not None:
        distance, along = shadow.nearest, DEVIATION_PART
    else:
        distance = min(max(memory, MIN_SHADOW_DISTANCE), far)
        along = DEVIATION_UNKNOWN if distance == memory else DEVIATION_BOUND
    return Observation(
        image.time,
        *_place(camera, bearing, distance),
        *(bearing, along, 0.08 * distance),
        identified=False,
        ranged=ranged,
    )


def _place(
    camera: CameraPose, bearing: float, distance: float
) -> tuple[float, float]:
    """Return the position at a distance from a camera, in [m]."""
    x, y, _ = camera.position_in_odometry.tolist()
    return x + distance * cos(bearing), y + distance * sin(bearing)


def angle_of(image: ColourImage | DepthImage, column: float) -> float:
    """Return the angle of a column from the centre, positive rightward."""
    camera = image.camera
    return atan2(column - 0.5 * camera.width, camera.focal_x)


def _distance_of_track(
    tracks: Sequence[TargetTrack],
    time: float,
    bearing: float,
    camera: CameraPose,
) -> float:
    """Return the distance of the track in a direction, in [m]."""
    x, y = camera.position_in_odometry[:2].tolist()
    for track in tracks:
        off = wrap_angle(track.bearing_from(x, y, time) - bearing)
        if abs(off) < radians(20.0):
            return max(track.distance_from(x, y, time), MIN_DISTANCE)
    return DEFAULT_DISTANCE


def range_of_trim(
    upper: Array, lower: Array, camera_height: float, appearance: Appearance
) -> float | None:
    """Return the distance [m] of a robot from level rays to its trim's ends.

    It follows from the difference of their slopes; the height of the camera
    has little influence. It is None if it is out of range.
    """
    rise = upper[2] / hypot(upper[0], upper[1])
    span = rise - lower[2] / hypot(lower[0], lower[1])
    above, below = (
        appearance.top - camera_height,
        camera_height - appearance.bottom,
    )
    if span <= 0.05:
        return None
    distance = (above + below) / span
    for _ in range(4):
        slope_below = span - above / max(distance, TRIM_NEAREST)
        if slope_below <= 0.0:
            return None
        distance = TRIM_FORWARD + below / slope_below
    return float(distance) if TRIM_NEAREST < distance < TRIM_FARTHEST else None


def range_of_width(angle: float) -> float:
    """Return a rough distance [m] of a robot from the width of its trim.

    Trim is as wide as the shoulders from the front and half as wide from the
    side, so the error is up to a third.
    """
    return min(max(TRIM_WIDTH / max(angle, 1e-3), TRIM_NEAREST), TRIM_FARTHEST)
