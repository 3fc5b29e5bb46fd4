"""A game that was played, as a value, whoever and how many played."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Protocol

import numpy as np

from ..arena import Room
from ..core.poses import Array
from ..planning import GaitSettings
from ..sim.body_settings import BodySettings
from ..sim.camera_settings import RoomObject
from ..sim.physics_settings import PhysicsSettings
from .duel_circle import angle_between, distance_between
from .duel_settings import RobotSettings
from .outcome import Outcome
from .trajectory import Trajectory

if TYPE_CHECKING:
    from .sight_evaluation import EvaluatedImage


class GameSettings(Protocol):
    """What decides a game, as far as every game has it."""

    @property
    def seed(self) -> int:
        """Seed of every random draw."""

    @property
    def robot(self) -> str:
        """Name of a robot or folder of its description."""

    @property
    def gait(self) -> GaitSettings:
        """How its robots walk."""

    def robot_of(self, player: str) -> RobotSettings:
        """What a player is, and how it walks."""

    @property
    def cycle(self) -> float:
        """Duration of a gait cycle of the slowest robot, in [s]."""

    @property
    def physics(self) -> PhysicsSettings:
        """Physics, floor and clock."""

    @property
    def body(self) -> BodySettings:
        """How far its bodies are from ideal ones."""


class GameSummary(Protocol):
    """What is said of a game in numbers."""

    @property
    def outcome(self) -> str:
        """How it ended."""

    @property
    def message(self) -> str:
        """What ended it, in words."""

    @property
    def duration_s(self) -> float:
        """Simulated time, in [s]."""

    def to_json(self) -> dict[str, Any]:
        """Plain values by name."""


class SafetyArea(NamedTuple):
    """A round area that a player keeps free.

    Attributes:
        player: Whose it is.
        radius: In [m].
    """

    player: str
    radius: float


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Run:
    """A game that was played: what decided it, how it went, its figures.

    Attributes:
        name: What it is called; that of its folder if it came from one.
        settings: What decided it.
        outcome: How it ended.
        message: What ended it, in words.
        duration: Simulated time, in [s].
        times: Times of the samples, in [s]. Shape (n,).
        tracks: Record of each player, by name, in the order in which they
            act.
        summary: Its figures.
        stills: Some of what robots with cameras saw, by robot and camera;
            not kept on disk.
    """

    game: ClassVar[str] = "game"  # what was played, in a word

    name: str
    settings: GameSettings
    outcome: Outcome
    message: str
    duration: float
    times: Array
    tracks: Mapping[str, Trajectory]
    summary: GameSummary
    stills: "Mapping[str, Mapping[str, list[EvaluatedImage]]]" = field(
        default_factory=dict
    )

    def __repr__(self) -> str:
        """What was played, in one line."""
        return (
            f"{type(self).__name__}({self.name!r}, {self.message!r}, "
            f"{len(self.times)} samples of {' and '.join(self.players)})"
        )

    @property
    def plan(self) -> Room | None:
        """Room that they play in, if they play in one."""
        return None

    @property
    def title(self) -> str:
        """What it was, in a few words."""
        return f"{self.game.capitalize()}, seed {self.settings.seed}"

    @property
    def players(self) -> tuple[str, ...]:
        """Who played."""
        return tuple(self.tracks)

    @property
    def robots(self) -> tuple[str, ...]:
        """Those of them whose joints are known."""
        return tuple(n for n, t in self.tracks.items() if t.qpos is not None)

    @property
    def persons(self) -> tuple[str, ...]:
        """Those who are persons; who is neither is drawn as a template."""
        return tuple(n for n in self.players if n not in self.robots)

    @property
    def pair(self) -> tuple[Trajectory, Trajectory] | None:
        """Records of the first two; None if one played alone."""
        if len(self.tracks) < 2:
            return None
        first, second, *_ = self.tracks.values()
        return first, second

    @property
    def distance(self) -> Array | None:
        """Between the places of the first two, in [m]. Shape (n,)."""
        if self.pair is None:
            return None
        first, second = self.pair
        return distance_between(first.unicycle, second.unicycle)

    @property
    def orientation(self) -> Array | None:
        """Angle between the headings of the first two, in [deg]. (n,)."""
        if self.pair is None:
            return None
        first, second = self.pair
        degs: Array = np.degrees(
            angle_between(first.unicycle, second.unicycle)
        )
        return degs

    @property
    def theory(self) -> tuple[float, float, float] | None:
        """Radius [m], distance [m] and angle [deg] of theory's circle."""
        return None

    @property
    def circle(self) -> tuple[float, float, float] | None:
        """Center (x, y) and radius of theory's circle, in [m]."""
        return None

    @property
    def safety(self) -> SafetyArea | None:
        """Area that somebody keeps free, if there is one."""
        return None

    @property
    def things(self) -> tuple[RoomObject, ...]:
        """What stands about."""
        return ()

    def index_at(self, time: float) -> int:
        """Number of the first sample at a time, in [s], or after it."""
        index = int(np.searchsorted(self.times, time - 1e-9))
        return min(index, len(self.times) - 1)

    def has_ended_at(self, index: int) -> bool:
        """Whether a sample is the last of a game that something ended."""
        last = index >= len(self.times) - 1
        goes_on = (Outcome.COMPLETED, Outcome.INTERRUPTED)
        return last and self.outcome not in goes_on

    def words(self, index: int) -> str:
        """What goes on at a sample."""
        if self.has_ended_at(index):
            return self.message
        pushed = self.pushed_at(float(self.times[index]))
        if pushed:
            return f"{' and '.join(pushed)} is pushed"
        return f"{' and '.join(self.players)} in motion"

    def pushed_at(self, time: float) -> tuple[str, ...]:
        """Who was pushed in the last second before a time, in [s]."""
        found = []
        for name, track in self.tracks.items():
            if track.pushes is not None:
                since = time - track.pushes[:, 0]
                if ((since >= 0.0) & (since < 1.0)).any():
                    found.append(name)
        return tuple(found)

    def arrays(self) -> dict[str, Array]:
        """Record as arrays by name: ``times_s``, ``pursuer_com``, ..."""
        found = {"times_s": self.times}
        for name, track in self.tracks.items():
            found |= track.arrays(name)
        return found
