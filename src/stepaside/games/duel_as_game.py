"""A duel as a game of two players, from which its world is built."""

from collections.abc import Mapping
from math import pi
from types import MappingProxyType

from ..core.poses import Pose
from ..locomotion.policy.network_pool import NetworkPool
from ..strategies.shield_settings import ShieldSettings
from .duel_furnishing import scenery_of_duel
from .duel_settings import EVADER, PLAYERS, DuelSettings
from .game_settings import GameSettings, PlayerSettings
from .game_world import GameWorld, RemoteControl
from .initial_poses import initial_poses


def game_of_duel(settings: DuelSettings) -> GameSettings:
    """Return the game of two players that a duel is.

    Args:
        settings: Settings of the duel, with the initial poses filled in.
    """
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
    """Return the settings of one player."""
    own, evades = settings.robot_of(name), name == EVADER
    if name not in settings.robots and settings.person.backward:
        pose = Pose(pose.x, pose.y, pose.theta - pi)  # it looks away
    return PlayerSettings(
        name=name,
        role=name,
        body="robot" if name in settings.robots else "person",
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
        senses=settings.sensing if name in settings.robots else "ideal",
        sight=settings.sight,
        person=settings.person,
    )


def build_duel_world(
    settings: DuelSettings,
    *,
    rendered: bool,
    remote: Mapping[str, RemoteControl] = MappingProxyType({}),
    networks: NetworkPool | None = None,
) -> GameWorld:
    """Build the world of a duel and place the players in it.

    Args:
        settings: Settings of the duel, with the initial poses filled in.
        rendered: Whether to render the world; cameras do so anyway.
        remote: Control of the robots that other processes control, by name
            of the player.
        networks: Networks of robots on learned legs, shared with other
            duels.

    Raises:
        StepAsideError: If the settings contradict each other or cannot be
            met by the robots.
    """
    return GameWorld(
        game_of_duel(settings),
        scenery_of_duel(settings),
        rendered=rendered,
        remote=remote,
        networks=networks,
    )
