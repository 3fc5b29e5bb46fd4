"""Environments of a duel: of both players, and of one against a strategy."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, ClassVar

import gymnasium
import numpy as np
from numpy.typing import NDArray

from ..arena import OPEN_FLOOR
from ..core.errors import (
    ConfigurationError,
    StrategyError,
    check_choice,
    shown,
)
from ..games.game import GameInPlay
from ..games.player_settings import PLAYERS
from ..games.recorded_game import RecordedGame
from ..strategies.learned import (
    FARTHEST,
    FULL_STATE_TERMS,
    length_unit,
    observe,
)
from ..strategies.registry import load_strategy
from ..strategies.strategy import Strategy
from .environment_settings import (
    SEEDS,
    STRIDE,
    EnvironmentSettings,
    direction_of,
    observation_space,
)
from .parallel_games import Episode, HeldIntent, ParallelGames

LONGEST_WAIT = 30.0  # for the first sighting, in [s]
USUAL = {"evader": "pursuit", "pursuer": "evasion"}  # opponent of a role


class DuelParallelEnv(ParallelGames):
    """Both players of a duel; a step is one decision of each.

    Observations, actions and rewards are those of :class:`DuelEnv`; the game
    is zero-sum.

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
        physics, body = given.level == "physics", given.duel.pursuer.body
        if physics and body != "robot" and "pursuer" in learners:
            raise ConfigurationError(
                "duel.pursuer.body must be robot if the pursuer learns, "
                f"got {body!r}"
            )
        super().__init__(
            learners, given, observation_space(given.terms), render_mode
        )
        self._arenas = None if physics else given.draw_arenas()

    def begin(self, seed: int, number: int) -> Episode:
        """Begin an episode; in physics, when the learners see the others."""
        settings, arenas = self.settings, self._arenas
        held = {n: HeldIntent(direction_of(n)) for n in self.possible_agents}
        played: dict[str, Any] = {**self._strategies, **held}
        if arenas is not None:
            index = int(arenas.indices(seed, number))
            room, rules = arenas.rooms[index], settings.step_game
            pair = played["pursuer"], played["evader"]
            world = rules.world(pair, arenas.starts[index], room)
            return Episode(GameInPlay(world, rules.rules), held, room)
        duel = replace(
            settings.duel,
            seed=(settings.first_arena + seed + STRIDE * number) % SEEDS,
            duration=settings.duration,
        )
        robots = {n: s for n, s in played.items() if n in duel.robots}
        game = RecordedGame(duel, strategies=robots, recorded=False)
        room, period = duel.room or OPEN_FLOOR, duel.evader.gait.step_duration
        episode = Episode(
            game, held, room, period=period, patience=LONGEST_WAIT
        )
        if not episode.sees:
            game.world.close()
            raise StrategyError(
                "a player must see its opponent within "
                f"{LONGEST_WAIT:g} s, got {episode.ended or 'no sighting'}"
            )
        return episode

    def observe(self, episode: Episode, name: str) -> NDArray[np.float32]:
        """Return the observation of a player."""
        known = episode.knowledge(name)
        assert known is not None
        values = observe(known, self.settings.sensed_terms)
        if not self.settings.full_state:
            return values
        full = [v for n in FULL_STATE_TERMS for v in _full(episode, n, name)]
        return np.concatenate([values, np.array(full, dtype=np.float32)])

    def unit(self, episode: Episode, name: str) -> float:
        """Return the unit of length of the first learner, in [m]."""
        known = episode.knowledge(self.possible_agents[0])
        assert known is not None
        return length_unit(known.limits)

    def info(self, episode: Episode) -> dict[str, Any]:
        """Return closest approach, distance [m], time [s] and outcome."""
        return {
            "closest_m": episode.closest["evader"],
            "distance_m": episode.distances["evader"],
            "time_s": episode.time,
            "outcome": episode.ended,
        }


def _full(episode: Episode, term: str, name: str) -> Sequence[float]:
    """Return the values of a term that no sense gives."""
    if term == "remaining":
        return (max(0.0, 1.0 - episode.time / episode.game.rules.duration),)
    pursuer, evader = (episode.knowledge(player) for player in PLAYERS)
    assert pursuer is not None and evader is not None
    if term == "closest":
        unit = length_unit(evader.limits)
        return (min(episode.closest["evader"] / unit, FARTHEST),)
    other = evader if name == "pursuer" else pursuer
    return np.cos(other.bearing), np.sin(other.bearing)


def parallel_env(**settings: Any) -> DuelParallelEnv:
    """Build the environment; see :class:`DuelParallelEnv`."""
    return DuelParallelEnv(**settings)


def load_opponent(
    name: str | Strategy | None, role: str
) -> dict[str, Strategy]:
    """Load the opponent of the role that learns, by its own role.

    None stands for the paper's strategy.
    """
    check_choice(role, PLAYERS, "role")
    loaded = load_strategy(USUAL[role] if name is None else name)
    other = PLAYERS[1 - PLAYERS.index(role)]
    if loaded.direction is not direction_of(other):
        raise ConfigurationError(
            f"opponent must walk {direction_of(other).name.lower()}, as a "
            f"{other} does, got {shown(name)}"
        )
    return {other: loaded}


class DuelEnv(gymnasium.Env[NDArray[np.float32], Any]):
    """One player against a strategy; a step is one decision.

    The observation holds the terms of ``settings.terms``; the reward is that
    of :class:`.ParallelGames`. Capture and contact with an obstacle, in
    physics falls and contacts, terminate an episode; the time limit
    truncates it. ``info`` holds "closest_m", "distance_m", "time_s" and
    "outcome", in one word.

    Attributes:
        role: "pursuer" or "evader".
        settings: Settings of the environment.
    """

    metadata: ClassVar[dict[str, Any]] = {  # type: ignore[misc]
        "render_modes": ["rgb_array"],
        "render_fps": 10,
    }

    def __init__(
        self,
        role: str,
        *,
        opponent: str | Strategy | None = None,
        render_mode: str | None = None,
        **settings: Any,
    ) -> None:
        """Build the environment.

        Args:
            role: Role of the player, "pursuer" or "evader".
            opponent: Strategy of the opponent: a name, FILE.py:NAME,
                FILE.onnx or a strategy; by default that of the paper.
            render_mode: "rgb_array" for images from above, or None.
            settings: Fields of :class:`.EnvironmentSettings`.

        Raises:
            ConfigurationError: If a value is invalid.
        """
        self._both = DuelParallelEnv(
            render_mode=render_mode,
            opponents=load_opponent(opponent, role),
            **settings,
        )
        self.role, self.render_mode = role, render_mode
        self.settings = self._both.settings
        self.action_space = self._both.action_space(role)
        self.observation_space: Any = self._both.observation_space(role)
        self._is_seeded = False

    def reset(
        self,
        *,
        seed: int | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        """Begin the next episode of a seed.

        Args:
            seed: Seed; None continues with the next episode.
            options: Not used.
        """
        super().reset(seed=seed)
        if seed is None and not self._is_seeded:
            seed = int(self.np_random.integers(SEEDS))
        self._is_seeded = True
        observations, infos = self._both.reset(seed)
        return observations[self.role], infos[self.role]

    def step(
        self, action: Any
    ) -> tuple[NDArray[np.float32], float, bool, bool, dict[str, Any]]:
        """Play one decision.

        Raises:
            PlanError: If the action is invalid, or the episode is over.
        """
        role = self.role
        seen, reward, ended, late, info = self._both.step({role: action})
        return seen[role], reward[role], ended[role], late[role], info[role]

    def render(self) -> Any:
        """Return an image from above."""
        return self._both.render()

    def close(self) -> None:
        """End the episode and release its resources."""
        self._both.close()
