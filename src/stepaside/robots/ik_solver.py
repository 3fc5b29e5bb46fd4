"""Moves of torso and legs towards what is asked, for one robot."""

from typing import NamedTuple

import numpy as np

from ..core.poses import Array
from .description import RobotDescription
from .ik_residuals import trace_rows
from .ik_step import trace_step
from .jit import Function, preferred
from .leg_joints import BASE, FIXED_ROWS, LegJoints
from .robot_tree import RobotTree

DAMPING = 1e-4  # squared, of the pseudo-inverse; rows in [m] and [rad]


class LegSolver(NamedTuple):
    """Formulas of one robot's legs, written out once.

    Attributes:
        legs: The legs.
        rows: Errors and Jacobian; see :func:`.leg_rows.trace_rows`.
        quick: The step itself, undamped; see :func:`.leg_step.trace_step`.
            None for legs that are not plain.
    """

    legs: LegJoints
    rows: Function
    quick: Function | None

    def linearise(self, *arguments: float) -> tuple[Array, Array]:
        """Errors and Jacobian, all in the torso frame.

        Args:
            arguments: See :class:`.leg_rows.TracedLegs`.

        Returns:
            Errors, in [m] and [rad], shape (rows,), and the Jacobian, by
            place and heading of the torso, then the free joints, shape
            (rows, 4 + free). There are 15 rows, and one for the heading of
            the torso where the legs hold it.
        """
        numbers = np.array(self.rows(*arguments))
        rows = FIXED_ROWS + self.legs.holds_heading
        return numbers[:rows], numbers[rows:].reshape(rows, -1)


_KNOWN: dict[tuple[object, ...], tuple[Function, Function | None]] = {}
KEPT = 16  # robots whose formulas are kept


def solver_of(description: RobotDescription, tree: RobotTree) -> LegSolver:
    """Solver of a robot's legs; formulas are written once for each tree."""
    legs = LegJoints.of(description, tree)
    hints = description.standing
    legs_key = (tree, legs.columns, legs.fixed, legs.sites, legs.lean > 0.0)
    key = (*legs_key, tuple(hints.items()), preferred())
    if key not in _KNOWN:
        if len(_KNOWN) >= KEPT:
            _KNOWN.clear()
        quick = trace_step(legs, hints) if legs.is_plain else None
        _KNOWN[key] = trace_rows(legs, hints), quick
    rows, step = _KNOWN[key]
    return LegSolver(legs, rows, step)


def move_within(
    jacobian: Array, error: Array, low: Array, high: Array, speeds: Array
) -> Array:
    """Move by the damped pseudo-inverse, and keep joints to their limits.

    The joint that is farthest beyond its limit goes to it and out of the
    solve: torso and other joints are asked for the best that they can do
    without it; then the next one. Were joints only held back, the torso
    would go on as if they had moved, and drag the feet along.

    Args:
        jacobian: Of the rows, by torso, then joints. Shape (rows, 4 + n).
        error: Of the rows. Shape (rows,).
        low: Least moves of the joints, in [rad]. Shape (n,).
        high: Greatest ones. Shape (n,).
        speeds: By which joints are compared, in [rad/s]. Shape (n,).

    Returns:
        Moves of the torso, in [m] and [rad], then of the joints.
        Shape (4 + n,).
    """
    fixed = np.zeros(BASE + low.size, dtype=bool)
    move = np.zeros(BASE + low.size)
    joints = move[BASE:]
    for _ in range(low.size + 1):
        rest = error - jacobian[:, fixed] @ move[fixed]
        j = jacobian[:, ~fixed]
        # (J' J + damping)^-1 J' e, which is J' (J J' + damping)^-1 e.
        square = j.T @ j + DAMPING**2 * np.eye(j.shape[1])
        move[~fixed] = np.linalg.solve(square, j.T @ rest)
        beyond = np.maximum(low - joints, joints - high) / speeds
        beyond[fixed[BASE:]] = 0.0
        most = float(beyond.max())
        if most <= 0.0:
            break
        # Legs that are mirror images reach their limits together.
        over = beyond >= most * (1.0 - 1e-9)
        joints[over] = np.clip(joints, low, high)[over]
        fixed[BASE:][over] = True
    return move
