"""Recorded game as a value: settings, trajectories and summary."""

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
    """Settings that every game has."""

    @property
    def seed(self) -> int:
        """Seed of every random draw."""

    @property
    def robot(self) -> str:
        """Name of a robot or folder of its description."""

    @property
    def gait(self) -> GaitSettings:
        """Gait of its robots."""

    def robot_of(self, player: str) -> RobotSettings:
        """Return robot, gait and control of a player."""

    @property
    def cycle(self) -> float:
        """Duration of a gait cycle of the slowest robot, in [s]."""

    @property
    def physics(self) -> PhysicsSettings:
        """Physics, floor and clock."""

    @property
    def body(self) -> BodySettings:
        """Deviations of its bodies from ideal ones."""


class GameSummary(Protocol):
    """Values that the summary of every game has."""

    @property
    def outcome(self) -> str:
        """How the game ended."""

    @property
    def message(self) -> str:
        """Reason for the end, as text."""

    @property
    def duration_s(self) -> float:
        """Simulated time, in [s]."""

    def to_json(self) -> dict[str, Any]:
        """Return plain values by name."""


class SafetyArea(NamedTuple):
    """Circular safety area around a player.

    Attributes:
        player: Name of the player.
        radius: Radius, in [m].
    """

    player: str
    radius: float


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Run:
    """Recorded game.

    Attributes:
        name: Name of the run; that of its folder if it was read from one.
        settings: Settings of the game.
        outcome: How the game ended.
        message: Reason for the end, as text.
        duration: Simulated time, in [s].
        times: Times of the samples, in [s]. Shape (n,).
        tracks: Trajectory of each player, by name, in the order in which
            the players act.
        summary: Summary of the game.
        stills: Example images of robots with cameras, by robot and camera;
            not stored on disk.
    """

    game: ClassVar[str] = "game"  # name of the game

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
        """Describe the run in one line."""
        return (
            f"{type(self).__name__}({self.name!r}, {self.message!r}, "
            f"{len(self.times)} samples of {' and '.join(self.players)})"
        )

    @property
    def plan(self) -> Room | None:
        """Room of the game; None on an open floor."""
        return None

    @property
    def title(self) -> str:
        """Title, for figures and pages."""
        return f"{self.game.capitalize()}, seed {self.settings.seed}"

    @property
    def players(self) -> tuple[str, ...]:
        """Names of the players."""
        return tuple(self.tracks)

    @property
    def robots(self) -> tuple[str, ...]:
        """Names of the players whose joint angles are recorded."""
        return tuple(n for n, t in self.tracks.items() if t.qpos is not None)

    @property
    def persons(self) -> tuple[str, ...]:
        """Names of the players that are drawn as persons."""
        return tuple(n for n in self.players if n not in self.robots)

    @property
    def pair(self) -> tuple[Trajectory, Trajectory] | None:
        """Trajectories of the first two players; None with one player."""
        if len(self.tracks) < 2:
            return None
        first, second, *_ = self.tracks.values()
        return first, second

    @property
    def distance(self) -> Array | None:
        """Distance between the first two players, in [m]. Shape (n,).

        It is measured between their reference points; None with one player.
        """
        if self.pair is None:
            return None
        first, second = self.pair
        return distance_between(first.unicycle, second.unicycle)

    @property
    def orientation(self) -> Array | None:
        """Angle between the first two headings, in [deg]. Shape (n,).

        None with one player.
        """
        if self.pair is None:
            return None
        first, second = self.pair
        angle: Array = angle_between(first.unicycle, second.unicycle)
        in_degrees: Array = np.degrees(angle)
        return in_degrees

    @property
    def theory(self) -> tuple[float, float, float] | None:
        """Radius [m], distance [m] and angle [deg] on the circle of theory."""
        return None

    @property
    def circle(self) -> tuple[float, float, float] | None:
        """Center (x, y) and radius of the circle of theory, in [m]."""
        return None

    @property
    def safety(self) -> SafetyArea | None:
        """Safety area of a player, if there is one."""
        return None

    @property
    def things(self) -> tuple[RoomObject, ...]:
        """Objects in the room."""
        return ()

    def index_at(self, time: float) -> int:
        """Return the index of the first sample at or after a time, in [s]."""
        index = int(np.searchsorted(self.times, time - 1e-9))
        return min(index, len(self.times) - 1)

    def has_ended_at(self, index: int) -> bool:
        """Return whether a sample is the last of a game that ended early.

        A game that was interrupted by the user counts as completed.
        """
        last = index >= len(self.times) - 1
        complete = (Outcome.COMPLETED, Outcome.INTERRUPTED)
        return last and self.outcome not in complete

    def words(self, index: int) -> str:
        """Describe the state of the game at a sample, for captions."""
        if self.has_ended_at(index):
            return self.message
        pushed = self.pushed_at(float(self.times[index]))
        if pushed:
            return f"{' and '.join(pushed)} is pushed"
        return f"{' and '.join(self.players)} in motion"

    def pushed_at(self, time: float) -> tuple[str, ...]:
        """Return the players pushed in the last second before a time [s]."""
        found = []
        for name, track in self.tracks.items():
            if track.pushes is not None:
                since = time - track.pushes[:, 0]
                if ((since >= 0.0) & (since < 1.0)).any():
                    found.append(name)
        return tuple(found)

    def arrays(self) -> dict[str, Array]:
        """Return all arrays by name: ``times_s``, ``pursuer_com``, ..."""
        found = {"times_s": self.times}
        for name, track in self.tracks.items():
            found |= track.arrays(name)
        return found
