"""Initial poses of the players of a duel."""

from dataclasses import replace
from math import atan2, hypot, pi, radians

from ..arena import check_initial_poses, draw_initial_poses
from ..core.errors import ConfigurationError
from ..core.poses import Pose, wrap_angle
from ..core.random_streams import named_generator
from .duel_settings import DuelSettings, StartSettings

SLOW_SPEED = 0.15  # speed up to which a person begins nearby, in [m/s]
LEAD_TIME = 5.0  # extra distance of a faster person over its speed, in [s]
SAME = 1e-6  # tolerance within which starts are equal, in [m] and [rad]


def draw_start(settings: DuelSettings) -> StartSettings:
    """Draw the omitted values of a start from the seed."""
    generator = named_generator(settings.seed, "start")
    distance = generator.uniform(settings.start.near, settings.start.far)
    if settings.pursuer == "person":
        distance += 1.5  # whole strides away
        # A faster person begins farther away, to be detected in time.
        distance += LEAD_TIME * max(0.0, settings.person.speed - SLOW_SPEED)
    pursuer = generator.uniform(-pi / 2, pi / 2)
    evader = generator.uniform(-radians(30.0), radians(30.0))
    start = settings.start
    return StartSettings(
        distance if start.distance is None else start.distance,
        pursuer if start.pursuer_offset is None else start.pursuer_offset,
        evader if start.evader_offset is None else start.evader_offset,
        start.least,
        start.near,
        start.far,
    )


def with_initial_poses(settings: DuelSettings) -> DuelSettings:
    """Return the settings of the same duel with nothing left open.

    Its start is filled in, and what the settings imply.

    Raises:
        ConfigurationError: If a room has no space for the start, or settings
            and room give different starts.
    """
    settings = settings.resolved()
    plan = settings.room.plan
    if plan is None:
        return replace(settings, start=draw_start(settings))
    starts = plan.starts or draw_initial_poses(plan, settings.seed)
    check_initial_poses(plan, starts)
    plan = replace(plan, starts=starts)
    return replace(
        settings,
        start=_agreeing(settings.start, start_of(starts)),
        room=replace(settings.room, plan=plan),
    )


def start_of(starts: tuple[Pose, Pose]) -> StartSettings:
    """Return the start settings of poses of both players in the world."""
    (x, y, pursuer), (u, v, evader) = starts
    line_of_sight = atan2(v - y, u - x)
    return StartSettings(
        hypot(u - x, v - y),
        wrap_angle(pursuer - line_of_sight),
        wrap_angle(evader - line_of_sight - pi),
    )


def initial_poses(settings: DuelSettings) -> tuple[Pose, Pose]:
    """Return the initial poses of pursuer and evader in the world."""
    plan, start = settings.room.plan, settings.start
    if plan is not None and plan.starts is not None:
        return plan.starts
    assert start.distance is not None
    assert start.pursuer_offset is not None
    assert start.evader_offset is not None
    return (
        Pose(0.0, 0.0, start.pursuer_offset),
        Pose(start.distance, 0.0, pi + start.evader_offset),
    )


def _agreeing(given: StartSettings, drawn: StartSettings) -> StartSettings:
    """Return the start of a room; reject a different one in the settings.

    Distances between which starts are drawn stay those of the robots.
    """
    found = {}
    for name in ("distance", "pursuer_offset", "evader_offset"):
        value, found[name] = getattr(given, name), getattr(drawn, name)
        if value is not None and not abs(value - found[name]) < SAME:
            raise ConfigurationError(
                f"start.{name} must be omitted in a room, which gives "
                f"the initial poses, got {value:g}"
            )
    return replace(given, **found)
