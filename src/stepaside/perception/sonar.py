"""Observations in odometry from sonar echoes."""

from math import atan2, cos, radians, sin

from ..core.poses import wrap_angle
from ..robots.body_pose import BodyPose
from ..robots.head import Mount
from .floor_map import FloorMap
from .images import SonarEcho
from .track import Observation, TargetTrack

MIN_AGE = 0.25  # of the last measured distance before an echo counts, in [s]
# From the sonar to the own axis plus from the surface of the opponent to its
# axis, in [m].
AXIS_OFFSET = 0.10
MIN_ECHO = 0.25  # shorter echoes may come from the own arms, in [m]
MAX_NEW = 0.6  # longest echo that starts a track, in [m]
HALF_CONE = radians(50.0)  # within which an opponent gives an echo
MAP_MARGIN = 0.25  # from an echo to the nearest obstacle on the map, in [m]


def is_valid_echo(echo: SonarEcho) -> bool:
    """Return whether an echo is not from the own arms."""
    return echo.distance is not None and echo.distance >= MIN_ECHO


def observe_echo(
    echo: SonarEcho,
    mount: Mount,
    body: BodyPose,
    track: TargetTrack | None,
    floor: FloorMap | None,
    now: float,
) -> Observation | None:
    """Return the observation of an opponent from an echo.

    Args:
        echo: Echo that :func:`is_valid_echo` accepts.
        mount: Mount of the sonar on the torso.
        body: Pose of the body at that time.
        track: Main track, if any.
        floor: Map of the floor, if there is one.
        now: Time, in [s].

    Returns:
        The observation; None if the echo is not used.
    """
    assert echo.distance is not None
    x, y, heading = body.torso
    axis = body.torso_axes @ mount.axes[:, 0]
    facing = atan2(axis[1], axis[0])
    distance = echo.distance + AXIS_OFFSET
    if floor is not None:
        distance_mapped = floor.distance_in_cone(x, y, facing, HALF_CONE)
        if track is None or distance_mapped < distance + MAP_MARGIN:
            return None  # it may be an echo of a wall or obstacle
    if track is None:
        if echo.distance > MAX_NEW:
            return None
        bearing, across = facing, 0.25
    else:
        bearing, across = track.bearing_from(x, y, now), 0.4
        if now - track.ranged_at < MIN_AGE:
            return None
        if abs(wrap_angle(bearing - facing)) > HALF_CONE - abs(
            wrap_angle(facing - heading)
        ):
            return None
    return Observation(
        echo.time,
        x + distance * cos(bearing),
        y + distance * sin(bearing),
        bearing,
        0.06,
        across,
        False,
        True,
    )
