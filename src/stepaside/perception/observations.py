"""From what an image shows to a place in odometry, as sure as it is."""

from collections.abc import Sequence
from math import atan2, cos, hypot, radians, sin

from ..core.poses import Array, wrap_angle
from ..robots.body_pose import BodyPose
from ..robots.head import Mount
from .colour_detector import Appearance, ColourDetection
from .depth_detector import DetectedObstacle, Shadow
from .floor_map import FloorMap
from .images import ColourImage, DepthImage
from .ranging import BREADTH, range_of_breadth, range_of_trim
from .track import Observation, TargetTrack

SURE = 0.8  # confidence from which the size of the trim tells distance
GUESS = 1.2  # distance of a thing whose distance is unknown, in [m]
CLOSEST = 0.35  # distance below which no other can be, in [m]
ROUGH = 0.35  # share by which a distance told by breadth is off
VAGUE = 0.6  # deviation of a distance that is only remembered, in [m]
NEARBY = 0.15  # beyond the near limit, of what casts a shadow, in [m]
BESIDE = 0.45  # distance of what casts one, at least, in [m]
BLIND = 3.0  # deviation of a distance that nothing tells, in [m]
PULLED = 0.15  # of the bounds of a shadow, which the memory overran, in [m]
BODY = 0.35  # from the middle of somebody to a part of it, in [m]
AXIS = 0.03  # from the middle of what is seen of trim to the axis, in [m]
PARTLY = 0.15  # of the axis of whom only a part was measured, in [m]


def observe_trim(
    image: ColourImage,
    found: ColourDetection,
    place: Array,
    axes: Array,
    appearance: Appearance,
    tracks: Sequence[TargetTrack],
    *,
    near: bool = False,
) -> Observation:
    """Turn trim in an image into a place in odometry.

    Its size tells the distance when all of it is in view, its breadth
    roughly when it is too near for that, and else memory.

    Args:
        image: The image.
        found: The trim in it.
        place: Place of the camera in odometry, in [m]. Shape (3,).
        axes: Its axes as columns. Shape (3, 3).
        appearance: Whose trim it is.
        tracks: What is followed already.
        near: Whether it may be so near that an edge hides a part of it, of
            which no trim tells; then its middle is not its axis either, and
            to believe that would be to take sway for a change of distance.
    """
    camera = image.camera
    middle = 0.5 * (found.top + found.bottom)
    x, y, _ = (axes @ camera.ray(found.column, middle)).tolist()
    bearing = atan2(y, x)
    hidden = 0.0
    if near:
        hidden = _hidden(
            image, found, _remembered(tracks, image.time, bearing, place)
        )
        bearing = wrap_angle(bearing - 0.5 * hidden)
    away = None
    whole = not (found.cut_above or found.cut_below)
    if whole and found.confidence >= SURE:
        away = range_of_trim(
            axes @ camera.ray(found.column, found.top),
            axes @ camera.ray(found.column, found.bottom),
            float(place[2]),
            appearance,
        )
    ranged = away is not None
    along = VAGUE
    if away is not None:
        along = 0.02 + 0.05 * away
    elif not (found.cut_aside or hidden) and found.cut_below:
        away = range_of_breadth(
            angle_of(image, found.right) - angle_of(image, found.left)
        )
        along = ROUGH * away
    else:
        away = _remembered(tracks, image.time, bearing, place)
        if away <= CLOSEST:
            along = 0.1
    aside = 0.005 if not found.cut_aside else 0.06
    across = 0.003 + max(aside, 0.5 * abs(hidden)) * away
    return Observation(
        image.time,
        float(place[0] + away * cos(bearing)),
        float(place[1] + away * sin(bearing)),
        bearing,
        along,
        max(across, AXIS) if near else across,
        True,
        ranged,
    )


def _hidden(image: ColourImage, found: ColourDetection, away: float) -> float:
    """Angle of the trim beyond an edge, in [rad], positive rightward.

    Args:
        image: The image.
        found: The trim in it.
        away: Distance of who wears it, in [m].
    """
    left, right = angle_of(image, found.left), angle_of(image, found.right)
    missing = max(0.0, BREADTH / away - (right - left))
    edge = -angle_of(image, 0.0)
    beyond_left, beyond_right = edge + left < missing, edge - right < missing
    return missing * (float(beyond_right) - float(beyond_left))


def observe_obstacle(
    image: DepthImage, thing: DetectedObstacle
) -> Observation:
    """Turn an obstacle into an observation; its side may be cut."""
    aside = 0.03 if thing.whole else 0.12
    return Observation(
        image.time,
        thing.x,
        thing.y,
        thing.bearing,
        0.03,
        aside,
        False,
        True,
        thing.height,
    )


def observe_obstacles(
    image: DepthImage,
    things: Sequence[DetectedObstacle],
    floor: FloorMap | None,
    other: tuple[float, float] | None = None,
) -> tuple[list[Observation], list[Observation]]:
    """Turn obstacles into observations.

    What the edge cuts may be a piece of a wall: it founds nobody. In a room
    that is mapped nothing does but trim, and what is on the map, or not
    where the other is, is nobody.

    Args:
        image: The image.
        things: Obstacles in it.
        floor: Map of the floor, if one is kept.
        other: Where the other is taken to be, in odometry, in [m].

    Returns:
        Those that may found a track, and those that may not.
    """
    if floor is not None:
        things = [
            t
            for t in things
            if not floor.holds(t.x, t.y)
            and other is not None
            and hypot(t.x - other[0], t.y - other[1]) < BODY
        ]
    whole, cut = (
        [
            observe_obstacle(image, thing)
            for thing in things
            if (thing.whole and floor is None) is founds
        ]
        for founds in (True, False)
    )
    return whole, cut


def observe_shadow(
    image: DepthImage,
    shadow: Shadow,
    place: Array,
    tracks: Sequence[TargetTrack],
) -> Observation:
    """Place by its bearing what is too near for its distance.

    It stands between the nearest that anybody can be and the near limit,
    unless a part of it was measured; within that nothing but its bearing is
    known, and the distance of memory is handed back without any weight.

    Args:
        image: The image.
        shadow: The shadow in it.
        place: Place of the camera in odometry, in [m]. Shape (3,).
        tracks: What is followed already.
    """
    far = image.near + NEARBY
    memory = _remembered(tracks, image.time, shadow.bearing, place)
    ranged = shadow.nearest is not None
    if shadow.nearest is not None:
        away, along = shadow.nearest, PARTLY
    else:
        away = min(max(memory, BESIDE), far)
        along = BLIND if away == memory else PULLED
    return Observation(
        image.time,
        float(place[0] + away * cos(shadow.bearing)),
        float(place[1] + away * sin(shadow.bearing)),
        shadow.bearing,
        along,
        0.08 * away,
        False,
        ranged,
    )


def camera_of(body: BodyPose, mount: Mount) -> tuple[Array, Array]:
    """Place and axes of a camera on the head, in odometry.

    Returns:
        Place, in [m], shape (3,), and axes as columns, shape (3, 3).
    """
    place = body.head_place + body.head_axes @ mount.place
    return place, body.head_axes @ mount.axes


def angle_of(image: ColourImage | DepthImage, column: float) -> float:
    """Angle of a column from the middle, in [rad], positive rightward."""
    camera = image.camera
    return atan2(column - 0.5 * camera.width, camera.focal_x)


def _remembered(
    tracks: Sequence[TargetTrack], time: float, bearing: float, place: Array
) -> float:
    """Distance of what was seen in a direction, from a place, in [m]."""
    x, y = float(place[0]), float(place[1])
    for track in tracks:
        off = wrap_angle(track.turned_to(x, y, time) - bearing)
        if abs(off) < radians(20.0):
            return max(track.away_from(x, y, time), CLOSEST)
    return GUESS
