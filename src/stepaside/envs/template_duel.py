"""One game of an environment, without physics or in physics."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from math import hypot, inf
from typing import Protocol

from ..arena import Room
from ..core.errors import StrategyError
from ..core.poses import Pose
from ..games.floor_games import floor_of_two, rules_of_two
from ..games.floor_world import FloorWalk
from ..games.game import GameInPlay
from ..games.outcome import Outcome
from ..planning import Direction
from ..strategies.constant_walk import StandStill
from ..strategies.knowledge import Intent, Knowledge
from ..strategies.strategy import Strategy
from ..strategies.strategy_game import StepGame


class EnvironmentGame(Protocol):
    """One game that an environment plays."""

    @property
    def distance(self) -> float:
        """Distance between the players, in [m]."""

    @property
    def closest(self) -> float:
        """Closest approach so far, in [m].

        It is 0 after contact with an obstacle.
        """

    @property
    def time(self) -> float:
        """Time, in [s]."""

    @property
    def ended(self) -> str:
        """How the game ended, in one word; empty while it goes on.

        The time limit does not end it.
        """

    @property
    def truncated(self) -> bool:
        """Whether the time is up."""

    @property
    def knowledge(self) -> Sequence[Knowledge | None]:
        """Knowledge of pursuer and evader for their next decisions.

        That of a player with a strategy may be None.
        """

    @property
    def poses(self) -> Sequence[Pose]:
        """Poses of pursuer and evader in the room."""

    @property
    def room(self) -> Room:
        """The room."""

    def step(self, intents: Sequence[Intent | None]) -> Iterator[None]:
        """Play until the next decision.

        Yields whenever networks of robots have to be evaluated.

        Args:
            intents: Intent of pursuer and evader; None for a player with a
                strategy.
        """

    def close(self) -> None:
        """Release its resources."""


class TemplateDuel:
    """Game at level "unicycle" or "steps"; see :class:`EnvironmentGame`.

    Attributes:
        room: The room.
        distance: Distance between the players, in [m].
        closest: Closest approach so far, in [m].
        time: Path time, in [s].
        ended: "captured" or "touched"; empty while the game goes on.
        knowledge: Knowledge of pursuer and evader.
    """

    def __init__(
        self,
        game: StepGame,
        arena: tuple[Room, tuple[Pose, Pose]],
        strategies: tuple[Strategy | None, Strategy | None],
    ) -> None:
        """Place the players.

        Args:
            game: Rules.
            arena: Room, and initial poses of pursuer and evader.
            strategies: Strategies of pursuer and evader; None for a player
                whose intents are given.
        """
        self.room, starts = arena
        pursuer, evader = (
            strategy or StandStill(direction=direction)
            for strategy, direction in zip(
                strategies,
                (Direction.FORWARD, Direction.BACKWARD),
                strict=True,
            )
        )
        self._strategies = strategies
        self._world = floor_of_two(game, (pursuer, evader), starts, self.room)
        rules = rules_of_two(game)
        self._game = GameInPlay(self._world, replace(rules, duration=inf))
        self._duration = game.whole_duration
        self.ended = ""
        self.closest = self.distance

    @property
    def time(self) -> float:
        """Path time, in [s]."""
        return self._world.time

    @property
    def distance(self) -> float:
        """Distance between the players, in [m]."""
        (x, y, _), (u, v, _) = self.poses
        return hypot(u - x, v - y)

    @property
    def truncated(self) -> bool:
        """Whether the time is up."""
        return self.time >= self._duration - 1e-9

    @property
    def poses(self) -> tuple[Pose, Pose]:
        """Poses of pursuer and evader in the room."""
        pursuer, evader = self._world.states().values()
        return pursuer, evader

    @property
    def knowledge(self) -> tuple[Knowledge | None, Knowledge | None]:
        """Knowledge of pursuer and evader."""
        return self._world.knowledge("pursuer"), self._world.knowledge(
            "evader"
        )

    def step(self, intents: Sequence[Intent | None]) -> Iterator[None]:
        """Play until the next decision.

        Args:
            intents: Intent of pursuer and evader; None for a player with a
                strategy.

        Raises:
            StrategyError: If a strategy returns no intent.
        """
        yield from ()  # it has no networks
        for name, intent, strategy in zip(
            self._world.motions, intents, self._strategies, strict=True
        ):
            motion = self._world.motions[name]
            assert isinstance(motion, FloorWalk)
            if strategy is None:
                if intent is None:
                    raise StrategyError(f"{name} needs an intent, got none")
                motion.given = intent
        self._game.advance()
        ended = self._game.ended
        self.closest = min(self.closest, self.distance)
        if ended is not None:
            self.ended = str(ended.outcome)
            if ended.outcome is Outcome.TOUCHED:
                self.closest = 0.0

    def close(self) -> None:
        """Nothing to release."""
