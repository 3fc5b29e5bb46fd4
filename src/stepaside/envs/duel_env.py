"""Gymnasium environments of one player of a duel: a game, and many."""

from collections.abc import Sequence
from math import ceil, floor, pi
from typing import Any, ClassVar

import gymnasium
import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from ..arena.obstacles import ObstacleSet
from ..arena.shortest_path import path_corners
from ..core.errors import (
    ConfigurationError,
    PlanError,
    check_choice,
    check_within,
    shown,
)
from ..games.floor_games import MARGIN, with_body_radius
from ..games.floor_world import PARTS
from ..games.player_settings import PLAYERS
from ..strategies.evasion import Evasion
from ..strategies.knowledge import limits_of
from ..strategies.learned import LearnedStrategy
from ..strategies.pursuit import FREE_STRIDES, Pursuit
from ..strategies.registry import load_strategy
from ..strategies.strategy import StandStill, Strategy
from .environment_settings import (
    ALL_TERMS,
    SEEDS,
    STRIDE,
    EnvironmentSettings,
    direction_of,
    observation_space,
)
from .parallel_games import ParallelDuel, Row
from .step_batch import (
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
Integers = NDArray[np.int64]
USUAL = {"evader": "pursuit", "pursuer": "evasion"}  # opponent of a role


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


class DuelEnv(gymnasium.Env[Row, Any]):
    """One player against a strategy; a step is one decision.

    Observation, action, reward, end and ``info`` are those of
    :class:`.ParallelDuel`.

    Attributes:
        role: "pursuer" or "evader".
        settings: Settings of the environment.
    """

    metadata: ClassVar = ParallelDuel.metadata  # type: ignore[misc]

    def __init__(
        self,
        role: str,
        *,
        opponent: str | Strategy | None = None,
        render_mode: str | None = None,
        **settings: Any,
    ) -> None:
        """Build the environment, with fields of :class:`.EnvironmentSettings`.

        The opponent is the name of a strategy, FILE.py:NAME, FILE.onnx or a
        strategy; by default that of the paper.
        """
        opponents = load_opponent(opponent, role)
        self._both = ParallelDuel(
            render_mode=render_mode, opponents=opponents, **settings
        )
        self.role, self.render_mode = role, render_mode
        self.settings = self._both.settings
        self.action_space = self._both.action_space(role)
        self.observation_space: Any = self._both.observation_space(role)

    def reset(
        self,
        *,
        seed: int | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[Row, dict[str, Any]]:
        """Begin the next episode of a seed; options are not used."""
        super().reset(seed=seed)
        observations, infos = self._both.reset(seed)
        return observations[self.role], infos[self.role]

    def step(
        self, action: Any
    ) -> tuple[Row, float, bool, bool, dict[str, Any]]:
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


def rules_of(settings: EnvironmentSettings) -> BatchRules:
    """Return the rules of an environment as numbers, in path time."""
    game, own = settings.game, settings.duel.evader
    parts, limits = PARTS[settings.level], limits_of(own.gait)
    if pi * limits.share / parts > LARGEST_TURN:
        raise ConfigurationError(
            "turns of duel.evader.gait must be at most "
            f"{LARGEST_TURN * parts:g} [rad] for many games, got "
            f"{pi * limits.share:g}"
        )
    if limits.outer_stride or limits != limits_of(game.pursuer.gait):
        raise ConfigurationError(
            "gaits of duel must be equal, without outer_stride, for many games"
        )
    return BatchRules(
        limits.stride / parts,
        limits.share,
        float(parts),
        own.gait.path_interval / parts,
        limits.speed,
        limits.gain,
        game.capture,
        (game.pursuer.radius + MARGIN, own.radius + MARGIN),
        round(game.duration / settings.period),
        # Of strategies.opponent_track, in decisions.
        floor(2.25 * parts + 1e-9),
        ceil(0.75 * parts + 1e-9),
    )


def law_of(strategy: Strategy, stride: float) -> BatchLaw:
    """Return the law of a strategy as numbers, if the kernel knows it.

    Strides are in [m].
    """
    if isinstance(strategy, Pursuit):
        more = strategy.pull, strategy.lead, strategy.noise, strategy.waiting
        if not any(more):
            ahead = FREE_STRIDES * stride
            return BatchLaw(strategy.gain, strategy.body_radius, ahead)
    if type(strategy) is Evasion and strategy.trigger != "time":
        return BatchLaw(
            angle=strategy.angle,
            safety_radius=strategy.safety_radius,
            release=strategy.release_distance,
            hysteresis=strategy.side_hysteresis,
        )
    if type(strategy) is StandStill:
        return BatchLaw()  # it evades at no distance
    raise ConfigurationError(
        "opponent of many games must be evasion with the trigger distance, "
        "pursuit of any gain, sharp, stand or FILE.onnx, got a "
        f"{type(strategy).__name__}; others play in vectorization_mode "
        "'sync' or 'async'"
    )


def pack_rooms(rooms: Sequence[ObstacleSet], radius: float) -> RoomBatch:
    """Return the obstacles of rooms, and corners that a radius [m] keeps."""
    whole = ObstacleSet(tuple(solid for room in rooms for solid in room))
    corners = [path_corners(room, radius) for room in rooms]
    firsts, first_corners = (
        np.cumsum([0, *map(len, each)]) for each in (rooms, corners)
    )
    return RoomBatch(
        whole.packed, firsts, np.concatenate(corners), first_corners
    )


def codes_of(terms: Sequence[str]) -> Integers:
    """Return the codes of terms for the kernel."""
    return np.array([TERM_CODES[name] for name in terms], dtype=np.int64)


class VectorDuel(VectorEnv[Row, Any, Any]):
    """Many games of :class:`.DuelEnv`, without Python per game.

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
        """Build so many games, with fields of :class:`.EnvironmentSettings`.

        The opponent is evasion, pursuit of any gain, sharp, stand, FILE.onnx,
        or such a strategy; many games are not drawn.
        """
        (strategy,) = load_opponent(opponent, role).values()
        if render_mode is not None:
            raise ConfigurationError(
                "render_mode must be None for many games, got "
                f"{render_mode!r:.40}"
            )
        self.role, self.settings = role, EnvironmentSettings(**settings)
        given, error = self.settings, ConfigurationError
        if given.level == "physics":
            raise error(
                "level must be unicycle or steps for compiled games, got "
                "physics, which plays in vectorization_mode 'sync' or 'async'"
            )
        check_within(num_envs, 1, 1_000_000, "num_envs", "1", error)
        self.num_envs = number = int(num_envs)
        self._own, self._other = (0, 1) if role == "pursuer" else (1, 0)
        self._rules = rules = rules_of(given)
        strategy = with_body_radius(strategy, rules.radii[self._other])
        self._opponent = (
            strategy
            if isinstance(strategy, LearnedStrategy)
            else law_of(strategy, given.duel.evader.gait.stride)
        )
        self._saturated = np.zeros(2, np.bool_)
        self._saturated[self._other] = strategy.saturated
        rooms, starts = given.draw_arenas()
        law = self._opponent
        reach = law.radius if isinstance(law, BatchLaw) else 0.0
        self._rooms = pack_rooms([room.solid_set for room in rooms], reach)
        x, y, heading = np.moveaxis(np.array(starts, np.float64), -1, 0)
        axes = x, y, np.cos(heading), np.sin(heading)
        self._starts = np.stack(axes, axis=-1)
        history = 1 << rules.lag.bit_length()  # above lag, a power of two
        self._state = BatchState(
            np.zeros((number, 2, 4)),
            np.zeros((number, history, 3)),
            np.zeros(number, np.int64),
            np.zeros((number, 2), np.int64),
            np.zeros((number, 2), np.bool_),
            np.zeros(number),
            np.zeros(number, np.int64),
            np.zeros(number, np.bool_),
        )
        self._intents = np.zeros((number, 2, 2))
        self._seeds: Integers | None = None  # of the present episodes
        self.single_action_space = given.action_space()
        self.single_observation_space = observation_space(given.terms)
        self.action_space = batch_space(self.single_action_space, number)
        self.observation_space = batch_space(
            self.single_observation_space, number
        )

    def reset(
        self,
        *,
        seed: int | Sequence[int | None] | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[Row, dict[str, Any]]:
        """Begin an episode of all games; options are not used.

        An integer as seed gives game i that many plus i; None continues with
        the next episodes. The seed of a game is drawn if it is None.
        """
        number = self.num_envs
        if isinstance(seed, int | np.integer):
            seed = [int(seed) + i for i in range(number)]
        if seed is not None:
            if len(seed) != number:
                raise PlanError(
                    f"there must be {number} seeds, got {len(seed)}"
                )
            drawn = self.np_random.integers(SEEDS, size=number).tolist()
            given = zip(seed, drawn, strict=True)
            self._seeds = np.array(
                [new if one is None else one % SEEDS for one, new in given]
            )
        elif self._seeds is None:
            self._seeds = self.np_random.integers(SEEDS, size=number)
        else:
            self._seeds += STRIDE
        self._begin(np.arange(number))
        return self._observed(), self._info()

    def step(self, actions: Any) -> tuple[Row, Any, Any, Any, dict[str, Any]]:
        """Play one decision of all games.

        Raises:
            PlanError: If the actions are invalid, or nothing was reset.
        """
        if self._seeds is None:
            raise PlanError("reset the environment first: no episode is on")
        rows = self.settings.intents(actions)
        state, rules = self._state, self._rules
        if len(rows) != self.num_envs:
            raise PlanError(
                f"there must be {self.num_envs} actions, got {len(rows)}"
            )
        closest, opponent = state.closest.copy(), self._opponent
        self._intents[:, self._own] = rows
        others = self._intents[:, self._other]
        if isinstance(opponent, LearnedStrategy):
            seen = self._seen(self._other, opponent.contract.terms)
            others[:] = opponent.intents(seen)
        else:
            rooms, other = self._rooms, self._other
            decide_by_law(state, other, opponent, rooms, rules, others)
        advance_games(
            state, self._intents, self._saturated, self._rooms, rules
        )
        ended = state.ended.copy()
        late = state.decisions >= rules.limit
        sign = 1.0 if self.role == "evader" else -1.0
        rewards = (state.closest - closest) * (sign * rules.gain / rules.speed)
        over, info, observations = ended | late, self._info(), self._observed()
        if over.any():
            info["final_obs"], info["_final_obs"] = observations, over
            closest = info["closest_m"]
            info["final_info"] = {"closest_m": closest, "_closest_m": over}
            self._seeds[over] += STRIDE
            self._begin(np.flatnonzero(over))
            observations = self._observed()
            info |= self._info()
        return observations, rewards, ended, late & ~ended, info

    def _begin(self, games: Integers) -> None:
        """Begin an episode of some games, by their seeds."""
        assert self._seeds is not None
        arenas = self._seeds[games] % len(self._starts)
        self._state.rooms[games] = arenas
        start_games(self._state, games, self._starts[arenas])

    def _info(self) -> dict[str, Any]:
        everyone = np.ones(self.num_envs, np.bool_)
        closest = self._state.closest.copy()
        return {"closest_m": closest, "_closest_m": everyone}

    def _observed(self) -> Row:
        return self._seen(self._own, self.settings.terms)

    def _seen(self, player: int, terms: Sequence[str]) -> Row:
        """Return the observations of player 0 or 1. Shape (n, width)."""
        width = sum(ALL_TERMS[name].width for name in terms)
        out = np.empty((self.num_envs, width), np.float32)
        state, rooms, rules = self._state, self._rooms, self._rules
        observe_games(state, player, codes_of(terms), rooms, rules, out)
        return out
