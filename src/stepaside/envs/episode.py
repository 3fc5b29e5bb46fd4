"""One episode of an environment, at any level."""

from collections.abc import Generator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.errors import PlanError
from ..games.duel_settings import PLAYERS
from ..locomotion.policy.network_pool import NetworkPool
from ..report.palette import colours_in
from ..strategies.knowledge import Intent
from ..strategies.learned.observation_terms import (
    FARTHEST,
    FULL_STATE_TERMS,
    SENSED_TERMS,
    length_unit,
    observe,
)
from ..strategies.strategy import Strategy
from .arena_pool import STRIDE, ArenaPool
from .distance_reward import DistanceReward
from .environment_settings import (
    EnvironmentSettings,
    check_choice,
)
from .template_duel import EnvironmentGame, TemplateDuel

SEEDS = 2**31
Pair = tuple[Strategy | None, Strategy | None]


class EnvironmentEpisode:
    """Game of an environment with its rewards.

    Attributes:
        game: The game.
        paths: Positions of pursuer and evader so far, if images are drawn.
        terminated: Whether the game ended.
        truncated: Whether the time is up.
    """

    def __init__(
        self,
        game: EnvironmentGame,
        settings: EnvironmentSettings,
        *,
        images: bool,
    ) -> None:
        """Begin an episode.

        Args:
            game: The game.
            settings: Settings of the environment.
            images: Whether images will be drawn.
        """
        self.game, self._settings = game, settings
        self._images = images
        self.paths: tuple[list[Any], list[Any]] = ([], [])
        known = next(known for known in game.knowledge if known is not None)
        self._unit = length_unit(known.limits)
        self._reward = DistanceReward(
            self._unit, settings.shaping, settings.discount
        )
        self.terminated = self.truncated = False
        self._note()

    @property
    def over(self) -> bool:
        """Whether the episode is over."""
        return self.terminated or self.truncated

    def step(
        self, intents: Sequence[Intent | None]
    ) -> Generator[None, None, float]:
        """Play one decision and return the reward of the evader.

        Yields whenever networks of robots have to be evaluated.
        """
        game = self.game
        closest, distance = game.closest, game.distance
        yield from game.step(intents)
        self.terminated = bool(game.ended)
        self.truncated = game.truncated and not self.terminated
        self._note()
        return self._reward.evader(
            (closest, game.closest),
            (distance, game.distance),
            float(self.terminated),
        )

    def observation(self, player: int) -> NDArray[np.float32]:
        """Return the observation of a player, 0 or 1."""
        known = self.game.knowledge[player]
        assert known is not None
        sensed = [n for n in self._settings.terms if n in SENSED_TERMS]
        values = observe(known, sensed)
        if not self._settings.full_state:
            return values
        full = [v for n in FULL_STATE_TERMS for v in self._full(n, player)]
        return np.concatenate([values, np.array(full, dtype=np.float32)])

    def info(self) -> dict[str, Any]:
        """Return what an environment says besides the observation."""
        game = self.game
        return {
            "closest_m": game.closest,
            "distance_m": game.distance,
            "time_s": game.time,
            "outcome": game.ended,
        }

    def close(self) -> None:
        """Release the resources of the game."""
        self.game.close()

    def _full(self, name: str, player: int) -> Sequence[float]:
        """Return the values of a term that no sense gives."""
        if name == "closest":
            return (min(self.game.closest / self._unit, FARTHEST),)
        if name == "remaining":
            return (max(0.0, 1.0 - self.game.time / self._settings.duration),)
        other = self.game.knowledge[1 - player]
        assert other is not None
        return np.cos(other.bearing), np.sin(other.bearing)

    def _note(self) -> None:
        if self._images:
            for path, pose in zip(self.paths, self.game.poses, strict=True):
                path.append(pose[:2])


class EpisodeSource:
    """Begins the episodes of an environment.

    Attributes:
        settings: Settings of the environment.
        networks: Networks of robots on learned legs.
    """

    def __init__(
        self,
        settings: EnvironmentSettings,
        strategies: Pair,
        *,
        images: bool,
        networks: NetworkPool | None = None,
    ) -> None:
        """Draw the arenas.

        Args:
            settings: Settings of the environment.
            strategies: Strategies of pursuer and evader; None for a player
                that is controlled from outside.
            images: Whether images will be drawn.
            networks: Networks of learned legs, shared with other sources.

        Raises:
            ConfigurationError: If the settings are invalid.
        """
        self.settings, self._strategies = settings, strategies
        self._images = images
        self.networks = networks or NetworkPool()
        self._page: Any = None
        self._pool: ArenaPool | None = None
        if settings.level != "physics":
            self._pool = settings.draw_arenas()

    def begin(self, seed: int, number: int) -> EnvironmentEpisode:
        """Begin an episode.

        Args:
            seed: Seed of the environment.
            number: Number of the episode since it was seeded.
        """
        return EnvironmentEpisode(
            self._game(seed, number), self.settings, images=self._images
        )

    def _game(self, seed: int, number: int) -> EnvironmentGame:
        settings, pool = self.settings, self._pool
        if pool is not None:
            index = int(pool.indices([seed], [number])[0])
            arena = pool.rooms[index], pool.starts[index]
            return TemplateDuel(settings.step_game, arena, self._strategies)
        from .physics_duel import PhysicsDuel

        duel = replace(
            settings.duel,
            seed=(settings.first_arena + seed + STRIDE * number) % SEEDS,
            duration=settings.duration,
        )
        game: EnvironmentGame = PhysicsDuel(
            duel, self._strategies, networks=self.networks
        )
        return game

    def play(self, step: Generator[None, None, float]) -> float:
        """Play a step of an episode alone, and return its reward.

        Args:
            step: Of :meth:`EnvironmentEpisode.step`.
        """
        while True:
            try:
                next(step)
            except StopIteration as end:
                return float(end.value)
            self.networks.flush()

    def show(
        self, episode: EnvironmentEpisode | None, mode: str | None
    ) -> Any:
        """Return an image of an episode, or show it on a page.

        Args:
            episode: The episode.
            mode: "rgb_array" or "human"; None does nothing.

        Raises:
            PlanError: If there is no episode.
        """
        if mode is None:
            return None
        if episode is None:
            raise PlanError("reset the environment first: nothing to render")
        from .top_view import ImagePage, draw_top_view

        game = episode.game
        colours = [*colours_in("light", PLAYERS).values()]
        image = draw_top_view(game.room, game.poses, episode.paths, colours)
        if mode == "rgb_array":
            return image
        if self._page is None:
            self._page = ImagePage()
        self._page.show(image, episode.info())
        return None


def check_render_mode(mode: str | None, metadata: dict[str, Any]) -> None:
    """Raise an error unless images can be rendered in a mode.

    Raises:
        ConfigurationError: If they cannot.
    """
    if mode is not None:
        check_choice(mode, tuple(metadata["render_modes"]), "render_mode")
