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

from ..arena import ObstacleSet
from ..core.poses import Array, Pose
from ..planning import ManeuverPlan, ManeuverPlanner
from .control_settings import StabiliserSettings
from .zmp.mpc import load_solver

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
        steps, sides = plan.placements[2:, :2], _sides(plan)
        theta = plan.placements[2:, 2]
        right = np.stack([np.sin(theta), -np.cos(theta)], axis=-1)
        half = 0.5 * plan.gait.foot_spacing * sides
        here = 0.5 * (plan.placements[0, :2] + plan.placements[1, :2])
        middles = steps + half[:, None] * right
        places = pose_plan_in_map.transform_points(np.vstack([here, middles]))
        span = float(np.hypot(*(middles - here).T).max())
        clear = solids.clearances(places)
        near = clear[0] <= self.radius + 2.0 * span
        back = Pose(0.0, 0.0, -pose_plan_in_map.theta)
        out = solids.directions_out(places[1:])[:, near]
        normals = back.transform_points(out)
        least = np.minimum(self.radius, clear[0, near]) - clear[1:, near]
        least += (normals * steps[:, None]).sum(axis=2)
        each = np.arange(len(steps))
        rows = np.zeros((*least.shape, len(steps), 2))
        rows[each, :, each] = normals
        return rows.reshape(least.size, 2 * len(steps)), least.ravel()

    def _within_reach(self, plan: ManeuverPlan) -> tuple[Array, Array, Array]:
        """Return limits on the way from one foot to the next, as rows.

        Shapes (2 count, 2 count), (2 count,), (2 count,).
        """
        gait, own = plan.gait, self._reach
        before, steps = plan.placements[1:-1], plan.placements[2:]
        c, s, side = np.cos(before[:, 2]), np.sin(before[:, 2]), _sides(plan)
        axes = np.array([[c, s], [-s * side, c * side]]).transpose(2, 0, 1)
        each = np.arange(len(steps))
        rows = np.zeros((len(steps), 2, len(steps), 2))
        rows[each, :, each] = axes
        # The first step begins at the support foot, the origin.
        rows[each[1:], :, each[:-1]] = -axes[1:]
        wanted = (axes @ (steps - before)[:, :2, None])[..., 0]
        near = 2.0 * gait.sole.inner + own.gap
        far = gait.foot_spacing + own.reach_outward
        low = np.minimum((-gait.stride, near), wanted)
        high = np.maximum((gait.stride, far), wanted)
        return rows.reshape(low.size, -1), low.ravel(), high.ravel()


def _sides(plan: ManeuverPlan) -> Array:
    """Return 1 for each left footstep and -1 for each right one."""
    sides: Array = np.ones(len(plan.placements) - 2)
    sides[1::2] = -1.0
    return plan.first_foot.value * sides
