"""Initial poses and goals of players that are drawn."""

from collections.abc import Sequence
from itertools import combinations
from math import atan2, cos, dist, pi, radians, sin

import numpy as np

from ..arena import Room
from ..core.errors import ConfigurationError
from ..core.poses import Pose, wrap_angle
from ..core.random_streams import named_generator
from ..robots.description import load_robot
from ..sim.person_settings import PATHS, RADIUS
from .game_settings import GameSettings
from .people import walk_on_path
from .player_settings import PlayerSettings

MOST_DRAWS = 2000  # of one position, before the floor counts as full
WALL_MARGIN = 0.3  # clearance of a start from walls and obstacles, in [m]
Spot = tuple[tuple[float, ...], float]  # place, and least distance, in [m]


def draw_starts(settings: GameSettings) -> GameSettings:
    """Return the game with initial poses and goals, drawn where omitted.

    Positions are drawn from the seed, then headings: pursuers look up to a
    right angle beside their opponent, evaders up to 30 degrees beside theirs,
    people with a goal to the goal, others anywhere. A person with a path
    begins where and as the path does.
    """
    generator = named_generator(settings.seed, "starts")
    poses: dict[str, Pose] = {}
    for player in settings.players:
        given = _given_pose(player)
        if given is not None:
            poses[player.name] = given
    _check_apart(settings, poses)
    drawn = [p for p in settings.players if p.name not in poses]
    near = settings.start.near
    for player in drawn:
        keep = [
            (at[:2], max(near, least_distance(player, settings.player(name))))
            for name, at in poses.items()
        ]
        what = f"start of {player.name}"
        x, y = _draw_place(settings, keep, generator, what)
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
    placed = settings.with_players({n: {"goal": g} for n, g in goals.items()})
    placed = placed.started_at([poses[name] for name in placed.names])
    for player in placed.players:
        if player.body == "person" and player.name not in goals:
            poses[player.name] = walk_on_path(placed, player).pose
    return placed.started_at(
        [
            Pose(x, y, wrap_angle(theta))
            for x, y, theta in map(poses.__getitem__, placed.names)
        ]
    )


def _given_pose(player: PlayerSettings) -> Pose | None:
    """Return the initial pose that is not drawn; None if it is."""
    own, walks = player.person, not (player.goal or player.draws_goal)
    if player.body == "person" and walks and own.path not in PATHS:
        from ..sim.person_motion import PersonMotion

        return PersonMotion(own, Pose(0.0, 0.0, 0.0), (0.0, 0.0)).pose
    return player.pose


def _goals_of(
    settings: GameSettings, poses: dict[str, Pose]
) -> dict[str, tuple[float, ...]]:
    """Return the goal of each player that has one, drawn where omitted."""
    generator = named_generator(settings.seed, "goals")
    goals = {p.name: p.goal for p in settings.players if p.goal}
    room, far = settings.room, settings.start.far
    for name, goal in goals.items():
        _check_free(room, goal, f"goal of {name}")
    if room is not None and room.width and room.depth:
        far = max(room.width, room.depth) / 3.0
    for player in settings.players:
        if player.draws_goal and player.name not in goals:
            keep: list[Spot] = [
                (place, least_distance(player, settings.player(name)))
                for name, place in goals.items()
            ]
            keep.append((poses[player.name][:2], far))
            what = f"goal of {player.name}"
            goals[player.name] = _draw_place(settings, keep, generator, what)
    return goals


def least_distance(one: PlayerSettings, other: PlayerSettings) -> float:
    """Return the distance at which two bodies cannot overlap, in [m]."""
    return _radius(one) + _radius(other)


def _radius(player: PlayerSettings) -> float:
    """Return the radius within which a body stands, in [m]."""
    if player.body == "person":
        return RADIUS
    if player.body != "robot":
        return 0.0
    return 0.5 * load_robot(player.robot).game.start_least


def _check_apart(settings: GameSettings, poses: dict[str, Pose]) -> None:
    """Check that given starts keep clear of each other and of the room."""
    for other, name in combinations(poses, 2):
        least = least_distance(settings.player(name), settings.player(other))
        away = dist(poses[name][:2], poses[other][:2])
        if away < least - 1e-9:
            raise ConfigurationError(
                f"starts of {other} and {name} must be at least {least:g} [m] "
                f"apart, or they overlap, got {away:.3g}"
            )
    for name, pose in poses.items():
        radius = settings.player(name).radius
        _check_free(settings.room, pose[:2], f"start of {name}", radius)


def _check_free(
    room: Room | None, place: tuple[float, ...], what: str, radius: float = 0.0
) -> None:
    """Check that a place, in [m], is free for a body of a radius, in [m]."""
    if room is None:
        return
    gap = float(room.clearance([place])[0]) - radius
    if gap < 0.0 or not room.is_inside([place])[0]:
        raise ConfigurationError(
            f"{what} must be on the free floor of the room, got a clearance "
            f"of {gap:.3g} [m]"
        )


def _draw_place(
    settings: GameSettings,
    keep: Sequence[Spot],
    generator: np.random.Generator,
    what: str,
) -> tuple[float, float]:
    """Return a place on the free floor, in [m], away from others."""
    room = settings.room
    for _ in range(MOST_DRAWS):
        if room is None or room.width is None or room.depth is None:
            away = settings.start.far * float(np.sqrt(generator.uniform()))
            angle = generator.uniform(-pi, pi)
            x, y = away * cos(angle), away * sin(angle)
        else:
            x = generator.uniform(-0.5 * room.width, 0.5 * room.width)
            y = generator.uniform(-0.5 * room.depth, 0.5 * room.depth)
        if room is not None and room.clearance([(x, y)])[0] < WALL_MARGIN:
            continue
        if all(dist((x, y), place) >= least for place, least in keep):
            return float(x), float(y)
    least = max((least for _, least in keep), default=0.0)
    raise ConfigurationError(
        f"{what} must be at least {least:g} [m] away from {len(keep)} places "
        f"and {WALL_MARGIN:g} [m] from walls, and there is no such place"
    )


def _draw_heading(
    settings: GameSettings,
    player: PlayerSettings,
    poses: dict[str, Pose],
    generator: np.random.Generator,
) -> float:
    own = poses[player.name]
    others = [poses[p.name] for p in settings.sensed_opponents(player)]
    if not others or player.role == "bystander":
        return float(generator.uniform(-pi, pi))
    nearest = min(others, key=lambda pose: dist(pose[:2], own[:2]))
    sight = atan2(nearest.y - own.y, nearest.x - own.x)
    most = pi / 2 if player.role == "pursuer" else radians(30.0)
    return wrap_angle(sight + float(generator.uniform(-most, most)))
