"""PettingZoo environment of any number of players."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, ClassVar

import numpy as np
from gymnasium.spaces import Box, Space
from numpy.typing import NDArray
from pettingzoo import ParallelEnv

from ..core.errors import (
    AnyPath,
    ConfigurationError,
    PlanError,
    check_within,
)
from ..games.game_file import load_game
from ..games.game_settings import GameSettings
from ..report.palette import colours_in
from ..strategies.learned.observation_terms import (
    FARTHEST,
    FASTEST,
    SENSED_TERMS,
)
from .arena_pool import STRIDE
from .environment_settings import EnvironmentSettings
from .episode import SEEDS, check_render_mode
from .intent_actions import IntentActions
from .several_players import OTHER_WIDTH, SeveralPlayers, own_terms
from .top_view import ImagePage, draw_top_view

Observations = dict[str, NDArray[np.float32]]
Infos = dict[str, dict[str, Any]]
OTHER_LOW = (0.0, -1.0, -1.0, 0.0, -FASTEST, -FASTEST, 0.0, 0.0)
OTHER_HIGH = (1.0, 1.0, 1.0, FARTHEST, FASTEST, FASTEST, 1.0, 1.0)


class GameParallelEnv(ParallelEnv[str, NDArray[np.float32], Any]):
    """Several players of one game; a step lasts one decision period.

    The reward of an evader is the change of its closest approach to any
    pursuer so far (without pursuers, to any other player), in units of v/k of
    its gait, that of a pursuer the negative mean of those of all evaders.
    Capture of one evader ends the episode, in physics also a fall or a
    contact; the time limit truncates it. Players that do not learn follow
    their own strategies.

    Attributes:
        game: Settings of the game.
        period: Duration of a step, in [s].
        possible_agents: Names of the players that learn.
        agents: The same during an episode, else empty.
        render_mode: "rgb_array", "human" or None.
    """

    metadata: ClassVar[dict[str, Any]] = {
        "name": "stepaside_game_v0",
        "render_modes": ["human", "rgb_array"],
        "render_fps": 10,
        "is_parallelizable": True,
    }

    def __init__(
        self,
        game: GameSettings | AnyPath,
        *,
        learners: Sequence[str] | None = None,
        period: float | None = None,
        action: str = "continuous",
        headings: int | None = None,
        render_mode: str | None = None,
    ) -> None:
        """Build the environment.

        Args:
            game: Settings of a game, or a game file.
            learners: Names of the players that learn; by default all robots
                and unicycles that are pursuers or evaders.
            period: Duration of a step, in [s]; by default the step duration
                of the slowest gait.
            action: "continuous" (heading and speed factor) or "discrete".
            headings: Number of headings of discrete actions.
            render_mode: "rgb_array" for images from above, "human" for a
                page with them, or None.

        Raises:
            StepAsideError: If a value is invalid.
        """
        check_render_mode(render_mode, self.metadata)
        self.render_mode = render_mode
        self.game = game if isinstance(game, GameSettings) else load_game(game)
        self.possible_agents = list(learning_players(self.game, learners))
        self.period = (
            self.game.gait.step_duration if period is None else period
        )
        check_within(
            self.period, 0.02, 60.0, "period", "s", ConfigurationError
        )
        choice = EnvironmentSettings(action=action)
        if headings is not None:
            choice = replace(choice, headings=headings)
        self._actions = {
            n: IntentActions(choice) for n in self.possible_agents
        }
        space = observation_space_of(self.game)
        self._observed = {n: Box(space.low, space.high) for n in self._actions}
        self.agents: list[str] = []
        self._random = np.random.default_rng()
        self._seed: int | None = None
        self._number = 0
        self._played: SeveralPlayers | None = None
        self._paths: dict[str, list[Any]] = {}
        self._page: ImagePage | None = None

    def observation_space(self, agent: str) -> Space[Any]:
        """Return the space of observations of an agent, always the same."""
        return self._observed[agent]

    def action_space(self, agent: str) -> Space[Any]:
        """Return the space of actions of an agent, always the same."""
        return self._actions[agent].space

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observations, Infos]:
        """Begin the next episode of a seed.

        Episode n of seed s is the game of seed s + 7919 n.

        Args:
            seed: Seed; None continues with the next episode.
            options: Not used.
        """
        if seed is not None or self._seed is None:
            drawn = int(self._random.integers(SEEDS))
            self._seed, self._number = drawn if seed is None else seed, 0
        else:
            self._number += 1
        self.close()
        game = replace(
            self.game, seed=(self._seed + STRIDE * self._number) % SEEDS
        )
        self._played = SeveralPlayers(game, tuple(self.possible_agents))
        self.agents = list(self.possible_agents)
        self._paths = {name: [] for name in self.game.names}
        self._note()
        return self._observations(), self._infos()

    def step(
        self, actions: dict[str, Any]
    ) -> tuple[
        Observations,
        dict[str, float],
        dict[str, bool],
        dict[str, bool],
        Infos,
    ]:
        """Play one decision period.

        Args:
            actions: Action of each agent.

        Raises:
            PlanError: If an action is missing or invalid, or the episode is
                over.
        """
        played, names = self._played, self.possible_agents
        if played is None or not self.agents:
            raise PlanError("reset the environment first: no episode is on")
        missing = [name for name in names if name not in actions]
        if missing:
            raise PlanError(
                f"actions must have one of {missing[0]}, got those of "
                f"{', '.join(actions) or 'no agent'}"
            )
        intents = {n: self._actions[n].intent(actions[n]) for n in names}
        before = dict(played.closest)
        played.play(intents, self.period)
        self._note()
        changes = {n: played.closest[n] - before[n] for n in before}
        late = played.time >= self.game.duration - 1e-9 and not played.ended
        result = (
            self._observations(),
            {n: self._reward(n, changes) / played.unit[n] for n in names},
            dict.fromkeys(names, bool(played.ended)),
            dict.fromkeys(names, late),
            self._infos(),
        )
        if played.ended or late:
            self.agents = []
        return result

    def render(self) -> Any:
        """Return an image from above; None in mode "human"."""
        if self.render_mode is None:
            return None
        if self._played is None:
            raise PlanError("reset the environment first: nothing to render")
        poses = self._played.poses
        image = draw_top_view(
            self._played.room,
            list(poses.values()),
            [self._paths[name] for name in poses],
            [*colours_in("light", poses, self.game.identities).values()],
        )
        if self.render_mode == "rgb_array":
            return image
        if self._page is None:
            self._page = ImagePage()
        self._page.show(image, {"time_s": self._played.time})
        return None

    def close(self) -> None:
        """End the episode and release its resources."""
        if self._played is not None:
            self._played.close()
            self._played = None

    def _reward(self, name: str, changes: dict[str, float]) -> float:
        """Return the reward of a player, in [m]."""
        if name in changes:
            return changes[name]
        return -sum(changes.values()) / len(changes)

    def _observations(self) -> Observations:
        assert self._played is not None
        return {n: self._played.observation(n) for n in self.possible_agents}

    def _infos(self) -> Infos:
        assert self._played is not None
        played = self._played
        info = {
            "closest_m": dict(played.closest),
            "time_s": played.time,
            "outcome": played.ended,
        }
        return {name: dict(info) for name in self.possible_agents}

    def _note(self) -> None:
        if self.render_mode is not None and self._played is not None:
            for name, pose in self._played.poses.items():
                self._paths[name].append(pose[:2])


def learning_players(
    game: GameSettings, learners: Sequence[str] | None
) -> tuple[str, ...]:
    """Return the names of the players that learn.

    Args:
        game: Settings of the game.
        learners: Their names; None for all that can.

    Raises:
        ConfigurationError: If one cannot, or the game has no evader.
    """
    able = [
        p.name
        for p in game.players
        if p.decides and p.role in ("pursuer", "evader")
    ]
    chosen = able if learners is None else list(learners)
    wrong = [name for name in chosen if name not in able]
    if wrong or not chosen:
        raise ConfigurationError(
            "learners must be robots or unicycles that are pursuers or "
            f"evaders ({', '.join(able) or 'there are none'}), got "
            f"{wrong[0] if wrong else 'none'}"
        )
    if len(set(chosen)) < len(chosen):
        raise ConfigurationError(
            f"learners must differ, got {', '.join(chosen)}"
        )
    if all(p.role != "evader" for p in game.players):
        raise ConfigurationError(
            "game must have an evader, got roles "
            f"{', '.join(sorted({p.role for p in game.players}))}"
        )
    return tuple(chosen)


def observation_space_of(game: GameSettings) -> Box:
    """Return the space of observations of a player of a game."""
    own = [SENSED_TERMS[name] for name in own_terms(game)]
    low = [t.low for t in own for _ in range(t.width)]
    high = [t.high for t in own for _ in range(t.width)]
    others = len(game.players) - 1
    assert len(OTHER_LOW) == len(OTHER_HIGH) == OTHER_WIDTH
    return Box(
        np.array([*low, *OTHER_LOW * others], np.float32),
        np.array([*high, *OTHER_HIGH * others], np.float32),
    )


def parallel_env(
    game: GameSettings | AnyPath, **settings: Any
) -> GameParallelEnv:
    """Build the environment; see :class:`GameParallelEnv`.

    Args:
        game: Settings of a game, or a game file.
        settings: Further arguments of :class:`GameParallelEnv`.
    """
    return GameParallelEnv(game, **settings)
