"""Where the players stand at first."""

from dataclasses import fields, replace
from math import atan2, hypot, pi, radians

from ..arena import check_starts, draw_starts
from ..core.errors import ConfigurationError
from ..core.poses import Pose, wrap_angle
from ..core.random_streams import named_generator
from .duel_settings import DuelSettings, StartSettings

LEISURELY = 0.15  # speed up to which a person begins near by, in [m/s]
AHEAD = 5.0  # time by which a faster one begins earlier, in [s]
INSIDE = 1.0  # of the walls that are asked for everybody begins, in [m]
APART = 3.5  # from a start to walls that stand elsewhere for it, in [m]
SAME = 1e-6  # starts that differ less are one, in [m] and [rad]


def draw_start(settings: DuelSettings) -> StartSettings:
    """Fill in what a start leaves out, from the seed."""
    generator = named_generator(settings.seed, "start")
    distance = generator.uniform(settings.start.near, settings.start.far)
    if settings.pursuer == "person":
        distance += 1.5  # whole strides away
        # Who walks faster comes from farther, so as to be seen coming.
        distance += AHEAD * max(0.0, settings.person.speed - LEISURELY)
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


def with_start(settings: DuelSettings) -> DuelSettings:
    """Settings of the same duel with its start filled in.

    Raises:
        ConfigurationError: If a room has no place for the start.
    """
    plan = settings.room.plan
    if plan is None:
        return replace(settings, start=draw_start(settings))
    starts = plan.starts or draw_starts(plan, settings.seed)
    check_starts(plan, starts)
    plan = replace(plan, starts=starts)
    return replace(
        settings,
        start=_agreeing(settings.start, start_of(starts)),
        room=replace(settings.room, plan=plan),
    )


def start_of(starts: tuple[Pose, Pose]) -> StartSettings:
    """How two players who stand somewhere stand to each other."""
    (x, y, pursuer), (u, v, evader) = starts
    sight = atan2(v - y, u - x)
    return StartSettings(
        hypot(u - x, v - y),
        wrap_angle(pursuer - sight),
        wrap_angle(evader - sight - pi),
    )


def frames_of(settings: DuelSettings) -> tuple[Pose, Pose]:
    """Where pursuer and evader stand at first, in the world.

    Args:
        settings: With the start filled in.
    """
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


def walls_of(settings: DuelSettings) -> float:
    """Distance of the walls from the middle, in [m]; 0 for none.

    Whoever begins beyond them would come through one, unseen until then: so
    where a start is not well inside they stand beyond what a depth camera
    sees from it.

    Args:
        settings: Of the duel, with the start filled in.
    """
    walls = settings.room.walls
    reach = max(abs(c) for frame in frames_of(settings) for c in frame[:2])
    if not walls or reach + INSIDE <= walls:
        return walls
    return reach + APART


def _agreeing(asked: StartSettings, drawn: StartSettings) -> StartSettings:
    """The start of a room, unless another one was asked for."""
    for field in fields(StartSettings):
        wanted, there = getattr(asked, field.name), getattr(drawn, field.name)
        if wanted is not None and not abs(wanted - there) < SAME:
            raise ConfigurationError(
                f"start.{field.name} must be left out in a room, which says "
                f"where the players stand, got {wanted:g}"
            )
    return drawn
