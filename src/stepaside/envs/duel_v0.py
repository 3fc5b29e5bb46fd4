"""PettingZoo environment: pursuer and evader act at the same time."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..arena import OPEN_FLOOR
from ..core.errors import ConfigurationError, StrategyError
from ..games.duel_settings import PLAYERS
from ..games.floor_games import floor_of_two, rules_of_two
from ..games.game import GameInPlay
from ..games.recorded_game import RecordedGame
from ..strategies.constant_walk import StandStill
from ..strategies.learned.observation_terms import (
    FARTHEST,
    FULL_STATE_TERMS,
    length_unit,
    observe,
)
from ..strategies.strategy import Strategy
from .arena_pool import STRIDE
from .environment_settings import EnvironmentSettings, direction_of
from .episode_games import EpisodeGame, FloorGame, HeldIntent, PhysicsGame
from .intent_actions import observation_space
from .parallel_games import SEEDS, ParallelGames

LONGEST_WAIT = 30.0  # for the first sighting, in [s]


class DuelParallelEnv(ParallelGames):
    """Both players of a duel; a step is one decision of each.

    Observations, actions and rewards are those of
    :class:`.duel_env.DuelEnv`; the game is zero-sum.

    Attributes:
        settings: Settings of the environment.
    """

    metadata = ParallelGames.metadata | {"name": "stepaside_duel_v0"}

    def __init__(
        self,
        *,
        render_mode: str | None = None,
        opponents: Mapping[str, Strategy] | None = None,
        **settings: Any,
    ) -> None:
        """Build the environment.

        Args:
            render_mode: "rgb_array" for images from above, or None.
            opponents: Strategy of a player that does not learn, by role.
            settings: Fields of :class:`.EnvironmentSettings`.

        Raises:
            ConfigurationError: If a value is invalid.
        """
        self.settings = given = EnvironmentSettings(**settings)
        self._strategies = dict(opponents or {})
        learners = [name for name in PLAYERS if name not in self._strategies]
        if given.level == "physics" and given.duel.pursuer != "robot":
            if "pursuer" in learners:
                raise ConfigurationError(
                    "duel.pursuer must be robot where the pursuer learns, "
                    f"got {given.duel.pursuer!r}"
                )
        super().__init__(
            learners, given, observation_space(given.terms), render_mode
        )
        self._pool = None if given.level == "physics" else given.draw_arenas()

    def begin(self, seed: int, number: int) -> EpisodeGame:
        """Begin the game of an episode."""
        settings, pool = self.settings, self._pool
        if pool is None:
            return self._begin_in_physics(seed, number)
        index = int(pool.indices([seed], [number])[0])
        room, game = pool.rooms[index], settings.step_game
        pursuer, evader = (
            self._strategies.get(name)
            or StandStill(direction=direction_of(name))
            for name in PLAYERS
        )
        world = floor_of_two(game, (pursuer, evader), pool.starts[index], room)
        return FloorGame(GameInPlay(world, rules_of_two(game)), room)

    def _begin_in_physics(self, seed: int, number: int) -> EpisodeGame:
        """Place the robots, and wait until the learners see the others."""
        settings = self.settings
        held = {n: HeldIntent(direction_of(n)) for n in self.possible_agents}
        played: dict[str, Any] = {**self._strategies, **held}
        duel = replace(
            settings.duel,
            seed=(settings.first_arena + seed + STRIDE * number) % SEEDS,
            duration=settings.duration,
            evader_strategy=played["evader"],
        )
        if duel.pursuer == "robot":
            duel = replace(duel, pursuer_strategy=played["pursuer"])
        game = PhysicsGame(
            RecordedGame(duel, recorded=False, endless=True),
            held,
            duel.room.plan or OPEN_FLOOR,
            settings.duration,
            patience=LONGEST_WAIT,
        )
        if not game.sees:
            game.close()
            raise StrategyError(
                "a player must see its opponent within "
                f"{LONGEST_WAIT:g} s, got {game.ended or 'no sighting'}"
            )
        return game

    def observe(self, game: EpisodeGame, name: str) -> NDArray[np.float32]:
        """Return the observation of a player."""
        known = game.knowledge(name)
        assert known is not None
        values = observe(known, self.settings.sensed_terms)
        if not self.settings.full_state:
            return values
        full = [v for n in FULL_STATE_TERMS for v in _full(game, n, name)]
        return np.concatenate([values, np.array(full, dtype=np.float32)])

    def unit(self, game: EpisodeGame, name: str) -> float:
        """Return the unit of length of the first learner, in [m]."""
        known = game.knowledge(self.possible_agents[0])
        assert known is not None
        return length_unit(known.limits)

    def info(self, game: EpisodeGame) -> dict[str, Any]:
        """Return closest approach, distance [m], time [s] and outcome."""
        return {
            "closest_m": game.closest["evader"],
            "distance_m": game.distances["evader"],
            "time_s": game.time,
            "outcome": game.ended,
        }


def _full(game: EpisodeGame, term: str, name: str) -> Sequence[float]:
    """Return the values of a term that no sense gives."""
    if term == "remaining":
        return (max(0.0, 1.0 - game.time / game.duration),)
    pursuer, evader = (game.knowledge(player) for player in PLAYERS)
    assert pursuer is not None and evader is not None
    if term == "closest":
        unit = length_unit(evader.limits)
        return (min(game.closest["evader"] / unit, FARTHEST),)
    other = evader if name == "pursuer" else pursuer
    return np.cos(other.bearing), np.sin(other.bearing)


def parallel_env(**settings: Any) -> DuelParallelEnv:
    """Build the environment; see :class:`DuelParallelEnv`.

    Args:
        settings: ``render_mode`` and the fields of
            :class:`.EnvironmentSettings`, such as ``level``.
    """
    return DuelParallelEnv(**settings)
