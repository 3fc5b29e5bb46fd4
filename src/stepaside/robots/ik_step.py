"""Newton step of inverse kinematics, generated for one robot.

Each leg has six joints and its foot six rows, so that a 6 x 6 solve
eliminates the joints of a leg. Four unknowns of the torso remain, with four
rows: the CoM, and equality of the joint that both legs share or, without
such a joint, the torso heading.
"""

from collections.abc import Callable
from typing import NamedTuple

from ..core.poses import Array
from .expression_tracing import Formula, Number
from .ik_residuals import HEADING, UP, TracedLegs
from .leg_joints import BASE, LegJoints
from .link_poses import motion_of
from .scalar_algebra import (
    LuFactors,
    Matrix,
    Vector,
    add,
    cross,
    dot,
    scale,
    subtract,
)

# Motion of the torso in a tick beyond which the undamped step is rejected,
# in [m] or [rad].
GREATEST_MOVE = 0.1
Steps = Callable[[Array, Array, Array, float], int]
LOOP = """\
def track_rows(references, states, limits, slowest):
    n = limits.shape[0]
    for i in range(references.shape[0]):
        step = leg_step({arguments})
        for j in range(4):
            if not abs(step[j]) < {greatest_move}:
                return i
        most = least = step[4]
        for j in range(5, n + 4):
            most = max(most, step[j])
            least = min(least, step[j])
        greatest = max(most, -least)
        margin = states[i, n + 5] - greatest
        if not (greatest <= slowest and margin >= 0.0):
            margin = 1e300
            for j in range(n):
                move, angle = step[4 + j], step[n + 8 + j]
                reach, low, high = limits[j, 0], limits[j, 1], limits[j, 2]
                if not (-reach <= move <= reach and low <= angle <= high):
                    return i
                margin = min(margin, angle - low, high - angle)
        for j in range(n):
            states[i + 1, j] = step[n + 8 + j]
        for j in range(4):
            states[i + 1, n + j] = step[n + 4 + j]
        states[i + 1, n + 4] = states[i, n + 3]
        states[i + 1, n + 5] = margin
        states[i + 1, n + 6] = references[i, 15]
    return references.shape[0]
"""


class _EliminatedLeg(NamedTuple):
    """One leg whose joints are eliminated.

    Attributes:
        jacobian: Factors of the transposed Jacobian of the foot.
        twist: Twist error of the foot, referred to the hip.
        hip: Position of the hip, in [m].
        rows: Gradients by the foot twist: of the momentum of the leg, and of
            the shared joint. Shape (4, 6).
    """

    jacobian: LuFactors
    twist: Vector
    hip: Vector
    rows: Matrix


def trace_step(legs: LegJoints, hints: dict[str, float]) -> Formula:
    """Generate the function of one Newton step.

    Args:
        legs: Leg joints, with :attr:`LegJoints.is_plain` true.
        hints: A typical posture, by joint, in [rad].

    Returns:
        Function of the arguments of :class:`.ik_residuals.TracedLegs`. Its
        results are the move (x, y, z) of the torso in its own frame, in
        [m], its rotation, in [rad], and the moves of the free joints, in
        [rad]; then position and heading of the torso and the angles of the
        free joints after the step. It raises ZeroDivisionError if the legs
        are singular.
    """
    traced = TracedLegs.of(legs, hints)
    left, right = _eliminate_leg(traced, 0), _eliminate_leg(traced, 1)
    moments = traced.moments
    mass = moments.masses[0]
    # Momentum: mass (v + w x CoM) + momentum of the legs = mass CoM error.
    spun = cross(UP, traced.first_moment)
    matrix: list[list[Number]] = []
    for row in range(3):
        along = [mass if k == row else 0.0 for k in range(3)]
        matrix.append([*along, spun[row]])
    right_side = scale(mass, traced.com_error)
    for leg in (left, right):
        for row in range(3):
            matrix[row] = subtract(matrix[row], _torso_gradient(leg, row))
            right_side[row] = right_side[row] - dot(leg.rows[row], leg.twist)
    if legs.holds_heading:
        matrix.append(list(HEADING))
        right_side.append(traced.heading_error)
    else:
        matrix.append(
            subtract(_torso_gradient(left, 3), _torso_gradient(right, 3))
        )
        shared = [dot(leg.rows[3], leg.twist) for leg in (left, right)]
        right_side.append(shared[0] - shared[1])
    torso = LuFactors(matrix).solve(right_side)
    moves: list[Number] = [0.0] * len(legs.free)
    for side, leg in enumerate((left, right)):
        twist = subtract(leg.twist, _hip_twist(leg.hip, torso))
        joint_moves = leg.jacobian.solve_transposed(twist)
        for link, move in zip(legs.chain(side), joint_moves, strict=True):
            column = legs.columns[link]
            assert column is not None
            moves[column] = move
    after = [*traced.torso.moved(torso), *add(traced.free, moves)]
    return traced.trace.formula("leg_step", [*torso, *moves, *after])


def compile_steps(formula: Formula, legs: LegJoints) -> Steps:
    """Compile the steps of many ticks, up to one that meets a limit.

    Args:
        formula: The step, of :func:`trace_step`.
        legs: Leg joints.

    Returns:
        Function of the references, rows of :meth:`.BodyReference.row` with
        the roll of the torso; the states, rows of :class:`.LegStates` of
        which the first is given; reach in a tick, lower and upper limit of
        the free joints, shape (free, 3); and the least reach. It fills the
        states and returns how many ticks keep to all limits.
    """
    steps: Steps = formula.loop("track_rows", step_loop(legs))
    return steps


def step_loop(legs: LegJoints) -> str:
    """Return the source of the loop of :func:`compile_steps`."""
    n = len(legs.free)
    states = [f"states[i, {j}]" for j in range(n + BASE)]
    columns = 15 + (legs.lean > 0.0)
    references = [f"references[i, {j}]" for j in range(columns)]
    return LOOP.format(
        arguments=", ".join([*states, *references]),
        greatest_move=GREATEST_MOVE,
    )


def _eliminate_leg(traced: TracedLegs, side: int) -> _EliminatedLeg:
    legs, links = traced.legs, traced.links
    chain = legs.chain(side)
    # Hip joints with intersecting axes do not move this point: zeros.
    hip = links.positions[chain[2]]
    error = traced.foot_error(side)
    lever = subtract(hip, error.position)
    translation = add(error.translation, cross(error.rotation, lever))
    motions = [motion_of(links, traced.moments, i, hip) for i in chain]
    jacobian = LuFactors([[*m.linear, *m.angular] for m in motions])
    rows = [
        jacobian.solve([m.moment[axis] for m in motions]) for axis in range(3)
    ]
    shared = _shared_joint(legs)
    unit = [float(legs.columns[link] == shared) for link in chain]
    rows.append(jacobian.solve(unit))
    twist = [*translation, *error.rotation]
    return _EliminatedLeg(jacobian, twist, hip, rows)


def _shared_joint(legs: LegJoints) -> int | None:
    """Return the index of the free joint that both legs share, if any."""
    columns = [{legs.columns[i] for i in legs.chain(side)} for side in (0, 1)]
    both = columns[0] & columns[1]
    return both.pop() if both else None


def _hip_twist(hip: Vector, torso: Vector) -> list[Number]:
    """Return the twist of a hip that moves with the torso."""
    angular = scale(torso[3], UP)
    return [*add(torso[:3], cross(angular, hip)), *angular]


def _torso_gradient(leg: _EliminatedLeg, row: int) -> list[Number]:
    """Return the gradient of a row of a leg by the motion of the torso."""
    rates = leg.rows[row]
    by_rotation = dot(rates[:3], cross(UP, leg.hip)) + rates[5]
    return [*rates[:3], by_rotation]
