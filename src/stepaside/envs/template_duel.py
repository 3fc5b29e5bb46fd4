"""One game of an environment, without physics or in physics."""

from collections.abc import Iterator, Sequence
from typing import Protocol

from ..arena import Room
from ..core.errors import StrategyError
from ..core.poses import Pose
from ..planning import Direction
from ..strategies.constant_walk import StandStill
from ..strategies.knowledge import Intent, Knowledge
from ..strategies.strategy import Strategy
from ..strategies.strategy_game import (
    StepGame,
    StrategyOutcome,
    judge_poses,
    move_players,
    place_players,
)


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
        self._game, (self.room, starts) = game, arena
        self._strategies = strategies
        pursuer, evader = (
            strategy or StandStill(direction)
            for strategy, direction in zip(
                strategies,
                (Direction.FORWARD, Direction.BACKWARD),
                strict=True,
            )
        )
        self._players = place_players(
            game, (pursuer, evader), starts, self.room
        )
        self._times = game.decision_times
        self._packed = self.room.solid_set.packed
        self._decision = 0
        self.ended = ""
        self._look()
        self.closest = self.distance

    @property
    def time(self) -> float:
        """Path time, in [s]."""
        return self._decision * self._game.period / self._game.decisions

    @property
    def truncated(self) -> bool:
        """Whether the time is up."""
        return self._decision >= len(self._times)

    @property
    def poses(self) -> tuple[Pose, Pose]:
        """Poses of pursuer and evader in the room."""
        pursuer, evader = self._players
        return pursuer.pose, evader.pose

    def step(self, intents: Sequence[Intent | None]) -> Iterator[None]:
        """Play until the next decision.

        Args:
            intents: Intent of pursuer and evader; None for a player with a
                strategy.

        Raises:
            StrategyError: If a strategy returns no intent.
        """
        yield from ()  # it has no networks
        pursues, evades = (
            self._intent(n, intent) for n, intent in enumerate(intents)
        )
        for _ in move_players(self._game, self._players, (pursues, evades)):
            pass
        self._decision += 1
        self._look()
        _, outcome = judge_poses(self._game, self._packed, self.poses)
        if outcome is StrategyOutcome.TOUCHED:
            self.closest = 0.0
        else:
            self.closest = min(self.closest, self.distance)
        if outcome is not StrategyOutcome.SURVIVED:
            self.ended = str(outcome)

    def close(self) -> None:
        """Nothing to release."""

    def _intent(self, number: int, given: Intent | None) -> Intent:
        """Return the intent of a player, decided by its strategy or given."""
        player = self._players[number]
        if self._strategies[number] is not None:
            return player.decide(self.knowledge[number])
        if given is None:
            raise StrategyError(f"player {number} needs an intent, got none")
        player.moving = given.walks
        return given

    def _look(self) -> None:
        """Update the knowledge of both players."""
        pursuer, evader = self._players
        self.knowledge: tuple[Knowledge, Knowledge] = (
            pursuer.see(self.time, evader.pose),
            evader.see(self.time, pursuer.pose),
        )
        self.distance = self.knowledge[1].distance
