"""PettingZoo environment of the games of the package, and their episodes."""

from abc import abstractmethod
from collections.abc import Callable, Mapping, Sequence
from math import cos, inf, sin
from typing import Any, ClassVar

import numpy as np
from gymnasium.spaces import Box, Space
from numpy.typing import NDArray
from pettingzoo import ParallelEnv

from ..arena import Room
from ..core.errors import PlanError, check_choice
from ..core.poses import Pose
from ..games.floor_world import FloorWorld
from ..games.game import GameInPlay
from ..games.outcome import Outcome
from ..planning import Direction
from ..report.palette import colours_in
from ..strategies.knowledge import STAND, Intent, Knowledge
from .environment_settings import SEEDS, EnvironmentSettings, IntentActions

REACH = 2.0  # least half width of an image, in [m]
BODY = 0.2  # radius of a player in an image, in [m]
Observations = dict[str, NDArray[np.float32]]
Infos = dict[str, dict[str, Any]]


class HeldIntent:
    """Strategy that returns the intent that it holds.

    It is not pure: the intent is replaced from outside, between decisions.

    Attributes:
        intent: The intent.
        known: Knowledge at the last decision; None before.
    """

    saturated = False

    def __init__(self, direction: Direction) -> None:
        """Hold the intent to stand."""
        self.direction = direction
        self.reset()

    def reset(self) -> None:
        """Forget all decisions."""
        self.intent = STAND
        self.known: Knowledge | None = None

    def begin(self) -> None:
        """Return no memory."""

    def decide(
        self, knowledge: Knowledge, memory: None
    ) -> tuple[Intent, None]:
        """Store the knowledge and return the intent."""
        self.known = knowledge
        return self.intent, None


class Episode:
    """Game of one episode, in which some players hold given intents.

    A step lasts a period, or one decision on the floor. A robot in physics
    decides when a foot has landed, by the intent that it holds then; its
    knowledge is that of its last decision.
    """

    def __init__(
        self,
        game: GameInPlay,
        held: Mapping[str, HeldIntent],
        room: Room,
        *,
        period: float | None = None,
        patience: float = 0.0,
    ) -> None:
        """Begin; in physics, stand until all controlled players see others.

        Their longest patience is in [s], and so is the period of a step, one
        decision by default.
        """
        self.game, self.room, self._held = game, room, held
        self.identities, self._period = game.rules.identities, period
        for own in held.values():
            own.reset()  # decisions of its validation
        if not isinstance(game.world, FloorWorld):
            while not (self.sees or self.over or self.time > patience):
                game.tick()
        self._until = self.time  # end of the present step

    @property
    def sees(self) -> bool:
        """Whether all controlled players have seen others."""
        return all(own.known is not None for own in self._held.values())

    def knowledge(self, name: str) -> Knowledge | None:
        """Return what a controlled player knows; None before it sees."""
        if isinstance(self.game.world, FloorWorld):
            return self.game.world.knowledge(name)
        return self._held[name].known

    def step(self, intents: Mapping[str, Intent]) -> None:
        """Play one step, with the intent of each controlled player."""
        for name, intent in intents.items():
            self._held[name].intent = intent
        if self._period is not None:
            self._until += self._period
            while not self.over and self.time < self._until - 1e-9:
                self.game.tick(self._until)
        else:
            self.game.tick()

    @property
    def time(self) -> float:
        """Time, in [s]."""
        return self.game.world.time

    @property
    def poses(self) -> Mapping[str, Pose]:
        """Pose of each player in the room, by name."""
        return self.game.world.states()

    @property
    def over(self) -> bool:
        """Whether the episode is over."""
        return self.game.ended is not None

    @property
    def truncated(self) -> bool:
        """Whether the time is up."""
        late = self.time >= self.game.rules.duration - 1e-9
        return late and self.game.outcome is Outcome.COMPLETED

    @property
    def ended(self) -> str:
        """Outcome in one word; empty while it goes on, or if truncated."""
        return "" if self.truncated else str(self.game.outcome or "")

    @property
    def closest(self) -> dict[str, float]:
        """Closest approach of each evader so far, in [m], by name.

        It is 0 after a fall, or contact with anything but an opponent.
        """
        game, ids = self.game, self.identities
        found = self._nearest(lambda *pair: game.closest[pair])
        touched = ids.keys() & set(game.touched)
        for name in found.keys() & (touched | set(game.fallen)):
            met = any(ids[name].opposes(ids[other]) for other in touched)
            if name in game.fallen or not met:
                found[name] = 0.0
        return found

    @property
    def distances(self) -> dict[str, float]:
        """Distance of each evader from the nearest opponent, in [m]."""
        return self._nearest(self.game.world.apart)

    def _nearest(self, apart: Callable[[str, str], float]) -> dict[str, float]:
        found: dict[str, float] = {}
        for evader, other in self.game.closest:
            apart_now = apart(evader, other)
            found[evader] = min(found.get(evader, inf), apart_now)
        return found


class ParallelGames(ParallelEnv[str, NDArray[np.float32], Any]):
    """Players of a game act at the same time; a step is one decision.

    The reward of an evader is the change of its closest approach so far, in
    units of v/k, zero or negative; contact with an obstacle counts as a
    closest approach of zero. So its return is the closest approach of the
    episode less the initial distance: what
    :mod:`stepaside.theory.value.two_cars` bounds. A pursuer has the negative
    mean of those of all evaders.

    Attributes:
        possible_agents: Names of the players that learn.
        agents: The same during an episode, else empty.
        render_mode: "rgb_array" or None.
        episode: The episode; None before the first.
    """

    metadata: ClassVar[dict[str, Any]] = {
        "name": "stepaside_game_v0",
        "render_modes": ["rgb_array"],
        "render_fps": 10,
        "is_parallelizable": True,
    }

    def __init__(
        self,
        names: Sequence[str],
        choice: EnvironmentSettings,
        space: Box,
        render_mode: str | None,
    ) -> None:
        """Build the spaces of the players that learn, by name."""
        if render_mode is not None:
            modes = tuple(self.metadata["render_modes"])
            check_choice(render_mode, modes, "render_mode")
        self.render_mode = render_mode
        self.possible_agents = list(names)
        self.agents: list[str] = []
        self._actions = {n: IntentActions(choice) for n in names}
        self._observed = {n: Box(space.low, space.high) for n in names}
        self._random = np.random.default_rng()
        self._seed: int | None = None
        self._number = 0
        self.episode: Episode | None = None
        self._paths: dict[str, list[Any]] = {}

    @abstractmethod
    def begin(self, seed: int, number: int) -> Episode:
        """Begin an episode of a seed, by its number since seeding."""

    @abstractmethod
    def observe(self, episode: Episode, name: str) -> NDArray[np.float32]:
        """Return the observation of a player."""

    @abstractmethod
    def unit(self, episode: Episode, name: str) -> float:
        """Return the unit of length of a player, v/k, in [m]."""

    @abstractmethod
    def info(self, episode: Episode) -> dict[str, Any]:
        """Return what an environment says besides the observation."""

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

        Args:
            seed: Seed, 0 or above; None continues with the next episode.
            options: Not used.
        """
        if seed is not None or self._seed is None:
            drawn = int(self._random.integers(SEEDS))
            self._seed = (drawn if seed is None else seed) % SEEDS
            self._number = 0
        else:
            self._number += 1
        self.close()
        self.episode = self.begin(self._seed, self._number)
        self.agents = list(self.possible_agents)
        self._paths = {name: [] for name in self.episode.poses}
        return self._look(self.episode)

    def step(
        self, actions: Mapping[str, Any]
    ) -> tuple[
        Observations,
        dict[str, float],
        dict[str, bool],
        dict[str, bool],
        Infos,
    ]:
        """Play one decision of all players, by the action of each agent.

        Raises:
            PlanError: If an action is missing or invalid, or the episode is
                over.
        """
        episode, names = self.episode, self.possible_agents
        if episode is None or not self.agents:
            raise PlanError("reset the environment first: no episode is on")
        missing = [name for name in names if name not in actions]
        if missing:
            raise PlanError(
                f"actions must have one of the {missing[0]}, got those of "
                f"{', '.join(actions) or 'no agent'}"
            )
        intents = {n: self._actions[n].intent(actions[n]) for n in names}
        before = episode.closest
        episode.step(intents)
        gains = {n: now - before[n] for n, now in episode.closest.items()}
        taken = -sum(gains.values()) / len(gains)  # by each pursuer
        observations, infos = self._look(episode)
        if episode.over:
            self.agents = []
        return (
            observations,
            {n: gains.get(n, taken) / self.unit(episode, n) for n in names},
            dict.fromkeys(names, bool(episode.ended)),
            dict.fromkeys(names, episode.truncated),
            infos,
        )

    def _look(self, episode: Episode) -> tuple[Observations, Infos]:
        """Return observations and infos, and note the paths for images."""
        if self.render_mode is not None:
            for name, pose in episode.poses.items():
                self._paths[name].append(pose[:2])
        names = self.possible_agents
        observations = {n: self.observe(episode, n) for n in names}
        return observations, {n: self.info(episode) for n in names}

    def state(self) -> NDArray[np.float32]:
        """Return the poses (x [m], y [m], heading [rad]) of all players."""
        if self.episode is None:
            raise PlanError("reset the environment first: there is no state")
        return np.array([*self.episode.poses.values()], np.float32).ravel()

    def render(self) -> Any:
        """Return an image from above, shape (400, 400, 3), or None."""
        if self.render_mode is None:
            return None
        if self.episode is None:
            raise PlanError("reset the environment first: nothing to render")
        return _seen_from_above(self.episode, self._paths)

    def close(self) -> None:
        """End the episode and release its resources."""
        if self.episode is not None:
            self.episode.game.world.close()
            self.episode = None


def _seen_from_above(
    episode: Episode, paths: Mapping[str, Any]
) -> NDArray[np.uint8]:
    """Return an image of the players, their paths and the room."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.patches import Circle
    from matplotlib.patches import Polygon as Outline

    room, poses = episode.room, episode.poses
    colours = colours_in("light", poses, episode.identities)
    figure = Figure(figsize=(4.0, 4.0), dpi=100)
    canvas: Any = FigureCanvasAgg(figure)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set_axis_off()
    for solid in room.solids:
        if solid.rounding > 0.0:
            shape: Any = Circle(solid.centre, solid.rounding)
        else:
            shape = Outline(solid.outline, closed=True)
        shape.set_facecolor("0.7")
        axes.add_patch(shape)
    for name, (x, y, theta) in poses.items():
        colour = colours[name]
        axes.plot(*np.array(paths[name]).T, color=colour, lw=1.0)
        axes.add_patch(Circle((x, y), BODY, color=colour, alpha=0.5))
        nose = x + BODY * cos(theta), y + BODY * sin(theta)
        axes.plot([x, nose[0]], [y, nose[1]], color="k", lw=2.0)
    places = np.array([pose[:2] for pose in poses.values()])
    middle, apart = places.mean(axis=0), np.ptp(places, axis=0).max()
    reach = max(REACH, 0.5 * apart + 2.0 * BODY)
    if room.width is not None and room.depth is not None:
        middle, reach = np.zeros(2), 0.55 * max(room.width, room.depth)
    axes.set_xlim(middle[0] - reach, middle[0] + reach)
    axes.set_ylim(middle[1] - reach, middle[1] + reach)
    canvas.draw()
    image: NDArray[np.uint8] = np.asarray(canvas.buffer_rgba())
    return image[..., :3].copy()
