"""Recorder of a match: one trajectory per player."""

from collections.abc import Sequence

import numpy as np

from ..core.poses import Array, Pose
from ..locomotion.walk_snapshots import StepStarted
from ..planning import Foot, ManeuverPlan
from ..sim.push import ScheduledPush
from .match import Match
from .outcome import Outcome
from .player import Player, Snapshot
from .trajectory import PlanningTimes, Trajectory, margin_of

PERIOD = 0.02  # between samples, in [s]
NO_ESTIMATE = (np.nan,) * 8


class PlayerRecord:
    """Samples of one player, as rows by name of the array.

    Attributes:
        begun: Steps that the player has begun.
    """

    def __init__(self, closely: bool = False) -> None:
        """Begin an empty record.

        Args:
            closely: Whether to record foot states and estimates.
        """
        self.begun: list[StepStarted] = []
        self._closely = closely
        self._pushes: tuple[ScheduledPush, ...] = ()
        self._rows: dict[str, list[Sequence[float] | Array]] = {}
        self._frame: Pose | None = None

    def add(self, snapshot: Snapshot) -> None:
        """Append a snapshot."""
        rows: dict[str, Sequence[float] | Array] = {
            "com": snapshot.com,
            "place": snapshot.place,
            "torso": snapshot.torso,
        }
        if snapshot.walk is not None:
            rows["com_reference"] = snapshot.walk.reference.com[:2]
            rows["zmp_reference"] = snapshot.walk.zmp_reference
        if snapshot.zmp is not None:
            rows["zmp"] = snapshot.zmp
        if snapshot.posture is not None:
            rows["qpos"] = snapshot.posture.astype(np.float32)
        if self._closely:
            rows |= _walk_rows(snapshot)
        self._frame, self._pushes = snapshot.frame, snapshot.pushes
        for name, row in rows.items():
            self._rows.setdefault(name, []).append(row)

    def truncate(self, count: int) -> None:
        """Keep only the first ``count`` snapshots."""
        for rows in self._rows.values():
            del rows[count:]

    def track(self) -> Trajectory:
        """Return the recorded trajectory."""
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
            _transform_walk_rows(arrays, self._frame)
        if self._pushes:
            arrays["pushes"] = np.array(self._pushes)
        return Trajectory(**arrays)

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

    def planning(self) -> PlanningTimes:
        """Return the planning times of the player."""
        times = [s.planning_time for s in self.begun]
        plans: list[ManeuverPlan] = [step.plan for step in self.begun]
        return PlanningTimes(
            len(self.begun),
            np.array([t for t in times if t is not None], dtype=np.float64),
            max((s.velocity_jump for s in self.begun), default=0.0),
            margin_of(plans),
        )


class Recorder:
    """Match observer that samples all players.

    Attributes:
        every: Control ticks between samples.
    """

    def __init__(
        self, players: Sequence[Player], *, tick: float, closely: bool = False
    ) -> None:
        """Record players.

        Args:
            players: The players.
            tick: Control period, in [s].
            closely: Whether to record foot states and estimates.
        """
        self.every = max(1, round(PERIOD / tick))
        self._times: list[float] = []
        self._records = {
            player.name: PlayerRecord(closely) for player in players
        }

    @property
    def times(self) -> Array:
        """Times of the samples, in [s]. Shape (n,)."""
        return np.array(self._times)

    def before(self, match: Match) -> None:
        """Take a sample when one is due."""
        if match.world.ticks % self.every == 0:
            self._sample(match)

    def acted(self, match: Match) -> None:
        """Record the steps that begin at this tick."""
        for player in match.players:
            if player.begun is not None:
                self._records[player.name].begun.append(player.begun)

    def ended(self, match: Match, outcome: Outcome) -> None:
        """Take the last sample, unless one of this instant exists."""
        for record in self._records.values():
            # An interrupt may have cut the last sample short.
            record.truncate(len(self._times))
        if not self._times or self._times[-1] < match.world.time:
            self._sample(match)

    def _sample(self, match: Match) -> None:
        for player in match.players:
            self._records[player.name].add(player.snapshot())
        self._times.append(match.world.time)

    def tracks(self) -> dict[str, Trajectory]:
        """Return the trajectories recorded so far, by name of the player."""
        return {name: rec.track() for name, rec in self._records.items()}

    def planning(self) -> dict[str, PlanningTimes]:
        """Return the planning times, by name of the player."""
        return {name: rec.planning() for name, rec in self._records.items()}


def _walk_rows(snapshot: Snapshot) -> dict[str, Sequence[float]]:
    """Return foot states and estimates of a robot; none of other players.

    Planned and estimated quantities are in odometry, others in the world.
    """
    if snapshot.walk is None or snapshot.stance is None:
        return {}
    walk, stance = snapshot.walk, snapshot.stance
    step = walk.step(snapshot.time)
    foot = step.swing.other
    single = float(step.walking and step.remaining > 0.0)
    state = walk.estimate
    left = foot is Foot.LEFT
    return {
        "velocity": stance.velocity,
        "tilt": stance.tilt,
        "sole": stance.left_sole if left else stance.right_sole,
        "support": (foot.value, single, *step.support),
        "heading_reference": (walk.torso_heading,),
        "estimate": NO_ESTIMATE
        if state is None
        else (*state.com, *state.velocity, *state.zmp, *state.tilt),
    }


def _transform_walk_rows(arrays: dict[str, Array], frame: Pose) -> None:
    """Transform planned and estimated quantities to the world, in place.

    Args:
        arrays: Arrays of :func:`_walk_rows`, by name; an estimate that is
            NaN throughout is dropped.
        frame: Pose of the odometry in the world.
    """
    if "support" not in arrays:
        return
    support, rotation = arrays["support"], Pose(0.0, 0.0, frame.theta)
    support[:, 2:4] = frame.transform_points(support[:, 2:4])
    support[:, 4] += frame.theta
    arrays["heading_reference"] += frame.theta
    estimate = arrays["estimate"]
    if np.isnan(estimate).all():
        del arrays["estimate"]
        return
    estimate[:, 0:2] = frame.transform_points(estimate[:, 0:2])
    estimate[:, 2:4] = rotation.transform_points(estimate[:, 2:4])
    estimate[:, 4:6] = frame.transform_points(estimate[:, 4:6])
