"""Recorded game as a value: settings, outcome, trajectories and summary."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import combinations
from math import degrees, isfinite
from typing import (
    TYPE_CHECKING,
    Generic,
    NamedTuple,
    Self,
    TypeAlias,
    TypeGuard,
    TypeVar,
)

import numpy as np

from ..arena import Room
from ..core.player_identity import PlayerIdentity, Role
from ..core.poses import Array
from ..sim.camera_settings import RoomObject
from .duel_circle import angle_between, circle_of_theory, distance_between
from .duel_settings import EVADER, PURSUER, DuelSettings
from .duel_summary import DuelSummary
from .experiment_settings import ExperimentSettings
from .experiment_summary import ExperimentSummary
from .game_settings import GameSettings
from .game_summary import GameSummary
from .outcome import Outcome
from .play_settings import PlaySettings
from .play_summary import PlaySummary
from .trajectory import Trajectory
from .walk_settings import WALKER, WalkSettings
from .walk_summary import WalkSummary

if TYPE_CHECKING:
    from .sight_evaluation import EvaluatedImage

AnySettings: TypeAlias = (
    DuelSettings
    | GameSettings
    | WalkSettings
    | PlaySettings
    | ExperimentSettings
)
AnySummary: TypeAlias = (
    DuelSummary | GameSummary | WalkSummary | PlaySummary | ExperimentSummary
)
SettingsT = TypeVar("SettingsT", bound=AnySettings, covariant=True)
SummaryT = TypeVar("SummaryT", bound=AnySummary, covariant=True)


class SafetyArea(NamedTuple):
    """Circular safety area around a player.

    Attributes:
        player: Name of the player.
        radius: Radius, in [m].
    """

    player: str
    radius: float


class TheoryLevels(NamedTuple):
    """Values on the circle of theory.

    Attributes:
        radius_m: Radius of the evader's circle, in [m].
        distance_m: Distance between the players, in [m].
        angle_deg: Angle between their headings, in [deg].
    """

    radius_m: float
    distance_m: float
    angle_deg: float


class CircleInWorld(NamedTuple):
    """Circle in the world.

    Attributes:
        x: First coordinate of the center in the world, in [m].
        y: Second coordinate of the center in the world, in [m].
        radius: Radius, in [m].
    """

    x: float
    y: float
    radius: float


@dataclass(frozen=True, eq=False, repr=False)
class GameRun(Generic[SettingsT, SummaryT]):
    """Recorded game of any number of players.

    Trajectories are in the world; those of a play are in the player's own
    odometry. There the opponent is at its last sighting and is drawn as a
    template that faces the player, as its heading is unknown.

    Attributes:
        name: Name of the run; that of its folder if it was read from one.
        settings: Settings of the game, with the initial poses filled in.
        outcome: How the game ended.
        message: Reason for the end, as text.
        duration: Simulated or recorded time, in [s].
        times: Times of the samples, in [s]. Shape (n,).
        tracks: Trajectory of each player, by name, in the order in which
            the players act.
        summary: Values measured in the game.
        stills: Example images of robots with cameras, by robot and camera;
            not stored on disk.
    """

    name: str
    settings: SettingsT
    outcome: Outcome
    message: str
    duration: float
    times: Array
    tracks: Mapping[str, Trajectory]
    summary: SummaryT
    stills: "Mapping[str, Mapping[str, list[EvaluatedImage]]]" = field(
        default_factory=dict
    )

    def __repr__(self) -> str:
        """Describe the run in one line."""
        return (
            f"{self.game.capitalize()}Run({self.name!r}, {self.message!r}, "
            f"{len(self.times)} samples of {' and '.join(self.players)})"
        )

    def uninterrupted(self) -> Self:
        """Return the run.

        Raises:
            KeyboardInterrupt: If the user interrupted the game.
        """
        if self.outcome is Outcome.INTERRUPTED:
            raise KeyboardInterrupt
        return self

    @property
    def game(self) -> str:
        """Name of the game: "duel", "game", "walk", "play" or "experiment"."""
        return self.settings.game

    @property
    def title(self) -> str:
        """Title, for figures and pages."""
        settings = self.settings
        if isinstance(settings, PlaySettings):
            return f"Play of the {settings.role} over {settings.language}"
        if isinstance(settings, ExperimentSettings):
            return f"Experiment {settings.source}"
        return f"{self.game.capitalize()}, seed {settings.seed}"

    @property
    def players(self) -> tuple[str, ...]:
        """Names of the players."""
        return tuple(self.tracks)

    @property
    def robots(self) -> tuple[str, ...]:
        """Names of the players that are robots."""
        if isinstance(self.settings, DuelSettings):
            return self.settings.robots
        return tuple(n for n, t in self.tracks.items() if t.qpos is not None)

    @property
    def persons(self) -> tuple[str, ...]:
        """Names of the players that are drawn as persons."""
        settings = self.settings
        if isinstance(settings, GameSettings):
            return tuple(
                p.name for p in settings.players if p.body == "person"
            )
        if not isinstance(settings, DuelSettings):
            return ()
        return tuple(n for n in self.players if n not in self.robots)

    @property
    def identities(self) -> Mapping[str, PlayerIdentity]:
        """Identity of each player that has a role, by name."""
        if isinstance(self.settings, GameSettings):
            return self.settings.identities
        roles = {role.value: role for role in Role}
        return {
            name: PlayerIdentity(name, roles[name], name)
            for name in self.players
            if name in roles
        }

    @property
    def pursuer(self) -> Trajectory:
        """Trajectory of the pursuer."""
        return self.tracks[PURSUER]

    @property
    def evader(self) -> Trajectory:
        """Trajectory of the evader."""
        return self.tracks[EVADER]

    @property
    def walker(self) -> Trajectory:
        """Trajectory of the robot of a walk."""
        return self.tracks[WALKER]

    @property
    def opponents(self) -> tuple[tuple[str, str], ...]:
        """Names of each pursuer and evader.

        Without such, of every pair of a player with a strategy and another,
        or of all. Empty with one player.
        """
        roles = {n: identity.role for n, identity in self.identities.items()}
        found = tuple(
            (one, other)
            for one in self.players
            for other in self.players
            if roles.get(one) is Role.PURSUER
            and roles.get(other) is Role.EVADER
        )
        pairs = tuple(combinations(self.players, 2))
        if found or not isinstance(self.settings, GameSettings):
            return found or pairs
        deciding = {p.name for p in self.settings.players if p.decides}
        return tuple(p for p in pairs if deciding.intersection(p)) or pairs

    @property
    def pair(self) -> tuple[Trajectory, Trajectory] | None:
        """Trajectories of the first opponents; None with one player."""
        if not self.opponents:
            return None
        one, other = self.opponents[0]
        return self.tracks[one], self.tracks[other]

    @property
    def lines_of_sight(self) -> tuple[tuple[str, str], ...]:
        """Names of each pursuer and evader, or of any two players alone."""
        ids = self.identities
        facing = tuple(
            (one, other)
            for one, other in self.opponents
            if one in ids and other in ids and ids[one].opposes(ids[other])
        )
        return facing or (self.opponents if len(self.players) == 2 else ())

    @property
    def distance(self) -> Array:
        """Smallest distance between opponents' reference points, in [m].

        NaN with one player. Shape (n,).
        """
        if not self.opponents:
            return np.full(len(self.times), np.nan)
        tracks = {n: track.unicycle for n, track in self.tracks.items()}
        apart = [
            distance_between(tracks[one], tracks[other])
            for one, other in self.opponents
        ]
        nearest: Array = np.min(apart, axis=0)
        return nearest

    @property
    def has_orientation(self) -> bool:
        """Whether there are two players of known headings; not in a play."""
        in_play = isinstance(self.settings, PlaySettings)
        return len(self.tracks) == 2 and not in_play

    @property
    def orientation(self) -> Array:
        """Angle between the headings of two players, in [deg].

        NaN where it is unknown, see ``has_orientation``. Shape (n,).
        """
        if self.pair is None or not self.has_orientation:
            return np.full(len(self.times), np.nan)
        first, second = self.pair
        angle = angle_between(first.unicycle, second.unicycle)
        in_degrees: Array = np.degrees(angle)
        return in_degrees

    @property
    def theory(self) -> TheoryLevels | None:
        """Values on the circle of theory.

        None if the game has no circle, or the forecast was contact before it.
        """
        settings, summary = self.settings, self.summary
        if not (
            isinstance(settings, DuelSettings)
            and isinstance(summary, DuelSummary)
        ):
            return None
        circle = circle_of_theory(settings)
        expects_contact = summary.theory.expected == "contact"
        if not circle.exists or (
            expects_contact and summary.converged_at_s is None
        ):
            return None
        return TheoryLevels(
            circle.radius_evader_m,
            circle.distance_m,
            degrees(circle.headings_apart_rad),
        )

    @property
    def circle(self) -> CircleInWorld | None:
        """Circle of theory, centered where the players walked in the end.

        None if the players did not converge to it.
        """
        theory, summary = self.theory, self.summary
        if theory is None or not isinstance(summary, DuelSummary):
            return None
        if summary.converged_at_s is None:
            return None
        tail = self.times >= summary.converged_at_s
        centers = [
            track.unicycle[tail, :2].mean(axis=0)
            for track in self.tracks.values()
        ]
        x, y = np.mean(centers, axis=0).tolist()
        return CircleInWorld(x, y, theory.radius_m)

    @property
    def safety(self) -> SafetyArea | None:
        """Safety area of an evader; None if it always evades."""
        settings = self.settings
        if isinstance(
            settings, WalkSettings | GameSettings | ExperimentSettings
        ):
            return None
        if isinstance(settings, PlaySettings) and settings.role != EVADER:
            return None
        radius = settings.strategy.area
        return SafetyArea(EVADER, radius) if isfinite(radius) else None

    @property
    def safety_areas(self) -> tuple[SafetyArea, ...]:
        """Safety area of each player that has one."""
        if not isinstance(self.settings, GameSettings):
            return () if self.safety is None else (self.safety,)
        radii = self.settings.safety_radii.items()
        return tuple(SafetyArea(n, r) for n, r in radii if isfinite(r))

    @property
    def plan(self) -> Room | None:
        """Room of the game; None on an open floor."""
        if isinstance(self.settings, GameSettings):
            return self.settings.room
        if not isinstance(self.settings, DuelSettings):
            return None
        return self.settings.room.plan

    @property
    def things(self) -> tuple[RoomObject, ...]:
        """Objects in the room."""
        if not isinstance(self.settings, DuelSettings):
            return ()
        return tuple(self.settings.room.things)

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


Run: TypeAlias = GameRun[AnySettings, AnySummary]
DuelRun: TypeAlias = GameRun[DuelSettings, DuelSummary]
MatchRun: TypeAlias = GameRun[GameSettings, GameSummary]
WalkRun: TypeAlias = GameRun[WalkSettings, WalkSummary]
PlayRun: TypeAlias = GameRun[PlaySettings, PlaySummary]
ExperimentRun: TypeAlias = GameRun[ExperimentSettings, ExperimentSummary]


def is_duel(run: Run) -> TypeGuard[DuelRun]:
    """Return whether a run is one of a duel."""
    return isinstance(run.settings, DuelSettings)


def is_match(run: Run) -> TypeGuard[MatchRun]:
    """Return whether a run is one of a game file."""
    return isinstance(run.settings, GameSettings)


def is_walk(run: Run) -> TypeGuard[WalkRun]:
    """Return whether a run is one of a walk."""
    return isinstance(run.settings, WalkSettings)


def is_play(run: Run) -> TypeGuard[PlayRun]:
    """Return whether a run is one of a play at a robot."""
    return isinstance(run.settings, PlaySettings)
