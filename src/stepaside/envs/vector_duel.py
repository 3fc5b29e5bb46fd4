"""Vector environment over games in compiled loops."""

from collections.abc import Sequence
from dataclasses import replace
from math import ceil, floor, pi
from typing import Any, ClassVar

import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from ..arena.obstacles import ObstacleSet
from ..core.errors import (
    ConfigurationError,
    PlanError,
    check_choice,
    check_within,
)
from ..core.poses import Array
from ..games.player_settings import PLAYERS
from ..games.strategy_games import StepGame
from ..strategies.evasion import Evasion
from ..strategies.learned import LearnedStrategy
from ..strategies.pursuit import Pursuit
from ..strategies.strategy import StandStill, Strategy
from .duel_v0 import load_opponent
from .environment_settings import (
    ALL_TERMS,
    SEEDS,
    EnvironmentSettings,
    IntentActions,
    observation_space,
)
from .step_batch import (
    EVADES,
    PURSUES,
    RUNNING,
    TERM_CODES,
    BatchLaw,
    BatchRules,
    BatchState,
    RoomBatch,
    advance_games,
    decide_by_law,
    observe_games,
    start_games,
)

LARGEST_TURN = 0.8  # between two decisions, of the series of the kernel
Batch = NDArray[np.float32]
Integers = NDArray[np.int64]


def rules_of(game: StepGame) -> BatchRules:
    """Return the rules of a game as numbers."""
    parts, share = game.decisions, game.gain * game.period
    if pi * share / parts > LARGEST_TURN:
        raise ConfigurationError(
            "turns of game.gain must be at most "
            f"{LARGEST_TURN * parts:g} [rad] for many games, got "
            f"{pi * share:g}"
        )
    return BatchRules(
        game.stride / parts,
        share,
        pi * share,
        float(parts),
        game.period / parts,
        game.speed / game.gain,
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
    """Return the law of a strategy as numbers, if the kernel knows it."""
    if isinstance(strategy, Pursuit):
        plain = replace(
            Pursuit(),
            saturated=strategy.saturated,
            body_radius=strategy.body_radius,
            gain=strategy.gain,
        )
        if strategy == plain:
            return BatchLaw(PURSUES, strategy.gain)
    if type(strategy) is Evasion and strategy.trigger != "time":
        return BatchLaw(
            EVADES,
            angle=strategy.angle,
            safety_radius=strategy.safety_radius,
            release=strategy.release_distance,
            hysteresis=strategy.side_hysteresis,
        )
    if type(strategy) is StandStill:
        return BatchLaw()
    raise ConfigurationError(
        "opponent of many games must be evasion with the trigger distance, "
        "pursuit of any gain, sharp, stand or FILE.onnx, got a "
        f"{type(strategy).__name__}; others play in vectorization_mode "
        "'sync' or 'async'"
    )


class BatchedDuel:
    """Games side by side, at level "unicycle" or "steps"."""

    def __init__(
        self,
        settings: EnvironmentSettings,
        number: int,
        strategies: Sequence[Strategy | None],
    ) -> None:
        """Draw the arenas; games begin with :meth:`start`.

        Strategies are those of pursuer and evader; None for a player whose
        intents are given.
        """
        if settings.level == "physics":
            raise ConfigurationError(
                "level must be unicycle or steps for compiled games, got "
                "physics, which plays in vectorization_mode 'sync' or 'async'"
            )
        check_within(number, 1, 1_000_000, "num_envs", "1", ConfigurationError)
        self.rules = rules = rules_of(settings.step_game)
        self.arenas = arenas = settings.draw_arenas()
        solids = [room.solid_set.shapes for room in arenas.rooms]
        whole = ObstacleSet(shape for shapes in solids for shape in shapes)
        self._rooms = RoomBatch(
            whole.packed, np.cumsum([0, *map(len, solids)])
        )
        poses = np.array(arenas.starts, dtype=np.float64)
        x, y, heading = np.moveaxis(poses, -1, 0)
        axes = x, y, np.cos(heading), np.sin(heading)
        self._starts = np.stack(axes, axis=-1)
        self._terms = codes_of(settings.terms)
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
        self.outcomes: Integers = np.full(number, RUNNING)
        self._intents = np.zeros((number, 2, 2))
        self._strategies = [
            law_of(s) if s and not isinstance(s, LearnedStrategy) else s
            for s in strategies
        ]
        self._saturated = np.array(
            [s is not None and s.saturated for s in strategies]
        )

    def start(self, games: Integers, arenas: Integers) -> None:
        """Begin the games with some indices in some arenas."""
        self.state.rooms[games] = arenas
        self.outcomes[games] = RUNNING
        start_games(self.state, games, self._starts[arenas])

    def step(self, given: Sequence[Array | None]) -> None:
        """Play one decision of all games.

        Given are headings [rad] and speed factors of pursuer and evader, each
        of shape (n, 2); None for a player with a strategy.
        """
        for player, rows in enumerate(given):
            own, intents = self._strategies[player], self._intents[:, player]
            if rows is not None:
                intents[:] = rows
            elif isinstance(own, BatchLaw):
                decide_by_law(self.state, player, own, self.rules, intents)
            elif isinstance(own, LearnedStrategy):
                terms = codes_of(own.contract.terms)
                intents[:] = own.intents(self._observed(player, terms))
        advance_games(
            self.state,
            self._intents,
            self._saturated,
            self._rooms,
            self.rules,
            self.outcomes,
        )

    def observations(self, player: int) -> Batch:
        """Return the observations of a player, 0 or 1. Shape (n, width)."""
        return self._observed(player, self._terms)

    def _observed(self, player: int, terms: Integers) -> Batch:
        width = sum(WIDTHS[code] for code in terms)
        out = np.empty((len(self.outcomes), width), dtype=np.float32)
        observe_games(self.state, player, terms, self._rooms, self.rules, out)
        return out


WIDTHS = [term.width for term in ALL_TERMS.values()]


def codes_of(terms: Sequence[str]) -> Integers:
    """Return the codes of terms for the kernel."""
    return np.array([TERM_CODES[name] for name in terms], dtype=np.int64)


class VectorDuel(VectorEnv[Batch, Any, Any]):
    """Many games of :class:`.duel_v0.DuelEnv`, without Python per game.

    Game i with seed s is the game of a single environment with seed s. It is
    reset in the step that ends it (``AutoresetMode.SAME_STEP``): the
    observation is then the first of the next episode, the last one of the
    episode is in ``info["final_obs"]``.

    Attributes:
        role: "pursuer" or "evader".
        settings: Settings of the environment.
    """

    metadata: ClassVar[dict[str, Any]] = {  # type: ignore[misc]
        "autoreset_mode": AutoresetMode.SAME_STEP,
        "render_modes": [],
    }

    def __init__(
        self,
        num_envs: int = 1,
        *,
        role: str,
        opponent: str | Strategy | None = None,
        render_mode: str | None = None,
        **settings: Any,
    ) -> None:
        """Build the environments.

        Args:
            num_envs: Number of games.
            role: Role of the player, "pursuer" or "evader".
            opponent: Strategy of the opponent: evasion, pursuit of any
                gain, sharp, stand, FILE.onnx, or such a strategy.
            render_mode: None: many games are not drawn.
            settings: Fields of :class:`.EnvironmentSettings`.

        Raises:
            ConfigurationError: If a value is invalid.
        """
        check_choice(role, PLAYERS, "role")
        if render_mode is not None:
            raise ConfigurationError(
                "render_mode must be None for many games, got "
                f"{render_mode!r:.40}"
            )
        self.role, self.num_envs = role, int(num_envs)
        self.settings = given = EnvironmentSettings(**settings)
        self._index = PLAYERS.index(role)
        played = load_opponent(opponent, role)
        strategies = [played.get(name) for name in PLAYERS]
        self._games = BatchedDuel(given, self.num_envs, strategies)
        sign = 1.0 if role == "evader" else -1.0
        self._scale = sign / self._games.rules.unit
        self._actions = IntentActions(given)
        self.single_action_space = self._actions.space
        self.single_observation_space = observation_space(given.terms)
        self.action_space = batch_space(self._actions.space, self.num_envs)
        self.observation_space = batch_space(
            self.single_observation_space, self.num_envs
        )
        self._seeds, self._begun = np.zeros(self.num_envs, np.int64), False
        self._numbers = np.zeros(self.num_envs, np.int64)

    def reset(
        self,
        *,
        seed: int | Sequence[int | None] | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[Batch, dict[str, Any]]:
        """Begin an episode of all games.

        Args:
            seed: Seed of each game; an integer gives game i that many plus
                i; None continues with the next episodes.
            options: "reset_mask": the games to begin, shape (num_envs,);
                all the first time.
        """
        games = self._chosen(options if self._begun else None)
        if seed is not None or not self._begun:
            self._seeds, self._begun = self._seeds_of(seed), True
            self._numbers[:] = 0
        else:
            self._numbers[games] += 1
        self._begin(games)
        return self._games.observations(self._index), self._info()

    def step(
        self, actions: Any
    ) -> tuple[Batch, Any, Any, Any, dict[str, Any]]:
        """Play one decision of all games.

        Raises:
            PlanError: If the actions are invalid, or nothing was reset.
        """
        if not self._begun:
            raise PlanError("reset the environment first: no episode is on")
        rows = self._actions.rows(actions)
        if len(rows) != self.num_envs:
            raise PlanError(
                f"there must be {self.num_envs} actions, got {len(rows)}"
            )
        games = self._games
        closest = games.state.closest.copy()
        games.step((rows, None) if self._index == 0 else (None, rows))
        ended = games.outcomes != RUNNING
        late = games.state.decisions >= games.rules.limit
        rewards = self._scale * (games.state.closest - closest)
        over, info = ended | late, self._info()
        observations = games.observations(self._index)
        if over.any():
            info["final_obs"], info["_final_obs"] = observations, over
            info["final_info"] = {
                "closest_m": info["closest_m"],
                "_closest_m": over,
            }
            self._numbers[over] += 1
            self._begin(np.flatnonzero(over))
            observations = games.observations(self._index)
            info |= self._info()
        return observations, rewards, ended, late & ~ended, info

    def _begin(self, games: Integers) -> None:
        arenas = self._games.arenas.indices(self._seeds, self._numbers)
        self._games.start(games, arenas[games])

    def _info(self) -> dict[str, Any]:
        everyone = np.ones(self.num_envs, np.bool_)
        return {
            "closest_m": self._games.state.closest.copy(),
            "_closest_m": everyone,
        }

    def _chosen(self, options: dict[str, Any] | None) -> Integers:
        """Return the indices of the games to begin."""
        every = np.ones(self.num_envs, np.bool_)
        flags = np.asarray((options or {}).get("reset_mask", every))
        if flags.shape != (self.num_envs,) or flags.dtype != np.bool_:
            raise PlanError(
                f"reset_mask must be {self.num_envs} booleans, got shape "
                f"{flags.shape} of {flags.dtype}"
            )
        return np.flatnonzero(flags)

    def _seeds_of(self, seed: int | Sequence[int | None] | None) -> Integers:
        """Return the seed of each game."""
        if seed is None:
            drawn = self.np_random.integers(SEEDS, size=self.num_envs)
            return drawn.astype(np.int64)
        if isinstance(seed, int | np.integer):
            self._np_random = np.random.default_rng(int(seed))
            return (int(seed) % SEEDS + np.arange(self.num_envs)) % SEEDS
        if len(seed) != self.num_envs:
            raise PlanError(
                f"there must be {self.num_envs} seeds, got {len(seed)}"
            )
        drawn = self.np_random.integers(SEEDS, size=self.num_envs)
        given = zip(drawn.tolist(), seed, strict=True)
        return np.array(
            [own if one is None else one % SEEDS for own, one in given],
            dtype=np.int64,
        )
