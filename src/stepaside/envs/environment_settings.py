"""Settings, arenas, observations and actions of learning environments."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import pi
from typing import Any

import numpy as np
from gymnasium.spaces import Box, Discrete, Space
from numpy.typing import ArrayLike

from ..arena import (
    OPEN_FLOOR,
    Room,
    RoomRecipe,
    draw_any_start,
    draw_initial_poses,
    generate_room,
)
from ..core.errors import (
    ConfigurationError,
    PlanError,
    check_choice,
    check_within,
    shown,
)
from ..core.poses import Array, Pose
from ..games.floor_world import PARTS
from ..games.game_settings import GameSettings
from ..games.game_settings import duel as make_duel
from ..games.player_settings import PLAYERS
from ..planning import Direction
from ..strategies.learned import (
    FULL_STATE_TERMS,
    HEADINGS,
    SENSED_TERMS,
    ObservedTerm,
    StrategyContract,
    discrete_headings,
)

ALL_TERMS: dict[str, ObservedTerm] = SENSED_TERMS | FULL_STATE_TERMS
SEEDS = 2**31
# Arenas between one episode and the next of the same seed: a prime that
# divides no usual number of arenas, so that all of them come.
STRIDE = 7919
DUEL = make_duel()
LOW, HIGH = (-pi, 0.0), (pi, 1.0)  # of a continuous action


@dataclass(frozen=True)
class EnvironmentSettings:
    """Game, observation, action and reward of an environment."""

    # "unicycle", with eight decisions per step, "steps", or "physics", two
    # simulated humanoids
    level: str = "unicycle"
    room: Room | RoomRecipe | None = None  # None for an open floor
    # Different rooms and starts, of which an episode takes one, and seed of
    # the first; in physics each episode has a seed, and room, of its own.
    arenas: int = 256
    first_arena: int = 0
    # Begin with any headings, on an open floor without physics; otherwise
    # the pursuer within 90, the evader within 30 degrees of facing the other.
    any_heading: bool = False
    duration: float = 60.0  # of an episode [s]
    full_state: bool = False  # also observe FULL_STATE_TERMS
    action: str = "continuous"  # heading and speed factor; or "discrete"
    headings: int = HEADINGS  # of discrete actions; one more stands
    # Robots and gaits; bodies, sensing and people in physics, else the capture
    # distance. Level and duration are those above.
    duel: GameSettings = DUEL

    def __post_init__(self) -> None:
        """Validate names, ranges and combinations."""
        check_choice(self.level, (*PARTS, "physics"), "level")
        check_choice(self.action, ("continuous", "discrete"), "action")
        error = ConfigurationError
        check_within(self.duration, 0.01, 3600.0, "duration", "s", error)
        check_within(self.headings, 2, 1000, "headings", "1", error)
        check_within(self.arenas, 1, 100_000, "arenas", "1", error)
        check_within(self.first_arena, 0, SEEDS, "first_arena", "1", error)
        if not isinstance(self.room, Room | RoomRecipe | None):
            raise error(
                "room must be a Room, a RoomRecipe or None, got "
                f"{shown(self.room)}"
            )
        if self.any_heading and self.room is not None:
            raise error("any_heading must be false in a room, got true")
        if self.duel.room is not None:
            raise error("duel.room must be given as room")
        for name in ("full_state", "any_heading"):
            if self.level == "physics" and getattr(self, name):
                raise error(f"{name} must be false at level physics")

    def room_of(self, seed: int) -> Room | None:
        """Return the room of a seed; None on an open floor."""
        if isinstance(self.room, RoomRecipe):
            return generate_room(self.room, seed)
        return self.room

    def draw_arenas(self) -> tuple[list[Room], list[tuple[Pose, Pose]]]:
        """Draw rooms, and starts of pursuer and evader, without physics.

        Arena i is that of seed i in a tournament.

        Raises:
            ConfigurationError: If a room has no space, or moving boxes.
        """
        first = int(self.first_arena)
        seeds = range(first, first + int(self.arenas))
        rooms = [self.room_of(seed) or OPEN_FLOOR for seed in seeds]
        if any(each.moving for each in rooms):
            raise ConfigurationError(
                "room must have no moving boxes at this level"
            )
        starts = [
            draw_any_start(seed)
            if self.any_heading
            else one.starts or draw_initial_poses(one, seed)
            for one, seed in zip(rooms, seeds, strict=True)
        ]
        return rooms, starts

    @property
    def game(self) -> GameSettings:
        """The game of an episode, but for its seed or its arena.

        Without physics it lasts a whole number of decisions.
        """
        duration = self.duration
        if self.level != "physics":
            period = self.period
            duration = max(1, round(duration / period)) * period
        return replace(self.duel, level=self.level, duration=duration)

    @property
    def period(self) -> float:
        """Duration of a step of the environment, in [s]."""
        step = self.duel.evader.gait.step_duration
        return step / PARTS.get(self.level, 1)

    @property
    def sensed_terms(self) -> tuple[str, ...]:
        """Terms of the observation that a strategy can have, too."""
        return tuple(
            name
            for name in SENSED_TERMS
            if name != "clearances" or self.room is not None
        )

    @property
    def terms(self) -> tuple[str, ...]:
        """All terms of the observation, in order."""
        more = tuple(FULL_STATE_TERMS) if self.full_state else ()
        return self.sensed_terms + more

    @property
    def action_headings(self) -> tuple[float | None, ...]:
        """Heading of each discrete action, in [rad]; empty if continuous."""
        if self.action == "continuous":
            return ()
        return discrete_headings(self.headings)

    def contract(self, role: str) -> StrategyContract:
        """Return the contract of a strategy learned here, by a role."""
        return StrategyContract(
            direction_of(role), self.sensed_terms, self.action_headings
        )

    def action_space(self) -> Space[Any]:
        """Return a space of actions.

        A continuous action is a heading, in [-pi, pi] [rad], in the frame of
        the player, and a speed factor, in [0, 1]; 0 stands. A discrete one is
        one of evenly spaced headings at full speed, or, the last, to stand.
        """
        headings = self.action_headings
        return Discrete(len(headings)) if headings else box(LOW, HIGH)

    @cached_property
    def _discrete(self) -> Array:
        """Heading [rad] and speed factor of each discrete action. (n, 2)."""
        rows = [(h or 0.0, h is not None) for h in self.action_headings]
        return np.array(rows, np.float64)

    def intents(self, actions: Any) -> Array:
        """Return headings [rad] and speed factors of actions. Shape (n, 2).

        Numbers beyond their ranges are limited.

        Raises:
            PlanError: If the actions are not in the space.
        """
        values, count = np.array(actions), len(self._discrete)
        if count:
            right = values.ndim == 1 and values.dtype.kind in "iu"
            right = right and bool(((values >= 0) & (values < count)).all())
            wanted = f"an integer in [0, {count - 1}]"
        else:
            right = values.shape[1:] == (2,) and not np.isnan(values).any()
            wanted = "a heading [rad] and a speed factor [1], finite"
        if not right:
            raise PlanError(
                f"an action must be {wanted}, got {shown(values.tolist())}"
            )
        if count:
            found: Array = self._discrete[values]
            return found
        return np.clip(values.astype(np.float64), LOW, HIGH)


def direction_of(role: str) -> Direction:
    """Return the direction in which a role drives, (1) or (3)."""
    check_choice(role, PLAYERS, "role")
    return Direction.FORWARD if role == "pursuer" else Direction.BACKWARD


def observation_space(terms: Sequence[str]) -> Box:
    """Return the space of observations with some terms, in order."""
    ranges = [ALL_TERMS[name] for name in terms]
    return box(
        [t.low for t in ranges for _ in range(t.width)],
        [t.high for t in ranges for _ in range(t.width)],
    )


def box(low: ArrayLike, high: ArrayLike) -> Box:
    """Return a space of single precision between two rows."""
    return Box(np.array(low, np.float32), np.array(high, np.float32))
