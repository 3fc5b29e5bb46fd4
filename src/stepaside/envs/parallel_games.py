"""PettingZoo environments: of a duel, and of any number of players."""

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import atan2, cos, inf, sin
from typing import Any, ClassVar

import numpy as np
from gymnasium.spaces import Box, Space
from numpy.typing import NDArray
from pettingzoo import ParallelEnv

from ..arena import Room
from ..core.constants import CAPTURE_DISTANCE
from ..core.errors import (
    AnyPath,
    ConfigurationError,
    PlanError,
    StrategyError,
    check_choice,
)
from ..games.floor_games import floor_of, rules_of
from ..games.game import GameInPlay, Outcome
from ..games.game_settings import GameSettings
from ..games.player_settings import PLAYERS
from ..games.recorded_game import RecordedGame
from ..games.settings_reader import load_game
from ..locomotion.maneuver_walk import RETRY_PERIOD
from ..strategies.knowledge import STAND, Intent, Knowledge, OtherPlayer
from ..strategies.learned import (
    FARTHEST,
    FASTEST,
    HEADINGS,
    length_unit,
    observe,
)
from ..strategies.strategy import Strategy
from .environment_settings import (
    SEEDS,
    STRIDE,
    EnvironmentSettings,
    box,
    direction_of,
    observation_space,
)

Row = NDArray[np.float32]
REACH = 2.0  # least half width of an image, in [m]
BODY = 0.4  # length of a player in an image, in [m]
# Values that describe one other player: 1 if there is one, cosine and sine of
# its bearing, distance [v/k], its velocity ahead and to the left [v], 1 if it
# is an opponent, 1 if it is a teammate.
OTHER_LOW = (0.0, -1.0, -1.0, 0.0, -FASTEST, -FASTEST, 0.0, 0.0)
OTHER_HIGH = (1.0, 1.0, 1.0, FARTHEST, FASTEST, FASTEST, 1.0, 1.0)


class HeldIntent:
    """Strategy that returns the intent that it holds.

    It is not pure: the intent is replaced from outside, between decisions.
    """

    saturated = False

    def __init__(self, role: str) -> None:
        self.direction = direction_of(role)
        self.intent = STAND

    def begin(self) -> None:
        """Return no memory."""

    def decide(
        self, knowledge: Knowledge, memory: None
    ) -> tuple[Intent, None]:
        """Return the intent."""
        return self.intent, None


class ParallelGames(ParallelEnv[str, Row, Any]):
    """Players of a game act at the same time.

    A step lasts until the next decision of a learner that walks: when a foot
    has landed, at level "unicycle" an eighth of a step. Who stands decides
    then, too; while all stand, a step lasts a period. The observation of a
    player is that for its decision, and its action decides.

    The reward of an evader is the change of its closest approach so far, in
    units of v/k, zero or negative; contact with an obstacle counts as a
    closest approach of zero. So its return is the closest approach of the
    episode less the initial distance: what
    :mod:`stepaside.theory.value.two_cars` bounds. A pursuer has the negative
    mean of those of all evaders.

    The agents are the players that learn, by name, and ``known`` is their
    knowledge for their decisions, once they see; ``render_mode`` is
    "rgb_array", for images from above, or None.
    """

    metadata: ClassVar[dict[str, Any]] = {
        "name": "stepaside_game_v0",
        "render_modes": ["rgb_array"],
        "render_fps": 10,
        "is_parallelizable": True,
    }
    period: float  # of a step while all stand [s]
    patience: float  # for the first decisions in physics [s]

    def __init__(
        self,
        roles: Mapping[str, str],
        units: Mapping[str, float],
        choice: EnvironmentSettings,
        space: Box,
        render_mode: str | None,
    ) -> None:
        """Take role and unit of length, v/k [m], of each learning player."""
        if render_mode is not None:
            modes = tuple(self.metadata["render_modes"])
            check_choice(render_mode, modes, "render_mode")
        self.render_mode = render_mode
        self.possible_agents, self.agents = list(roles), list[str]()
        self._roles, self._units = roles, units
        self._choice = choice
        self._actions = {name: choice.action_space() for name in roles}
        self._observed = {name: box(space.low, space.high) for name in roles}
        self._seed: int | None = None
        self._game: GameInPlay | None = None

    @abstractmethod
    def begin(
        self, seed: int, held: Mapping[str, HeldIntent]
    ) -> tuple[GameInPlay, Room | None]:
        """Return the game of an episode, and its room."""

    @abstractmethod
    def observe(self, name: str) -> Row:
        """Return the observation of a player."""

    def info(self) -> dict[str, Any]:
        """Return closest approaches [m] by evader, time [s] and outcome."""
        return {
            "closest_m": dict(self.closest),
            "time_s": self.game.world.time,
            "outcome": self.outcome,
        }

    def observation_space(self, agent: str) -> Space[Any]:
        """Return the space of observations of an agent, always the same."""
        return self._observed[agent]

    def action_space(self, agent: str) -> Space[Any]:
        """Return the space of actions of an agent, always the same."""
        return self._actions[agent]

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, Row], dict[str, dict[str, Any]]]:
        """Begin an episode of a seed, 0 or above, or the next one of the last.

        Options are not used.
        """
        if seed is not None:
            self._seed = seed % SEEDS
        elif self._seed is None:
            self._seed = int(np.random.default_rng().integers(SEEDS))
        else:
            self._seed += STRIDE
        self.close()
        self._held = {n: HeldIntent(role) for n, role in self._roles.items()}
        self._game, self._room = self.begin(self._seed, self._held)
        game = self.game
        self.known = self._due()
        while len(self.known) < len(self._held) and not (
            game.ended or game.world.time > self.patience
        ):
            game.tick()
            self.known |= self._due()
        self.agents = list(self.possible_agents)
        return self._look()

    @property
    def game(self) -> GameInPlay:
        """Game of the episode."""
        if self._game is None:
            raise PlanError("reset the environment first: no episode is on")
        return self._game

    def _due(self) -> dict[str, Knowledge]:
        """Return what learners know for decisions that are due."""
        game = self.game
        return game.world.due(self._held, ended=game.ended is not None)

    def _asks(self, name: str, known: Knowledge) -> bool:
        """Return whether a step ends for a decision that is due.

        It does for one that walks, or has been kept from starting.
        """
        passed = known.time - self.known[name].time
        kept = passed > RETRY_PERIOD - 1e-9 and self._held[name].intent.walks
        return known.moving or kept

    def step(
        self, actions: Mapping[str, Any]
    ) -> tuple[
        dict[str, Row],
        dict[str, float],
        dict[str, bool],
        dict[str, bool],
        dict[str, dict[str, Any]],
    ]:
        """Play until the next decision, by the action of each agent.

        Raises:
            PlanError: If an action is missing or invalid, or no episode on.
        """
        game, names = self.game, self.possible_agents
        if not self.agents:
            raise PlanError("reset the environment first: no episode is on")
        for name in names:
            if name not in actions:
                raise PlanError(
                    f"actions must have one of the {name}, got those of "
                    f"{', '.join(actions) or 'no agent'}"
                )
            heading, speed = self._choice.intents([actions[name]])[0].tolist()
            self._held[name].intent = Intent(heading, speed)
        before, begun, over = self.closest, game.world.time, False
        while not (over or game.ended):
            game.tick(begun + self.period)
            due, world = self._due(), game.world
            late = world.time - begun > self.period - 1e-9
            over = any(self._asks(*each) for each in due.items()) or (
                late and not any(map(world.is_moving, names))
            )
        self.known |= due
        if game.ended:
            self.agents = []
        observations, infos = self._look()
        gains = {n: now - before[n] for n, now in self.closest.items()}
        taken = -sum(gains.values()) / len(gains)  # by each pursuer
        return (
            observations,
            {n: gains.get(n, taken) / self._units[n] for n in names},
            dict.fromkeys(names, bool(self.outcome)),
            dict.fromkeys(names, self._is_late),
            infos,
        )

    def _look(self) -> tuple[dict[str, Row], dict[str, dict[str, Any]]]:
        names, self.closest = self.possible_agents, self._approaches()
        observations = {name: self.observe(name) for name in names}
        return observations, {name: self.info() for name in names}

    @property
    def _is_late(self) -> bool:
        """Whether the time is up."""
        late = self.game.world.time >= self.game.rules.duration - 1e-9
        return late and self.game.outcome is Outcome.COMPLETED

    @property
    def outcome(self) -> str:
        """Outcome in one word; empty while it goes on, or if truncated."""
        return "" if self._is_late else str(self.game.outcome or "")

    def _approaches(self) -> dict[str, float]:
        """Return the closest approach of each evader so far, in [m], by name.

        It is 0 after a fall, or contact with anything but an opponent.
        """
        game, ids = self.game, self.game.rules.identities
        found: dict[str, float] = {}
        for (name, _), apart in game.closest.items():
            found[name] = min(found.get(name, inf), apart)
        if game.ended is None:
            return found
        touched = set(game.touched) & ids.keys()
        for name in found:
            met = any(ids[name].opposes(ids[other]) for other in touched)
            if name in game.fallen or (name in touched and not met):
                found[name] = 0.0
        return found

    def state(self) -> Row:
        """Return the poses (x [m], y [m], heading [rad]) of all players."""
        poses = self.game.world.states()
        return np.array([*poses.values()], np.float32).ravel()

    def render(self) -> Any:
        """Return an image from above, shape (400, 400, 3), or None."""
        if self.render_mode is None:
            return None
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        from ..report.palette import colours_in
        from ..report.plan_view import draw_heading, draw_solids

        game, poses = self.game, self.game.world.states()
        figure = Figure(figsize=(4.0, 4.0), dpi=100)
        canvas: Any = FigureCanvasAgg(figure)
        axes = figure.add_axes((0.0, 0.0, 1.0, 1.0), aspect="equal")
        axes.set_axis_off()
        draw_solids(axes, self._room)
        colours = colours_in("light", poses, game.rules.identities)
        for name, pose in poses.items():
            draw_heading(axes, np.array(pose), colours[name], BODY)
        middle = np.mean([pose[:2] for pose in poses.values()], axis=0)
        axes.update_datalim([middle - REACH, middle + REACH])
        axes.autoscale_view()
        canvas.draw()
        image: NDArray[np.uint8] = np.asarray(canvas.buffer_rgba())
        return image[..., :3].copy()

    def close(self) -> None:
        """End the episode and release its resources."""
        if self._game is not None:
            self._game.world.close()
            self._game = None


class ParallelDuel(ParallelGames):
    """Both players of a duel.

    The observation of a player holds the terms of ``settings.terms``; the
    game is zero-sum. Capture and contact with an obstacle, in physics falls
    and contacts, terminate an episode; the time limit truncates it. ``info``
    holds "closest_m", "distance_m", "time_s" and "outcome", in one word.
    """

    metadata = ParallelGames.metadata | {"name": "stepaside_duel_v0"}
    patience = 30.0

    def __init__(
        self,
        *,
        render_mode: str | None = None,
        opponents: Mapping[str, Strategy] | None = None,
        **settings: Any,
    ) -> None:
        """Build the environment, with fields of :class:`.EnvironmentSettings`.

        Opponents are players that do not learn, by role.
        """
        self.settings = given = EnvironmentSettings(**settings)
        self._strategies = dict(opponents or {})
        roles = {n: n for n in PLAYERS if n not in self._strategies}
        body = given.duel.pursuer.body
        if body != "robot" and (
            "pursuer" in roles or given.level != "physics"
        ):
            raise ConfigurationError(
                "duel.pursuer.body must be robot without physics, and if the "
                f"pursuer learns, got {body!r}"
            )
        gait = given.duel.player(next(iter(roles), "evader")).gait
        self.period, unit = given.period, gait.speed / gait.gain
        if given.level != "physics":
            self._rooms, self._starts = given.draw_arenas()
        units, space = dict.fromkeys(roles, unit), observation_space
        super().__init__(roles, units, given, space(given.terms), render_mode)

    def begin(
        self, seed: int, held: Mapping[str, HeldIntent]
    ) -> tuple[GameInPlay, Room | None]:
        """Return the game of an episode, and its room."""
        given, played = self.settings, {**self._strategies, **held}
        if given.level != "physics":
            index = seed % len(self._rooms)
            room = self._rooms[index]
            duel = replace(given.game, room=room)
            duel = duel.started_at(self._starts[index])
            return GameInPlay(floor_of(duel, played), rules_of(duel)), room
        seed = (given.first_arena + seed) % SEEDS
        duel = replace(given.game, seed=seed, room=given.room_of(seed))
        robots = {n: s for n, s in played.items() if n in duel.robots}
        game = RecordedGame(duel, strategies=robots, recorded=False)
        return game, duel.room

    def observe(self, name: str) -> Row:
        """Return the observation of a player."""
        known, given = self.known.get(name), self.settings
        if known is None:
            raise StrategyError(
                f"a player must see its opponent within {self.patience:g} s, "
                f"got {self.outcome or 'no sighting'}"
            )
        values = observe(known, given.sensed_terms)
        if not given.full_state:
            return values
        world, unit = self.game.world, length_unit(known.limits)
        poses, other = world.states(), PLAYERS[name == "pursuer"]
        (x, y, _), (u, v, theta) = poses[name], poses[other]
        bearing = atan2(y - v, x - u) - theta  # of this player
        full = (
            *(cos(bearing), sin(bearing)),
            min(self.closest["evader"] / unit, FARTHEST),
            max(0.0, 1.0 - world.time / self.game.rules.duration),
        )
        return np.concatenate([values, np.array(full, np.float32)])

    def info(self) -> dict[str, Any]:
        """Return closest approach, distance [m], time [s] and outcome."""
        return super().info() | {
            "closest_m": self.closest["evader"],
            "distance_m": self.game.world.apart("evader", "pursuer"),
        }


class ParallelGame(ParallelGames):
    """Several players of one game, by its settings or its file.

    Capture of one evader ends the episode, in physics also a fall or a
    contact; the time limit truncates it. Players that do not learn follow
    their own strategies.
    """

    patience = 1.0

    def __init__(
        self,
        game: GameSettings | AnyPath,
        *,
        learners: Sequence[str] | None = None,
        action: str = "continuous",
        headings: int = HEADINGS,
        render_mode: str | None = None,
    ) -> None:
        """Build the environment of a game or of a game file.

        By default all robots and unicycles that are pursuers or evaders
        learn. Actions are those of :class:`.EnvironmentSettings`.
        """
        self.settings = given = (
            game if isinstance(game, GameSettings) else load_game(game)
        )
        self.period = given.gait.step_duration
        choice = EnvironmentSettings(action=action, headings=headings)
        self._terms: tuple[str, ...] = ("moving",)
        if given.room is not None:
            self._terms += ("clearances",)
        own, others = observation_space(self._terms), len(given.players) - 1
        space = box(
            [*own.low, *OTHER_LOW * others], [*own.high, *OTHER_HIGH * others]
        )
        players = {n: given.player(n) for n in learning(given, learners)}
        roles = {name: player.role for name, player in players.items()}
        units = {n: p.gait.speed / p.gait.gain for n, p in players.items()}
        super().__init__(roles, units, choice, space, render_mode)

    def begin(
        self, seed: int, held: Mapping[str, HeldIntent]
    ) -> tuple[GameInPlay, Room | None]:
        """Return the game of an episode, and its room."""
        settings = replace(self.settings, seed=seed % SEEDS)
        game = RecordedGame(settings, strategies=held, recorded=False)
        game.rules = replace(game.rules, capture=CAPTURE_DISTANCE)
        return game, settings.room

    def observe(self, name: str) -> Row:
        """Return own terms, then those of the others, the nearest first.

        Values of players that it has not seen are zero.
        """
        known = self.known.get(name)
        found = np.zeros(self._observed[name].shape, np.float32)
        if known is not None:
            seen = sorted(known.others, key=lambda other: other.distance)
            values = [*observe(known, self._terms)]
            for other in seen:
                values += _describe(known, other)
            found[: len(values)] = values
        return found


def learning(
    game: GameSettings, learners: Sequence[str] | None
) -> tuple[str, ...]:
    """Return the names of the players that learn: by default all that can."""
    able = [p.name for p in game.players if p.decides and p.role in PLAYERS]
    chosen = able if learners is None else list(learners)
    if not chosen or len(set(chosen) & set(able)) < len(chosen):
        raise ConfigurationError(
            "learners must be different robots or unicycles that are pursuers "
            f"or evaders ({', '.join(able) or 'there are none'}), got "
            f"{', '.join(chosen) or 'none'}"
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
    ahead, left = other.velocity or (0.0, 0.0)
    return [
        *(1.0, cos(other.bearing), sin(other.bearing)),
        min(other.distance / length_unit(limits), FARTHEST),
        min(max(ahead * pace / limits.speed, -FASTEST), FASTEST),
        min(max(left * pace / limits.speed, -FASTEST), FASTEST),
        float(own.opposes(other.identity)),
        float(own.is_with(other.identity)),
    ]
