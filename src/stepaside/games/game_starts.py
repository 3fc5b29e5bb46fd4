"""Initial poses of the players of a game."""

from collections.abc import Mapping
from math import atan2, cos, hypot, pi, radians, sin

import numpy as np

from ..core.errors import ConfigurationError
from ..core.poses import Pose, wrap_angle
from ..core.random_streams import named_generator
from ..robots.description import load_robot
from ..sim.crowd_motion import RADIUS
from ..sim.person_motion import PersonMotion
from ..sim.person_settings import PATHS
from .floor_games import walk_on_path
from .floor_world import FloorReplay
from .game_settings import GameSettings, PlayerSettings

MOST_DRAWS = 2000  # of one position, before the floor counts as full
WALL_MARGIN = 0.3  # clearance of a start from walls and obstacles, in [m]
ROBOT = 0.4  # least distance of two robots without one of their own, in [m]


def with_starts(settings: GameSettings) -> GameSettings:
    """Return the settings of the same game with nothing left open.

    All starts are filled in, and what the settings imply.
    Positions are drawn from the seed where they are omitted, then headings:
    as in a duel, pursuers look up to a right angle beside their opponent,
    evaders up to 30 degrees beside theirs, people with a goal to the goal,
    others anywhere. A person with a path begins where and as the path does.

    Raises:
        ConfigurationError: If given starts overlap, or there is no space.
    """
    generator = named_generator(settings.seed, "starts")
    poses: dict[str, Pose] = {}
    for player in settings.players:
        given = _given_pose(player)
        if given is not None:
            poses[player.name] = given
    _check_apart(settings, poses)
    drawn = [p for p in settings.players if p.name not in poses]
    for player in drawn:
        x, y = _draw_position(settings, player, poses, generator)
        poses[player.name] = Pose(x, y, 0.0)
    goals = _goals_of(settings, poses)
    for player in drawn:
        x, y, _ = poses[player.name]
        if player.body == "person" and player.name in goals:
            u, v = goals[player.name]
            heading = atan2(v - y, u - x)
        else:
            heading = _draw_heading(settings, player, poses, generator)
        poses[player.name] = Pose(x, y, heading)
    placed = settings.with_places(_wrapped(poses), goals)
    for player in placed.players:
        if player.body == "person" and not player.goal:
            poses[player.name] = walk_on_path(placed, player).pose
    return settings.with_places(_wrapped(poses), goals).resolved()


def _given_pose(player: PlayerSettings) -> Pose | None:
    """Return the initial pose that is not drawn; None if it is."""
    if player.body == "run":
        return FloorReplay(player.run, player.run_player).pose
    own, walks = player.person, not (player.goal or player.draws_goal)
    if player.body == "person" and walks and own.path not in PATHS:
        return PersonMotion(own, Pose(0.0, 0.0, 0.0), (0.0, 0.0)).pose
    return player.pose


def _wrapped(poses: Mapping[str, Pose]) -> dict[str, Pose]:
    """Return the poses with headings in half a turn to either side."""
    return {
        name: Pose(*pose[:2], wrap_angle(pose.theta))
        for name, pose in poses.items()
    }


def _goals_of(
    settings: GameSettings, poses: dict[str, Pose]
) -> dict[str, tuple[float, ...]]:
    """Return the goal of each player that has one, drawn where omitted."""
    generator = named_generator(settings.seed, "goals")
    goals = {p.name: p.goal for p in settings.players if p.goal}
    if settings.room is not None and goals:
        gaps = settings.room.clearance([*goals.values()])
        for name, gap in zip(goals, gaps.tolist(), strict=True):
            _check_free(f"goal of {name}", gap)
    for player in settings.players:
        if player.draws_goal and player.name not in goals:
            goals[player.name] = _draw_goal(
                settings, player, poses[player.name], goals, generator
            )
    return goals


def _draw_goal(
    settings: GameSettings,
    player: PlayerSettings,
    start: Pose,
    goals: Mapping[str, tuple[float, ...]],
    generator: np.random.Generator,
) -> tuple[float, float]:
    """Return a goal away from the start and from other goals, in [m]."""
    room = settings.room
    least = settings.far
    if room is not None and room.width and room.depth:
        least = max(room.width, room.depth) / 3.0
    for _ in range(MOST_DRAWS):
        place = _draw_place(settings, generator)
        if place is None:
            continue
        x, y = place
        if hypot(x - start.x, y - start.y) >= least and all(
            hypot(x - u, y - v)
            >= least_distance(player, settings.player(name))
            for name, (u, v) in goals.items()
        ):
            return x, y
    raise ConfigurationError(
        f"goal of {player.name} must be at least {least:g} [m] from its "
        "start, and there is no such place"
    )


def least_distance(one: PlayerSettings, other: PlayerSettings) -> float:
    """Return the distance at which two bodies cannot overlap, in [m]."""
    return _radius(one) + _radius(other)


def _radius(player: PlayerSettings) -> float:
    """Return the radius within which a body stands, in [m]."""
    if player.body == "person":
        return RADIUS
    if player.body != "robot":
        return 0.0
    least = load_robot(player.robot).game.get("start_least", ROBOT)
    return 0.5 * float(least)


def _check_apart(settings: GameSettings, poses: dict[str, Pose]) -> None:
    """Check that given starts keep clear of each other and of the room."""
    names = list(poses)
    for i, name in enumerate(names):
        for other in names[:i]:
            least = least_distance(
                settings.player(name), settings.player(other)
            )
            (x, y, _), (u, v, _) = poses[name], poses[other]
            away = hypot(u - x, v - y)
            if away < least - 1e-9:
                raise ConfigurationError(
                    f"starts of {other} and {name} must be at least "
                    f"{least:g} [m] apart, or they overlap, got {away:.3g}"
                )
    room = settings.room
    if room is None or not names:
        return
    gaps = room.clearance([poses[name][:2] for name in names])
    for name, gap in zip(names, gaps.tolist(), strict=True):
        _check_free(f"start of {name}", gap - settings.player(name).radius)


def _check_free(place: str, gap: float) -> None:
    """Check that a place is on the free floor of the room.

    Args:
        place: What it is, for the message.
        gap: Clearance of the body there, in [m].
    """
    if gap < 0.0:
        raise ConfigurationError(
            f"{place} must be on the free floor of the room, got a clearance "
            f"of {gap:.3g} [m]"
        )


def _draw_position(
    settings: GameSettings,
    player: PlayerSettings,
    poses: dict[str, Pose],
    generator: np.random.Generator,
) -> tuple[float, float]:
    for _ in range(MOST_DRAWS):
        place = _draw_place(settings, generator)
        if place is None:
            continue
        x, y = place
        if all(
            hypot(other.x - x, other.y - y)
            >= max(
                settings.near, least_distance(player, settings.player(name))
            )
            for name, other in poses.items()
        ):
            return x, y
    raise ConfigurationError(
        f"start of {player.name} must be at least {settings.near:g} [m] from "
        f"all others, and there is no such place among {len(poses)} players"
    )


def _draw_place(
    settings: GameSettings, generator: np.random.Generator
) -> tuple[float, float] | None:
    """Return a place on the free floor, in [m]; None if the draw missed it."""
    room = settings.room
    if room is None or room.width is None or room.depth is None:
        away = settings.far * float(np.sqrt(generator.uniform()))
        angle = generator.uniform(-pi, pi)
        x, y = away * cos(angle), away * sin(angle)
    else:
        x = generator.uniform(-0.5 * room.width, 0.5 * room.width)
        y = generator.uniform(-0.5 * room.depth, 0.5 * room.depth)
    if room is not None and room.clearance([(x, y)])[0] < WALL_MARGIN:
        return None
    return float(x), float(y)


def _draw_heading(
    settings: GameSettings,
    player: PlayerSettings,
    poses: dict[str, Pose],
    generator: np.random.Generator,
) -> float:
    own = poses[player.name]
    names = [player.target] if player.target else []
    names = names or [*settings.opponents_of(player.name)]
    if not names or player.role == "bystander":
        return float(generator.uniform(-pi, pi))
    nearest = min(
        (poses[name] for name in names),
        key=lambda pose: hypot(pose.x - own.x, pose.y - own.y),
    )
    sight = atan2(nearest.y - own.y, nearest.x - own.x)
    most = pi / 2 if player.role == "pursuer" else radians(30.0)
    return wrap_angle(sight + float(generator.uniform(-most, most)))
