"""Initial poses of the players of a game."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import combinations
from math import atan2, cos, dist, hypot, pi, radians, sin

import numpy as np

from .. import arena
from ..core.errors import ConfigurationError
from ..core.poses import Pose, wrap_angle
from ..core.random_streams import named_generator
from ..robots.description import load_robot
from ..sim.crowd_motion import RADIUS
from ..sim.person_motion import PersonMotion
from ..sim.person_settings import PATHS
from .floor_games import walk_on_path
from .game_settings import GameSettings, StartSettings
from .player_settings import PLAYERS, PlayerSettings

MOST_DRAWS = 2000  # of one position, before the floor counts as full
WALL_MARGIN = 0.3  # clearance of a start from walls and obstacles, in [m]
SLOW_SPEED = 0.15  # up to which a person begins a duel nearby, in [m/s]
LEAD_TIME = 5.0  # extra distance of a faster person over its speed, in [s]
SAME = 1e-6  # tolerance within which starts are equal, in [m] and [rad]


def with_starts(settings: GameSettings) -> GameSettings:
    """Return the settings of the same game with nothing left open.

    All starts are filled in, and what the settings imply.
    In a duel they are those of ``start``, or of its room, which gets them.
    Otherwise positions are drawn from the seed where they are omitted, then
    headings: pursuers look up to a right angle beside their opponent,
    evaders up to 30 degrees beside theirs, people with a goal to the goal,
    others anywhere. A person with a path begins where and as the path does.
    """
    if settings.game == "duel":
        return _with_start_of_duel(settings)
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
    placed = _placed(settings, poses, goals)
    for player in placed.players:
        if player.body == "person" and not player.goal:
            poses[player.name] = walk_on_path(placed, player).pose
    for name, (x, y, theta) in poses.items():
        poses[name] = Pose(x, y, wrap_angle(theta))
    return _placed(settings, poses, goals).resolved()


def _with_start_of_duel(settings: GameSettings) -> GameSettings:
    """Return a duel with its start, and poses by it or by its room."""
    plan = settings.room
    if settings.start.distance is None and settings.evader.start:
        raise ConfigurationError(
            "evader: start must be omitted in a duel, whose start is start"
        )
    if plan is None:
        start = draw_start(settings)
        assert start.distance is not None
        assert start.pursuer_offset is not None
        assert start.evader_offset is not None
        poses = (
            Pose(0.0, 0.0, start.pursuer_offset),
            Pose(start.distance, 0.0, pi + start.evader_offset),
        )
    else:
        poses = plan.starts or arena.draw_initial_poses(plan, settings.seed)
        arena.check_initial_poses(plan, poses)
        settings = replace(settings, room=replace(plan, starts=poses))
        start = _start_in_room(settings.start, poses)
    own = settings.pursuer
    if own.body == "person" and own.person.backward:  # it looks away
        x, y, theta = poses[0]
        poses = Pose(x, y, theta - pi), poses[1]
    named = dict(zip(PLAYERS, poses, strict=True))
    return _placed(replace(settings, start=start), named, {}).resolved()


def draw_start(settings: GameSettings) -> StartSettings:
    """Return the start of a duel with what is omitted drawn by the seed."""
    start, pursuer = settings.start, settings.pursuer
    generator = named_generator(settings.seed, "start")
    distance = generator.uniform(start.near, start.far)
    if pursuer.body == "person":
        distance += 1.5  # whole strides away
        # A faster person begins farther away, to be detected in time.
        distance += LEAD_TIME * max(0.0, pursuer.person.speed - SLOW_SPEED)
    drawn = {
        "distance": distance,
        "pursuer_offset": generator.uniform(-pi / 2, pi / 2),
        "evader_offset": generator.uniform(-radians(30.0), radians(30.0)),
    }
    missing = {k: v for k, v in drawn.items() if getattr(start, k) is None}
    return replace(start, **missing)


def _start_in_room(
    given: StartSettings, poses: tuple[Pose, Pose]
) -> StartSettings:
    """Return the start of poses in a room; reject a different one."""
    (x, y, pursuer), (u, v, evader) = poses
    sight = atan2(v - y, u - x)
    found = {
        "distance": hypot(u - x, v - y),
        "pursuer_offset": wrap_angle(pursuer - sight),
        "evader_offset": wrap_angle(evader - sight - pi),
    }
    for name, drawn in found.items():
        value = getattr(given, name)
        if value is not None and not abs(value - drawn) < SAME:
            raise ConfigurationError(
                f"start.{name} must be omitted in a room, which gives "
                f"the initial poses, got {value:g}"
            )
    return replace(given, **found)


def _given_pose(player: PlayerSettings) -> Pose | None:
    """Return the initial pose that is not drawn; None if it is."""
    own, walks = player.person, not (player.goal or player.draws_goal)
    if player.body == "person" and walks and own.path not in PATHS:
        return PersonMotion(own, Pose(0.0, 0.0, 0.0), (0.0, 0.0)).pose
    return player.pose


def _placed(
    settings: GameSettings,
    poses: Mapping[str, Pose],
    goals: Mapping[str, tuple[float, ...]],
) -> GameSettings:
    """Return a game with all starts and goals."""
    places = {
        own.name: {
            "start": tuple(map(float, poses[own.name])),
            "goal": goals.get(own.name, own.goal),
        }
        for own in settings.players
    }
    return settings.with_players(places)


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
    room, least = settings.room, settings.start.far
    if room is not None and room.width and room.depth:
        least = max(room.width, room.depth) / 3.0
    keep = [
        ((u, v), least_distance(player, settings.player(name)))
        for name, (u, v) in goals.items()
    ]
    found = _draw_place(settings, [*keep, (start[:2], least)], generator)
    if found is None:
        raise ConfigurationError(
            f"goal of {player.name} must be at least {least:g} [m] from its "
            "start, and there is no such place"
        )
    return found


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
    names = list(poses)
    for other, name in combinations(names, 2):
        least = least_distance(settings.player(name), settings.player(other))
        away = dist(poses[name][:2], poses[other][:2])
        if away < least - 1e-9:
            raise ConfigurationError(
                f"starts of {other} and {name} must be at least {least:g} [m] "
                f"apart, or they overlap, got {away:.3g}"
            )
    room = settings.room
    if room is None or not names:
        return
    gaps = room.clearance([poses[name][:2] for name in names])
    for name, gap in zip(names, gaps.tolist(), strict=True):
        _check_free(f"start of {name}", gap - settings.player(name).radius)


def _check_free(place: str, gap: float) -> None:
    """Check that a place has a clearance, in [m], from room and obstacles."""
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
    near = settings.start.near
    keep = [
        (pose[:2], max(near, least_distance(player, settings.player(name))))
        for name, pose in poses.items()
    ]
    found = _draw_place(settings, keep, generator)
    if found is None:
        raise ConfigurationError(
            f"start of {player.name} must be at least {near:g} [m] from all "
            f"others, and there is no such place among {len(poses)} players"
        )
    return found


def _draw_place(
    settings: GameSettings,
    keep: Sequence[tuple[tuple[float, ...], float]],
    generator: np.random.Generator,
) -> tuple[float, float] | None:
    """Return a place on the free floor, in [m]; None if there is none.

    It keeps the distance, in [m], of each of some places.
    """
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
    return None


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
    others = (poses[name] for name in names)
    nearest = min(others, key=lambda pose: dist(pose[:2], own[:2]))
    sight = atan2(nearest.y - own.y, nearest.x - own.x)
    most = pi / 2 if player.role == "pursuer" else radians(30.0)
    return wrap_angle(sight + float(generator.uniform(-most, most)))
