"""From an echo to a place in odometry."""

from math import atan2, cos, radians, sin

from ..core.poses import wrap_angle
from ..robots.body_pose import BodyPose
from ..robots.head import Mount
from .floor_map import FloorMap
from .images import SonarEcho
from .track import Observation, TargetTrack

FRESH = 0.25  # age at which a distance is worth hearing again, in [s]
CHEST = 0.10  # from a sonar to the own axis and into the other, in [m]
DEAF = 0.25  # echo that may be of the own arms, or of anything nearer, [m]
STRANGE = 0.6  # echo of somebody unknown, at most, in [m]
EAR = radians(50.0)  # how far aside a sonar hears
ROOMY = 0.25  # by which what an echo comes from must be nearer, in [m]


def is_heard(echo: SonarEcho) -> bool:
    """Whether an echo is of anything but the own arms."""
    return echo.distance is not None and echo.distance >= DEAF


def observe_echo(
    echo: SonarEcho,
    mount: Mount,
    body: BodyPose,
    track: TargetTrack | None,
    floor: FloorMap | None,
    now: float,
) -> Observation | None:
    """Turn an echo into an observation of who counts, or of somebody new.

    Args:
        echo: One that is heard.
        mount: Of the sonar on the torso.
        body: Where the body was.
        track: Who counts, if anybody does.
        floor: Map of the floor, if one is kept.
        now: Time, in [s].

    Returns:
        What it tells; None if that is nothing.
    """
    assert echo.distance is not None
    x, y, heading = body.torso
    axis = body.torso_axes @ mount.axes[:, 0]
    facing = atan2(axis[1], axis[0])
    away = echo.distance + CHEST
    if floor is not None:
        known = floor.nearest(x, y, facing, EAR)
        if track is None or known < away + ROOMY:
            return None  # it may be an echo of the room
    if track is None:
        if echo.distance > STRANGE:
            return None
        bearing, across = facing, 0.25
    else:
        bearing, across = track.turned_to(x, y, now), 0.4
        if now - track.ranged_at < FRESH:
            return None
        if abs(wrap_angle(bearing - facing)) > EAR - abs(
            wrap_angle(facing - heading)
        ):
            return None
    return Observation(
        echo.time,
        x + away * cos(bearing),
        y + away * sin(bearing),
        bearing,
        0.06,
        across,
        False,
        True,
    )
