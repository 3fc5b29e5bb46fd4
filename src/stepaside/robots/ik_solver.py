"""Inverse kinematics solver of one robot: formulas and joint limits."""

from typing import NamedTuple

import numpy as np

from ..core.errors import ModelError
from ..core.poses import Array
from .description import RobotDescription
from .expression_tracing import Function
from .ik_residuals import trace_residuals
from .ik_step import Steps, compile_steps, trace_step
from .kept_formulas import kept_formula
from .leg_joints import BASE, FIXED_ROWS, LegJoints
from .robot_tree import RobotTree

DAMPING = 1e-4  # squared, of the pseudo-inverse; rows in [m] and [rad]
CACHE_SIZE = 16  # robots whose formulas are cached


class LegSolver(NamedTuple):
    """Generated formulas of one robot's legs.

    Attributes:
        legs: Leg joints.
        residuals: Residuals and Jacobian; see
            :func:`.ik_residuals.trace_residuals`.
        track_rows: Undamped Newton steps of many ticks; see
            :func:`.ik_step.compile_steps`. None for legs other than six
            hinges each.
    """

    legs: LegJoints
    residuals: Function
    track_rows: Steps | None

    def linearise(self, *arguments: float) -> tuple[Array, Array]:
        """Evaluate residuals and Jacobian in the level torso frame.

        Args:
            arguments: See :class:`.ik_residuals.TracedLegs`.

        Returns:
            Residuals, in [m] and [rad], shape (rows,), and the Jacobian by
            translation and heading of the torso, then the free joints,
            shape (rows, 4 + free). There are 15 rows, and one for the torso
            heading if the legs can hold it.
        """
        numbers = np.array(self.residuals(*arguments))
        rows = FIXED_ROWS + self.legs.holds_heading
        return numbers[:rows], numbers[rows:].reshape(rows, -1)


_Formulas = tuple[Function, Steps | None]
_cache: dict[tuple[object, ...], _Formulas] = {}


def solver_of(description: RobotDescription, tree: RobotTree) -> LegSolver:
    """Return the solver of a robot; formulas are cached by tree."""
    legs = LegJoints.of(description, tree)
    hints = description.standing
    key = (*legs.key, tuple(hints.items()))
    if key not in _cache:
        if len(_cache) >= CACHE_SIZE:
            _cache.clear()
        steps = None
        if legs.is_plain:
            try:
                formula = kept_formula("leg_step", legs, trace_step, hints)
            except ZeroDivisionError as error:
                raise ModelError(
                    f"the legs of {description.name} cannot place both feet: "
                    "joints that follow each other must not turn about "
                    "parallel axes"
                ) from error
            steps = compile_steps(formula, legs)
        rows = kept_formula("leg_rows", legs, trace_residuals, hints)
        _cache[key] = rows.function(), steps
    return LegSolver(legs, *_cache[key])


def move_within(
    jacobian: Array, error: Array, low: Array, high: Array, speeds: Array
) -> Array:
    """Solve a damped least-squares step within joint limits (active set).

    The joint farthest beyond its limit is fixed there and leaves the
    problem, which is solved again for the torso and the other joints; then
    the next one. Clipping joints alone would move the torso as if they had
    followed, and drag the feet along.

    Args:
        jacobian: Columns of the torso, then of the joints.
            Shape (rows, 4 + n).
        error: Residuals. Shape (rows,).
        low: Least moves of the joints, in [rad]. Shape (n,).
        high: Greatest moves of the joints, in [rad]. Shape (n,).
        speeds: Speed limits, by which excesses are compared, in [rad/s].
            Shape (n,).

    Returns:
        Move of the torso, in [m] and [rad], then of the joints, in [rad].
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
        # Mirror-image legs reach their limits together.
        over = beyond >= most * (1.0 - 1e-9)
        joints[over] = np.clip(joints, low, high)[over]
        fixed[BASE:][over] = True
    return move
