"""Simulated robots of a duel that are commanded by velocities."""

from collections.abc import Callable, Mapping

from stepaside.games.duel_as_game import build_duel_world
from stepaside.games.duel_settings import PLAYERS, DuelSettings
from stepaside.games.game_world import RemoteControl
from stepaside.games.initial_poses import with_initial_poses
from stepaside.games.match import Match
from stepaside.games.outcome import Outcome
from stepaside.games.velocity_walker import VelocityWalker
from stepaside.sim.world import World
from stepaside.strategies.velocity_set import BodyVelocity


def commanded_robots(
    settings: DuelSettings, *, ideal_sight: bool = True
) -> tuple[World, list[VelocityWalker]]:
    """Return a world with two robots that are commanded by velocities."""
    settings = with_initial_poses(settings)
    control = RemoteControl(balances=True, ideal_sight=ideal_sight)
    stage = build_duel_world(
        settings,
        rendered=False,
        remote=dict.fromkeys(PLAYERS, control),
    )
    robots = [p for p in stage.players if isinstance(p, VelocityWalker)]
    assert len(robots) == 2
    return stage.world, robots


class VelocityCommands:
    """Match observer that commands a velocity to each robot at each tick."""

    def __init__(
        self, sources: Mapping[VelocityWalker, Callable[[], BodyVelocity]]
    ) -> None:
        self._sources = sources

    def before(self, match: Match) -> None:
        """Command all robots."""
        for robot, source in self._sources.items():
            robot.command(source())

    def acted(self, match: Match) -> None:
        """Do nothing."""

    def ended(self, match: Match, outcome: Outcome) -> None:
        """Do nothing."""
