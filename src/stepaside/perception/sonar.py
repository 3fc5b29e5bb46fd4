"""Observations in odometry from sonar echoes."""

from math import atan2, cos, radians, sin

from ..core.poses import wrap_angle
from ..robots.body_pose import BodyPose
from ..robots.head import Mount
from .floor_map import FloorMap
from .images import SonarEcho
from .track import Observation, TargetTrack

MIN_AGE = 0.25  # of the last measured distance before an echo counts, in [s]
BODY_DEPTH = 0.09  # from the surface of the opponent to its axis, in [m]
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
) -> Observation | None:
    """Return the observation of an opponent from a valid echo, or None."""
    assert echo.distance is not None
    x, y, heading = body.pose_torso_in_odometry
    facing = _facing(mount, body)
    distance = _between_axes(echo.distance, mount)
    if track is None:
        if echo.distance > MAX_NEW:
            return None
        bearing, across = facing, 0.25
    else:
        bearing, across = track.bearing_from(x, y, echo.time), 0.4
        if echo.time - track.ranged_at < MIN_AGE:
            return None
        aside = abs(wrap_angle(facing - heading))
        if abs(wrap_angle(bearing - facing)) > HALF_CONE - aside:
            return None
    place = x + distance * cos(bearing), y + distance * sin(bearing)
    return Observation(echo.time, *place, bearing, 0.06, across, False, True)


def may_be_mapped(
    echo: SonarEcho, mount: Mount, body: BodyPose, floor: FloorMap
) -> bool:
    """Return whether a valid echo may be of an obstacle on the map."""
    assert echo.distance is not None
    x, y, _ = body.pose_torso_in_odometry
    facing = _facing(mount, body)
    mapped = floor.distance_in_cone(x, y, facing, HALF_CONE)
    return mapped < _between_axes(echo.distance, mount) + MAP_MARGIN


def _between_axes(distance: float, mount: Mount) -> float:
    """Return the distance from the own axis to that of the opponent."""
    ahead = float(mount.position_in_body @ mount.axes_in_body[:, 0])
    return ahead + distance + BODY_DEPTH


def _facing(mount: Mount, body: BodyPose) -> float:
    """Return the direction of a sonar in odometry, in [rad]."""
    axis = body.axes_torso_in_odometry @ mount.axes_in_body[:, 0]
    return atan2(axis[1], axis[0])
