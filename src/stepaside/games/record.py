"""The record of a game: a track of every player."""

from collections.abc import Sequence

import numpy as np

from ..control.walking import StepBegun
from ..planning import Foot, ManeuverPlan
from ..poses import Array, Pose
from .match import Match
from .outcome import Outcome
from .player import Player, Snapshot
from .track import Planning, Track, margin_of

PERIOD = 0.02  # between samples, in [s]


class Recorder:
    """Samples a game, and hands it out as tracks.

    Attributes:
        every: Control ticks between samples.
    """

    def __init__(self, players: Sequence[Player], *, tick: float) -> None:
        """Record players at a control period, in [s]."""
        self.every = max(1, round(PERIOD / tick))
        self._times: list[float] = []
        self._records = {player.name: _Record() for player in players}

    @property
    def times(self) -> Array:
        """Times of the samples, in [s]. Shape (n,)."""
        return np.array(self._times)

    def before(self, match: Match) -> None:
        """Take a sample when one is due."""
        if match.world.ticks % self.every == 0:
            self._sample(match)

    def acted(self, match: Match) -> None:
        """Note the steps that begin."""
        for player in match.players:
            if player.begun is not None:
                self._records[player.name].begun.append(player.begun)

    def ended(self, match: Match, outcome: Outcome) -> None:
        """Take the last sample, unless there is one of this instant."""
        if not self._times or self._times[-1] < match.world.time:
            self._sample(match)

    def _sample(self, match: Match) -> None:
        self._times.append(match.world.time)
        for player in match.players:
            self._records[player.name].add(player.snapshot())

    def tracks(self) -> dict[str, Track]:
        """Everything recorded so far, by name of the player."""
        return {name: rec.track() for name, rec in self._records.items()}

    def planning(self) -> dict[str, Planning]:
        """How everybody planned, by name of the player."""
        return {name: rec.planning() for name, rec in self._records.items()}


class _Record:
    """What is known of one player, by name of what it becomes."""

    def __init__(self) -> None:
        self.begun: list[StepBegun] = []
        self._rows: dict[str, list[Sequence[float] | Array]] = {}
        self._frame: Pose | None = None

    def add(self, seen: Snapshot) -> None:
        """Keep a snapshot as rows."""
        rows: dict[str, Sequence[float] | Array] = {
            "com": seen.com,
            "place": seen.place,
            "torso": seen.torso,
        }
        if seen.walk is not None:
            rows["com_reference"] = seen.walk.reference.com[:2]
            rows["zmp_reference"] = seen.walk.zmp_reference
        if seen.zmp is not None:
            rows["zmp"] = seen.zmp
        if seen.posture is not None:
            rows["qpos"] = seen.posture.astype(np.float32)
        self._frame = seen.frame
        for name, row in rows.items():
            self._rows.setdefault(name, []).append(row)

    def track(self) -> Track:
        """Rows as arrays."""
        arrays = {name: np.array(rows) for name, rows in self._rows.items()}
        for name in ("com", "torso"):
            arrays.setdefault(name, np.zeros((0, 3)))
        for name in ("place", "torso"):
            if name in arrays:
                arrays[name][:, 2] = np.unwrap(arrays[name][:, 2])
        if self._frame is not None:
            for name in ("com_reference", "zmp_reference"):
                if name in arrays:
                    points = self._frame.transform_points(arrays[name])
                    arrays[name] = points
            arrays["landings"] = self._landings(self._frame)
        return Track(**arrays)

    def _landings(self, frame: Pose) -> Array:
        rows = [
            (
                step.landing_time,
                1.0 if step.foot is Foot.LEFT else -1.0,
                *frame.compose(step.landing),
            )
            for step in self.begun
        ]
        return np.array(rows, dtype=np.float64).reshape(-1, 5)

    def planning(self) -> Planning:
        """How the player planned."""
        times = [s.planning_time for s in self.begun]
        plans: list[ManeuverPlan] = [step.plan for step in self.begun]
        return Planning(
            len(self.begun),
            np.array([t for t in times if t is not None], dtype=np.float64),
            max((s.velocity_jump for s in self.begun), default=0.0),
            margin_of(plans),
        )
