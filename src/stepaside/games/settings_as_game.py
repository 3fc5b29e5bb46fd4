"""Every kind of game as a game of players: duels and walks are such."""

from math import pi

from ..core.poses import Pose
from ..planning import Direction
from ..strategies import Strategy, Walk
from ..strategies.shield_settings import ShieldSettings
from .duel_settings import EVADER, PLAYERS, DuelSettings
from .game_furnishing import Scenery, scenery_of_game
from .game_settings import GameSettings, PlayerSettings
from .game_starts import with_starts
from .initial_poses import initial_poses, with_initial_poses
from .walk_settings import WALKER, WalkSettings

PlayableSettings = DuelSettings | GameSettings | WalkSettings
WALL_MARGIN = 1.0  # smallest distance of a start from the walls, in [m]
WALL_DISTANCE = 3.5  # from a start to walls moved for it: camera range, [m]


def complete(settings: PlayableSettings) -> PlayableSettings:
    """Return the settings of the same game with nothing left open.

    Starts are filled in, and what the settings imply.

    Raises:
        ConfigurationError: If there is no space for the starts.
    """
    if isinstance(settings, DuelSettings):
        return with_initial_poses(settings)
    if isinstance(settings, GameSettings):
        return with_starts(settings)
    return settings.resolved()


def as_game(settings: PlayableSettings) -> GameSettings:
    """Return the game of players that a duel or a walk is."""
    if isinstance(settings, GameSettings):
        return settings
    if isinstance(settings, WalkSettings):
        own = settings.robot_of(WALKER)
        return GameSettings(
            seed=settings.seed,
            duration=settings.duration,
            players=(
                PlayerSettings(
                    WALKER,
                    robot=own.robot,
                    gait=own.gait,
                    control=own.control,
                    start=(0.0, 0.0, 0.0),
                ),
            ),
            physics=settings.physics,
            body=settings.body,
            pushes=settings.pushes,
        )
    return GameSettings(
        seed=settings.seed,
        duration=settings.duration,
        players=tuple(
            _player(settings, *each)
            for each in zip(PLAYERS, initial_poses(settings), strict=True)
        ),
        physics=settings.physics,
        body=settings.body,
        room=settings.room.plan,
        map=settings.map,
        cameras=settings.cameras,
        lidar=settings.lidar,
        pushes=settings.pushes,
    )


def _player(settings: DuelSettings, name: str, pose: Pose) -> PlayerSettings:
    """Return the settings of one player of a duel."""
    own, evades = settings.robot_of(name), name == EVADER
    is_robot = name in settings.robots
    if not is_robot and settings.person.backward:
        pose = Pose(pose.x, pose.y, pose.theta - pi)  # it looks away
    return PlayerSettings(
        name=name,
        role=name,
        body="robot" if is_robot else "person",
        robot=own.robot,
        gait=own.gait,
        control=own.control,
        legs=own.legs,
        strategy=settings.evader_strategy
        if evades
        else settings.pursuer_strategy,
        evasion=settings.strategy,
        shield=settings.shield if evades else ShieldSettings(),
        start=tuple(pose),
        senses=settings.sensing if is_robot else "ideal",
        sight=settings.sight,
        person=settings.person,
    )


def strategies_of(settings: PlayableSettings) -> dict[str, Strategy]:
    """Return the strategies that a game of players has no settings for."""
    if not isinstance(settings, WalkSettings):
        return {}
    back, ahead = Direction.BACKWARD, Direction.FORWARD
    way = back if settings.backward else ahead
    return {WALKER: Walk(settings.bearing, way)}


def scenery_of(settings: PlayableSettings) -> Scenery:
    """Return everything but robots in the world of a game."""
    if isinstance(settings, DuelSettings):
        game, walls = as_game(settings), _wall_distance(settings)
        return scenery_of_game(game, settings.room, walls)
    return scenery_of_game(as_game(settings))


def _wall_distance(settings: DuelSettings) -> float:
    """Return the distance of the walls from the origin, in [m].

    A player that began outside the walls would pass through one, undetected
    until then. If a start is not well inside, the walls are moved beyond the
    range of a depth camera at that start.
    """
    walls = settings.room.walls
    reach = max(abs(c) for frame in initial_poses(settings) for c in frame[:2])
    if not walls or reach + WALL_MARGIN <= walls:
        return walls
    return reach + WALL_DISTANCE
