"""One Newton step of the joint motion, written out for one robot.

Each leg has six joints, and the pose of its foot six rows: the joints
follow from the torso's motion by a solve of its own. What is left are four
unknowns of the torso (a level one) and four rows: the CoM, and that the
legs agree about the joint that they share; where they share none, the
torso's heading.
"""

from collections.abc import Callable
from typing import NamedTuple

from .expression_tracing import Number
from .ik_residuals import HEADING, UP, TracedLegs
from .leg_joints import LegJoints
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


class _Leg(NamedTuple):
    """One leg, solved for its joints.

    Attributes:
        jacobian: Factors of the transposed Jacobian of its foot.
        asked: Twist that the foot has to make at the hip.
        hip: Place of the hip, which twists refer to, in [m].
        rows: Rates by twist of the foot: momentum of the leg, and of the
            joint that it shares. Shape (4, 6).
    """

    jacobian: LuFactors
    asked: Vector
    hip: Vector
    rows: Matrix


def trace_step(
    legs: LegJoints, hints: dict[str, float]
) -> Callable[..., tuple[float, ...]]:
    """Write out the step.

    Args:
        legs: The legs; :attr:`Legs.is_plain` has to be true.
        hints: A usual posture, by joint, in [rad].

    Returns:
        A function of the arguments of :class:`.leg_rows.TracedLegs`. It
        gives the move (x, y, z) of the torso in its own frame, in [m], its
        turn, in [rad], and those of the free joints; then place and heading
        of the torso and the angles of the free joints after that. It
        raises ZeroDivisionError where the legs are singular.
    """
    traced = TracedLegs.of(legs, hints)
    left, right = _solve_leg(traced, 0), _solve_leg(traced, 1)
    moments = traced.moments
    mass = moments.masses[0]
    # Momentum: mass (v + turn x CoM) + what the legs add = what is asked.
    spun = cross(UP, traced.first_moment)
    matrix: list[list[Number]] = []
    for row in range(3):
        along = [mass if k == row else 0.0 for k in range(3)]
        matrix.append([*along, spun[row]])
    wanted = scale(mass, traced.com_error)
    for leg in (left, right):
        for row in range(3):
            matrix[row] = subtract(matrix[row], _by_torso(leg, row))
            wanted[row] = wanted[row] - dot(leg.rows[row], leg.asked)
    if legs.holds_heading:
        matrix.append(list(HEADING))
        wanted.append(traced.heading_error)
    else:
        matrix.append(subtract(_by_torso(left, 3), _by_torso(right, 3)))
        shares = [dot(leg.rows[3], leg.asked) for leg in (left, right)]
        wanted.append(shares[0] - shares[1])
    torso = LuFactors(matrix).solve(wanted)
    moves: list[Number] = [0.0] * len(legs.free)
    for side, leg in enumerate((left, right)):
        twist = subtract(leg.asked, _twist(leg.hip, torso))
        found = leg.jacobian.solve_transposed(twist)
        for link, move in zip(legs.chain(side), found, strict=True):
            column = legs.columns[link]
            assert column is not None
            moves[column] = move
    after = [*traced.torso.moved(torso), *add(traced.free, moves)]
    return traced.trace.function("leg_step", [*torso, *moves, *after])


def _solve_leg(traced: TracedLegs, side: int) -> _Leg:
    legs, placed = traced.legs, traced.placed
    chain = legs.chain(side)
    # Where hip axes meet, hip joints do not move this point: zeros.
    hip = placed.places[chain[2]]
    error = traced.foot_error(side)
    lever = subtract(hip, error.place)
    move = add(error.move, cross(error.turn, lever))
    motions = [motion_of(placed, traced.moments, i, hip) for i in chain]
    jacobian = LuFactors([[*m.linear, *m.angular] for m in motions])
    rows = [
        jacobian.solve([m.moment[axis] for m in motions]) for axis in range(3)
    ]
    shared = _shared(legs)
    unit = [float(legs.columns[link] == shared) for link in chain]
    rows.append(jacobian.solve(unit))
    return _Leg(jacobian, [*move, *error.turn], hip, rows)


def _shared(legs: LegJoints) -> int | None:
    """Number of the free joint that both legs have, if they share one."""
    columns = [{legs.columns[i] for i in legs.chain(side)} for side in (0, 1)]
    both = columns[0] & columns[1]
    return both.pop() if both else None


def _twist(hip: Vector, torso: Vector) -> list[Number]:
    """Twist of a hip by velocity and turning of the torso."""
    angular = scale(torso[3], UP)
    return [*add(torso[:3], cross(angular, hip)), *angular]


def _by_torso(leg: _Leg, row: int) -> list[Number]:
    """A row of a leg by velocity and turning of the torso."""
    rates = leg.rows[row]
    by_turn = dot(rates[:3], cross(UP, leg.hip)) + rates[5]
    return [*rates[:3], by_turn]
