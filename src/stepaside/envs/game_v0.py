"""PettingZoo environment of any number of players."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from gymnasium.spaces import Box
from numpy.typing import NDArray

from ..arena import OPEN_FLOOR
from ..core.constants import CAPTURE_DISTANCE
from ..core.errors import AnyPath, ConfigurationError, check_within
from ..games.game_settings import GameSettings
from ..games.recorded_game import RecordedGame
from ..games.settings_reader import load_game
from ..strategies.knowledge import Knowledge, OtherPlayer
from ..strategies.learned import (
    FARTHEST,
    FASTEST,
    HEADINGS,
    SENSED_TERMS,
    length_unit,
    observe,
)
from .environment_settings import (
    SEEDS,
    STRIDE,
    EnvironmentSettings,
    direction_of,
    observation_space,
)
from .parallel_games import Episode, HeldIntent, ParallelGames

# Values that describe one other player: 1 if there is one, cosine and sine of
# its bearing, distance [v/k], its velocity ahead and to the left [v], 1 if it
# is an opponent, 1 if it is a teammate.
OTHER_LOW = (0.0, -1.0, -1.0, 0.0, -FASTEST, -FASTEST, 0.0, 0.0)
OTHER_HIGH = (1.0, 1.0, 1.0, FARTHEST, FASTEST, FASTEST, 1.0, 1.0)
LONGEST_WAIT = 1.0  # for the first decisions in physics, in [s]


class GameParallelEnv(ParallelGames):
    """Several players of one game; a step lasts one decision period.

    Capture of one evader ends the episode, in physics also a fall or a
    contact; the time limit truncates it. Players that do not learn follow
    their own strategies.

    Attributes:
        game: Settings of the game.
        period: Duration of a step, in [s].
    """

    def __init__(
        self,
        game: GameSettings | AnyPath,
        *,
        learners: Sequence[str] | None = None,
        period: float | None = None,
        action: str = "continuous",
        headings: int = HEADINGS,
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
            render_mode: "rgb_array" for images from above, or None.

        Raises:
            StepAsideError: If a value is invalid.
        """
        self.game = given = (
            game if isinstance(game, GameSettings) else load_game(game)
        )
        self.period = given.gait.step_duration if period is None else period
        check_within(
            self.period, 0.02, 60.0, "period", "s", ConfigurationError
        )
        choice = EnvironmentSettings(action=action, headings=headings)
        self._terms: tuple[str, ...] = ("moving",)
        if given.room is not None:
            self._terms += ("clearances",)
        own, others = observation_space(self._terms), len(given.players) - 1
        space = Box(
            np.array([*own.low, *OTHER_LOW * others], np.float32),
            np.array([*own.high, *OTHER_HIGH * others], np.float32),
        )
        names = learning_players(given, learners)
        super().__init__(names, choice, space, render_mode)

    def begin(self, seed: int, number: int) -> Episode:
        """Begin the game of seed s + 7919 n, of episode n of seed s."""
        held = {
            name: HeldIntent(direction_of(self.game.player(name).role))
            for name in self.possible_agents
        }
        settings = replace(self.game, seed=(seed + STRIDE * number) % SEEDS)
        game = RecordedGame(settings, strategies=held, recorded=False)
        game.rules = replace(game.rules, capture=CAPTURE_DISTANCE)
        room = settings.room or OPEN_FLOOR
        return Episode(
            game, held, room, period=self.period, patience=LONGEST_WAIT
        )

    def observe(self, episode: Episode, name: str) -> NDArray[np.float32]:
        """Return own terms, then those of the others, the nearest first.

        Values of players that it has not seen are zero.
        """
        known = episode.knowledge(name)
        width = sum(SENSED_TERMS[term].width for term in self._terms)
        others = np.zeros((len(self.game.players) - 1, len(OTHER_LOW)))
        own = np.zeros(width, np.float32)
        if known is not None:
            own = observe(known, self._terms)
            seen = sorted(known.others, key=lambda other: other.distance)
            for row, other in zip(others, seen, strict=False):
                row[:] = _describe(known, other)
        return np.concatenate([own, others.ravel().astype(np.float32)])

    def unit(self, episode: Episode, name: str) -> float:
        """Return the unit of length of a player, v/k, in [m]."""
        gait = self.game.player(name).gait
        return gait.speed / gait.gain

    def info(self, episode: Episode) -> dict[str, Any]:
        """Return closest approaches [m] by evader, time [s] and outcome."""
        return {
            "closest_m": episode.closest,
            "time_s": episode.time,
            "outcome": episode.ended,
        }


def learning_players(
    game: GameSettings, learners: Sequence[str] | None
) -> tuple[str, ...]:
    """Return the names of the players that learn: by default all that can."""
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
    if not {"pursuer", "evader"} <= {p.role for p in game.players}:
        raise ConfigurationError(
            "game must have an evader and a pursuer, got roles "
            f"{', '.join(sorted({p.role for p in game.players}))}"
        )
    return tuple(chosen)


def _describe(known: Knowledge, other: OtherPlayer) -> list[float]:
    """Return the values of one other player."""
    limits, own = known.limits, known.identity
    assert own is not None
    # Velocities are sensed in gait time; the speed is that of path time.
    pace = limits.step_duration * limits.speed / limits.stride
    velocity = [
        min(max(v * pace / limits.speed, -FASTEST), FASTEST)
        for v in other.velocity or (0.0, 0.0)
    ]
    return [
        1.0,
        np.cos(other.bearing),
        np.sin(other.bearing),
        min(other.distance / length_unit(limits), FARTHEST),
        *velocity,
        float(own.opposes(other.identity)),
        float(own.is_with(other.identity)),
    ]


def parallel_env(
    game: GameSettings | AnyPath, **settings: Any
) -> GameParallelEnv:
    """Build the environment; see :class:`GameParallelEnv`."""
    return GameParallelEnv(game, **settings)
