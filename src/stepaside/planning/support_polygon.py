"""Support polygon over time, the admissible region of the ZMP.

It holds for every kind of plan: one that starts from standing begins with a
double support, and the last double support of any plan never ends, since the
robot then stands.
"""

from math import inf
from typing import NamedTuple

import numpy as np

from ..core.convex import convex_hull, half_planes
from ..core.poses import Array, Pose
from .footsteps import Foot
from .gait_settings import SoleRectangle
from .schedule import Schedule


class SupportPhase(NamedTuple):
    """Interval over which the same feet are on the floor."""

    start: float  # start time since the plan began [s]
    end: float  # end time [s]; infinite for the last phase
    rows: tuple[int, ...]  # of the placements whose feet are on the floor
    # of the hull, counter-clockwise, in the plan frame [m]. Shape (n, 2)
    corners: Array
    normals: Array  # outward unit normals of its edges. Shape (n, 2)
    # A ZMP p is in the polygon if normals p <= offsets [m]. Shape (n,)
    offsets: Array

    @property
    def single(self) -> bool:
        """Whether one foot is on the floor."""
        return len(self.rows) == 1


def support_phases(
    schedule: Schedule,
    placements: Array,
    first_foot: Foot,
    duration: float = inf,
) -> tuple[SupportPhase, ...]:
    """Return the support phases of a plan in order, without gaps.

    At the instant between two phases both apply: the foot that lands or
    lifts off is on the floor, but the ZMP already has to be under the foot
    of the single support.

    ``placements``: As in :class:`.ManeuverPlan`. Shape (count + 2, 3).
    """
    sole = schedule.settings.sole
    sides = (first_foot, first_foot.other)
    starts = schedule.starts.tolist()
    bearing = [rows for i in range(schedule.count) for rows in _step_rows(i)]
    if schedule.standing:
        bearing.insert(0, (0, 1))
    phases = []
    for i, rows in enumerate(bearing):
        if starts[i] >= duration - 1e-9:
            break
        corners = convex_hull(
            np.concatenate(
                [sole_corners(placements[r], sides[r % 2], sole) for r in rows]
            )
        )
        end = inf if i == len(bearing) - 1 else starts[i + 1]
        phase = SupportPhase(
            starts[i], end, rows, corners, *half_planes(corners)
        )
        phases.append(phase)
    return tuple(phases)


def _step_rows(step: int) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """Return the placement rows in single and double support of a step."""
    return (step + 1,), (step + 1, step + 2)


def sole_corners(pose: Array, foot: Foot, sole: SoleRectangle) -> Array:
    """Return the corners of a sole in the frame of its pose. Shape (4, 2)."""
    left = np.array(
        [
            [sole.front, sole.outer],
            [sole.back, sole.outer],
            [sole.back, -sole.inner],
            [sole.front, -sole.inner],
        ]
    )
    left[:, 1] *= foot.value
    return Pose(*pose.tolist()).transform_points(left)
