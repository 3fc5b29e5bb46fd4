"""The record of one player."""

from collections.abc import Sequence

import numpy as np

from ..control.walk_snapshots import StepStarted
from ..core.poses import Array, Pose
from ..planning import Foot, ManeuverPlan
from ..sim.push import ScheduledPush
from .player import Snapshot
from .trajectory import PlanningTimes, Trajectory, margin_of

UNKNOWN = (np.nan,) * 8


def near_rows(seen: Snapshot) -> dict[str, Sequence[float]]:
    """Rows of one snapshot, in odometry where they are asked or believed.

    Args:
        seen: Of a robot; of anybody else there are none.
    """
    if seen.walk is None or seen.stance is None:
        return {}
    walk, stance = seen.walk, seen.stance
    step = walk.step(seen.time)
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
        "estimate": UNKNOWN
        if state is None
        else (*state.com, *state.velocity, *state.zmp, *state.tilt),
    }


def place_near(arrays: dict[str, Array], frame: Pose) -> None:
    """Put what is in odometry where that is in the world.

    Args:
        arrays: By name; those of :func:`near_rows` are changed, and an
            estimate that nobody made is left out.
        frame: Pose of the odometry in the world.
    """
    if "support" not in arrays:
        return
    support, turn = arrays["support"], Pose(0.0, 0.0, frame.theta)
    support[:, 2:4] = frame.transform_points(support[:, 2:4])
    support[:, 4] += frame.theta
    arrays["heading_reference"] += frame.theta
    estimate = arrays["estimate"]
    if np.isnan(estimate).all():
        del arrays["estimate"]
        return
    estimate[:, 0:2] = frame.transform_points(estimate[:, 0:2])
    estimate[:, 2:4] = turn.transform_points(estimate[:, 2:4])
    estimate[:, 4:6] = frame.transform_points(estimate[:, 4:6])


class PlayerRecord:
    """What is known of one player, by name of what it becomes."""

    def __init__(self, closely: bool = False) -> None:
        """Begin with nothing.

        Args:
            closely: Whether to keep how its feet stand, and what it believes
                of itself.
        """
        self.begun: list[StepStarted] = []
        self._closely = closely
        self._pushes: tuple[ScheduledPush, ...] = ()
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
        if self._closely:
            rows |= near_rows(seen)
        self._frame, self._pushes = seen.frame, seen.pushes
        for name, row in rows.items():
            self._rows.setdefault(name, []).append(row)

    def cut(self, number: int) -> None:
        """Keep so many snapshots, the first ones."""
        for rows in self._rows.values():
            del rows[number:]

    def track(self) -> Trajectory:
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
            place_near(arrays, self._frame)
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
        """How the player planned."""
        times = [s.planning_time for s in self.begun]
        plans: list[ManeuverPlan] = [step.plan for step in self.begun]
        return PlanningTimes(
            len(self.begun),
            np.array([t for t in times if t is not None], dtype=np.float64),
            max((s.velocity_jump for s in self.begun), default=0.0),
            margin_of(plans),
        )
