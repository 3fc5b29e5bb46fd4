"""Floor area that a walking body sweeps."""

from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

import numpy as np

from ..core.errors import ConfigurationError
from ..core.poses import Array, Pose
from ..planning import (
    Direction,
    Foot,
    GaitSettings,
    ManeuverPlan,
    ManeuverPlanner,
)
from ..planning.schedule import Sampler, Schedule

SAMPLES = 8  # of a motion; it is nearly straight between two of them
SETTLING = 1.0  # time until the CoM is at rest after a halt, in [s]


@dataclass(frozen=True, slots=True, eq=False)
class BodyOutline:
    """Top view of a body as convex outlines of its parts."""

    # all but the feet in the walking posture, from the CoM, in the axes of the
    # mean heading of the feet [m]. Shape (n, 2)
    trunk: Array
    # corners of the left foot in its foot frame [m]. Shape (m, 2)
    left_sole: Array
    right_sole: Array  # corners of the right foot, likewise. Shape (k, 2)

    def __post_init__(self) -> None:
        """Validate the corners."""
        for name in ("trunk", "left_sole", "right_sole"):
            points = np.array(getattr(self, name), dtype=np.float64)
            if points.ndim != 2 or points.shape[1] != 2 or len(points) < 3:
                raise ConfigurationError(
                    f"{name} must be at least 3 corners x, y [m], "
                    f"got shape {points.shape}"
                )
            points.setflags(write=False)
            object.__setattr__(self, name, points)

    @property
    def radius(self) -> float:
        """Largest distance of the trunk from the CoM, in [m]."""
        return float(np.hypot(self.trunk[:, 0], self.trunk[:, 1]).max())

    def along(self, plan: ManeuverPlan, frame: Pose, part: "Part") -> Array:
        """Return the corners of the body over a part of a plan, in [m].

        In the frame in which the plan frame is given. Shape (instants, n, 2).
        """
        samples = plan.sample(_sampler(plan.schedule, part))
        left, right = samples.left_foot, samples.right_foot
        middle = 0.5 * (left[:, 2] + right[:, 2])
        body = np.concatenate(
            [
                _placed(self.trunk, samples.com, middle),
                _placed(self.left_sole, left[:, :2], left[:, 2]),
                _placed(self.right_sole, right[:, :2], right[:, 2]),
            ],
            axis=1,
        )
        corners: Array = frame.transform_points(body)
        return corners


def lateral_sway(gait: GaitSettings) -> float:
    """Return the lateral sway amplitude on a straight path, in [m]."""
    plan = ManeuverPlanner(gait).plan(
        0.0, Direction.FORWARD, first_foot=Foot.LEFT, standing=True
    )
    times = np.linspace(0.0, plan.schedule.duration, 200)
    aside = plan.sample(times).com[:, 1] - 0.5 * gait.foot_spacing
    return float(np.abs(aside).max())


Part = Literal["step", "all"]


@lru_cache(maxsize=64)
def _sampler(schedule: Schedule, part: Part) -> Sampler:
    if part == "step":
        last = schedule.first_step_duration
        return schedule.sampler(np.linspace(0.0, last, SAMPLES + 1))
    times = np.linspace(0.0, schedule.duration, SAMPLES + 1)
    return schedule.sampler(np.append(times, times[-1] + SETTLING))


def _placed(corners: Array, positions: Array, headings: Array) -> Array:
    """Return a part's corners at poses. Shape (instants, corners, 2)."""
    c, s = np.cos(headings), np.sin(headings)
    turns = np.array([[c, s], [-s, c]])  # (2, 2, instants)
    turned = np.einsum("ij,jkt->tik", corners, turns)
    placed: Array = turned + positions[:, None, :]
    return placed
