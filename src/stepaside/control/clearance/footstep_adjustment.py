r"""Adjustment of footsteps to half planes that keep clear of obstacles.

An alternative to predictive search, following the sequel of the paper (De
Simone et al., IROS 2017): orientations are chosen first, and then footsteps
:math:`p_i` as close to the planned ones :math:`p_i^*` as the half planes
allow,

.. math:: \min_p \sum_i \lVert (p_i - p_{i-1}) - (p_i^* - p_{i-1}^*) \rVert^2,
   \qquad n_{ij} \cdot m_i \ge n_{ij} \cdot q_{ij} + r, \qquad
   R_{i-1}^T (p_i - p_{i-1}) \in K,

with one half plane for each footstep i and each obstacle j within range.
:math:`m_i` lies half a foot spacing beside :math:`p_i`, midway between the
feet; :math:`q_{ij}` is the obstacle point closest to the planned
:math:`m_i`, and :math:`n_{ij}` points from it to that planned :math:`m_i`.
r is the clearance that the body requires, or its present clearance if that
is smaller, and K is the reachable region of a leg.
"""

import numpy as np

from ...arena import ObstacleSet
from ...core.poses import Array, Pose
from ...locomotion.zmp.control_settings import StabiliserSettings
from ...locomotion.zmp.mpc import load_solver
from ...planning import GaitSettings, ManeuverPlan, ManeuverPlanner

SOLVED = 1  # smallest exit flag of the solver for a solution
NEGLIGIBLE = 1e-9  # violation that is tolerated, in [m]


class FootstepAdjustment:
    """Moves the footsteps of plans away from obstacles."""

    def __init__(
        self,
        planner: ManeuverPlanner,
        reach: StabiliserSettings,
        radius: float,
    ) -> None:
        """Prepare the adjustment for one gait."""
        self._planner, self._reach = planner, reach
        self._solver = load_solver()
        self.radius = radius  # [m]

    def adjust(
        self, plan: ManeuverPlan, pose_plan_in_map: Pose, solids: ObstacleSet
    ) -> ManeuverPlan:
        """Return the plan with footsteps that keep clear, if they exist.

        ``pose_plan_in_map``: Pose of the plan frame in the frame of
        ``solids``. The plan itself if its footsteps keep clear already, and
        also if no reachable footsteps do: the guard checks the result.
        """
        steps = plan.placements[2:]
        rows, least = self._half_planes(plan, pose_plan_in_map, solids)
        if (
            not len(least)
            or (rows @ steps[:, :2].ravel() >= least - NEGLIGIBLE).all()
        ):
            return plan
        reached, low, high = self._within_reach(plan)
        count = len(steps)
        along = np.kron(np.eye(count) - np.eye(count, k=-1), np.eye(2))
        cost = along.T @ along
        found, _, flag, _ = self._solver.solve(
            cost,
            -cost @ steps[:, :2].ravel(),
            np.concatenate([rows, reached]),
            np.concatenate([np.full(len(rows), np.inf), high]),
            np.concatenate([least, low]),
            np.zeros(len(rows) + len(reached), dtype=np.int32),
        )
        if flag < SOLVED:
            return plan
        placements = plan.placements.copy()
        placements[2:, :2] = found.reshape(count, 2)
        return self._planner.placed(plan, placements)

    def _half_planes(
        self, plan: ManeuverPlan, pose_plan_in_map: Pose, solids: ObstacleSet
    ) -> tuple[Array, Array]:
        """Return the half planes as rows and lower bounds on all footsteps.

        Shapes (m, 2 count), (m,).
        """
        beside = _offsets_to_middle(plan)
        here = 0.5 * (plan.placements[0, :2] + plan.placements[1, :2])
        middles = plan.placements[2:, :2] + beside
        places = pose_plan_in_map.transform_points(np.vstack([here, middles]))
        back, count = Pose(0.0, 0.0, -pose_plan_in_map.theta), len(middles)
        span = float(np.hypot(*(middles - here).T).max())
        rows: list[Array] = []
        least: list[float] = []
        clear = solids.clearances(places)
        out = solids.directions_out(places[1:])
        for n, now in enumerate(clear[0].tolist()):
            if now > self.radius + 2.0 * span:
                continue
            away, normals = clear[1:, n], back.transform_points(out[:, n])
            keeps = min(self.radius, now)
            for i in range(count):
                row = np.zeros((count, 2))
                row[i] = normals[i]
                rows.append(row.ravel())
                least.append(
                    keeps
                    - float(away[i])
                    + float(normals[i] @ plan.placements[i + 2, :2])
                )
        return np.array(rows).reshape(-1, 2 * count), np.array(least)

    def _within_reach(self, plan: ManeuverPlan) -> tuple[Array, Array, Array]:
        """Return the limits on the displacement from one foot to the next.

        Rows on all footsteps, with lower and upper bounds. Shapes (2 count, 2
        count), (2 count,), (2 count,).
        """
        gait, own = plan.gait, self._reach
        before, steps = plan.placements[1:-1], plan.placements[2:]
        count = len(steps)
        c, s = np.cos(before[:, 2]), np.sin(before[:, 2])
        side = plan.first_foot.value * (-1.0) ** np.arange(count)
        ahead = np.stack([c, s], axis=-1)
        out = np.stack([-s * side, c * side], axis=-1)
        rows = np.zeros((2 * count, count, 2))
        low, high = np.zeros(2 * count), np.zeros(2 * count)
        near, far = (
            _least_distance(gait, own),
            gait.foot_spacing + own.reach_outward,
        )
        for i in range(count):
            for n, (axis, least, most) in enumerate(
                ((ahead, -gait.stride, gait.stride), (out, near, far))
            ):
                at = 2 * i + n
                rows[at, i] = axis[i]
                if i:
                    rows[at, i - 1] = -axis[i]
                wanted = axis[i] @ (steps[i, :2] - before[i, :2])
                low[at], high[at] = min(least, wanted), max(most, wanted)
        # The first step begins at the support foot, the origin.
        return rows.reshape(2 * count, 2 * count), low, high


def _least_distance(gait: GaitSettings, own: StabiliserSettings) -> float:
    """Return the least coronal distance between the feet, in [m]."""
    return 2.0 * gait.sole.inner + own.gap


def _offsets_to_middle(plan: ManeuverPlan) -> Array:
    """Return offsets from footsteps to mid-feet, in [m]. Shape (count, 2)."""
    theta = plan.placements[2:, 2]
    side = plan.first_foot.value * (-1.0) ** np.arange(len(theta))
    half = 0.5 * plan.gait.foot_spacing * side
    found: Array = np.stack([np.sin(theta), -np.cos(theta)], axis=-1)
    found *= half[:, None]
    return found
