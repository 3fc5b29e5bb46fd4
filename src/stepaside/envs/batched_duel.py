"""Thousands of games of an environment in compiled loops."""

from collections.abc import Sequence
from functools import partial
from math import ceil, floor
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.errors import ConfigurationError
from ..core.poses import Array
from ..strategies.constant_walk import StandStill
from ..strategies.evasion import Evasion
from ..strategies.learned import LearnedStrategy
from ..strategies.pursuit import Pursuit
from ..strategies.strategy import Strategy
from ..strategies.strategy_game import StepGame
from .environment_settings import ALL_TERMS, EnvironmentSettings
from .step_batch import (
    EVADES,
    PURSUES,
    RUNNING,
    STANDS,
    TERM_CODES,
    BatchLaw,
    BatchRules,
    BatchState,
    advance_games,
    decide_by_law,
    observe_games,
    start_games,
)

MOST_GAMES = 1_000_000
LARGEST_TURN = 0.8  # between two decisions, of the series of the kernel
Decide = Any


def rules_of(game: StepGame) -> BatchRules:
    """Return the rules of a game as numbers.

    Raises:
        ConfigurationError: If its turns are too large for the kernel.
    """
    parts = game.decisions
    if game.turn / parts > LARGEST_TURN:
        raise ConfigurationError(
            f"game.largest_turn must be at most {LARGEST_TURN * parts:g} "
            f"[rad] for many games, got {game.turn:g}"
        )
    return BatchRules(
        game.stride / parts,
        game.share,
        game.turn,
        float(parts),
        game.period / parts,
        game.speed,
        game.gain,
        game.capture,
        game.body_radius,
        game.count,
        # Of strategies.opponent_track, in decisions.
        floor(2.25 * parts + 1e-9),
        ceil(0.75 * parts + 1e-9),
    )


def law_of(strategy: Strategy) -> BatchLaw:
    """Return the law of a strategy as numbers.

    Raises:
        ConfigurationError: If it has none that the kernel knows.
    """
    if isinstance(strategy, Pursuit):
        saturated, gain = strategy.saturated, strategy.gain
        if strategy == Pursuit(saturated, strategy.body_radius, gain):
            return BatchLaw(PURSUES, saturated, gain)
    if type(strategy) is Evasion and strategy.trigger != "time":
        return BatchLaw(
            EVADES,
            strategy.saturated,
            angle=strategy.angle,
            safety_radius=strategy.safety_radius,
            release=strategy.release_distance,
            hysteresis=strategy.side_hysteresis,
        )
    if type(strategy) is StandStill:
        return BatchLaw(STANDS)
    raise ConfigurationError(
        "opponent of many games must be evasion with the trigger distance, "
        "pursuit of any gain, sharp, stand or FILE.onnx, got a "
        f"{type(strategy).__name__}; others play in vectorization_mode "
        "'sync' or 'async'"
    )


class BatchedDuel:
    """Games side by side, at level "unicycle" or "steps".

    Attributes:
        state: State of all games.
        rules: Rules.
        outcomes: Outcome code of each game. Shape (n,).
    """

    def __init__(
        self,
        settings: EnvironmentSettings,
        number: int,
        strategies: Sequence[Strategy | None],
    ) -> None:
        """Draw the arenas; games begin with :meth:`start`.

        Args:
            settings: Settings of the environment.
            number: Number of games.
            strategies: Strategies of pursuer and evader; None for a player
                whose intents are given.

        Raises:
            ConfigurationError: If the settings do not suit many games.
        """
        if settings.level == "physics":
            raise ConfigurationError(
                "level must be unicycle or steps for compiled games, got "
                "physics, which plays in vectorization_mode 'sync' or 'async'"
            )
        if not 1 <= number <= MOST_GAMES:
            raise ConfigurationError(
                f"num_envs must lie in [1, {MOST_GAMES}] [1], got {number}"
            )
        self.rules = rules = rules_of(settings.step_game)
        self.pool = settings.draw_arenas()
        self._rooms = self.pool.packed()
        self._starts = self.pool.start_rows()
        self._terms = codes_of(settings.terms)
        self._width = sum(ALL_TERMS[n].width for n in settings.terms)
        history = 1 << rules.lag.bit_length()  # above lag, a power of two
        self.state = BatchState(
            np.zeros((number, 2, 4)),
            np.zeros((number, history, 3)),
            np.zeros(number, np.int64),
            np.zeros((number, 2), np.int64),
            np.zeros((number, 2), np.bool_),
            np.zeros(number),
            np.zeros(number, np.int64),
        )
        self.outcomes: NDArray[np.int64] = np.full(number, RUNNING)
        self._intents = np.zeros((number, 2, 2))
        self._deciders = [
            self._decider(n, s) for n, s in enumerate(strategies)
        ]
        self._signs = np.array([1.0, -1.0])
        self._saturated = np.array(
            [s is not None and s.saturated for s in strategies]
        )

    def start(
        self, games: NDArray[np.int64], arenas: NDArray[np.int64]
    ) -> None:
        """Begin games in some arenas.

        Args:
            games: Indices of the games. Shape (m,).
            arenas: Arena of each. Shape (m,).
        """
        self.state.rooms[games] = arenas
        self.outcomes[games] = RUNNING
        start_games(self.state, games, self._starts[arenas])

    def step(self, given: Sequence[Array | None]) -> None:
        """Play one decision of all games.

        Args:
            given: Heading [rad] and speed factor of pursuer and evader, each
                of shape (n, 2); None for a player with a strategy.
        """
        for player, rows in enumerate(given):
            if rows is not None:
                self._intents[:, player] = rows
            else:
                self._intents[:, player] = self._deciders[player]()
        advance_games(
            self.state,
            self._intents,
            self._signs,
            self._saturated,
            self._rooms,
            self.rules,
            self.outcomes,
        )

    @property
    def distances(self) -> Array:
        """Distance of each game, in [m]. Shape (n,)."""
        sights = self.state.sights
        history = sights.shape[1]
        at = self.state.decisions & (history - 1)
        at += np.arange(0, len(at) * history, history)
        found: Array = sights.reshape(-1, 3)[:, 2].take(at)
        return found

    def observations(self, player: int) -> NDArray[np.float32]:
        """Return the observations of a player, 0 or 1. Shape (n, width)."""
        return self._observe(player, self._terms, self._width)

    def _observe(
        self, player: int, terms: NDArray[np.int64], width: int
    ) -> NDArray[np.float32]:
        out = np.empty((len(self.outcomes), width), dtype=np.float32)
        observe_games(self.state, player, terms, self._rooms, self.rules, out)
        return out

    def _decider(self, player: int, strategy: Strategy | None) -> Decide:
        """Return the function that decides for a player with a strategy."""
        if strategy is None:
            return None
        rows = np.zeros((len(self.outcomes), 2))
        if isinstance(strategy, LearnedStrategy):
            contract = strategy.contract
            terms, width = codes_of(contract.terms), contract.observation_width
            return partial(self._by_network, strategy, player, terms, width)
        return partial(self._by_law, law_of(strategy), player, rows)

    def _by_network(
        self,
        strategy: LearnedStrategy,
        player: int,
        terms: NDArray[np.int64],
        width: int,
    ) -> Array:
        return strategy.intents(self._observe(player, terms, width))

    def _by_law(self, law: BatchLaw, player: int, rows: Array) -> Array:
        decide_by_law(self.state, player, law, self.rules, rows)
        return rows


def codes_of(terms: Sequence[str]) -> NDArray[np.int64]:
    """Return the codes of terms for the kernel."""
    return np.array([TERM_CODES[name] for name in terms], dtype=np.int64)
