"""Newton steps of the legs of any robot (paper, Sec. III-A).

Unknowns are the free leg joints, then position and heading of the torso,
whose roll is given. Rows are position and rotation of both feet and the
CoM and, for legs with independent hip yaws, the torso heading. All vectors
are in the frame of the reference.
"""

from collections.abc import Sequence
from math import cos, remainder, sin, tau
from typing import Any, NamedTuple

import numpy as np

from ..core.compilation import compiled, inlined
from ..core.poses import Array
from .joint_tree import JointTree, place_frame, place_links, turned


@inlined
def torso_roll(row: Sequence[float] | Array, lean: float) -> float:
    """Return the roll of a torso; see :meth:`BodyReference.roll`."""
    if lean == 0.0:
        return 0.0
    c, s = cos(row[6]) + cos(row[10]), sin(row[6]) + sin(row[10])
    x, y = row[0] - 0.5 * (row[3] + row[7]), row[1] - 0.5 * (row[4] + row[8])
    apart = c * (row[4] - row[8]) - s * (row[3] - row[7])
    return -2.0 * lean * (c * y - s * x) / apart


class BodyReference(NamedTuple):
    """Desired CoM and feet at one instant, all in one level frame."""

    com: tuple[float, float, float]  # CoM (x, y, z) [m]
    # left foot (x, y, z, yaw) [m] and [rad]
    left_foot: tuple[float, float, float, float]
    right_foot: tuple[float, float, float, float]  # right foot, likewise
    # roll and pitch of the left foot in the frame of its heading [rad]; small
    # angles
    left_tilt: tuple[float, float] = (0.0, 0.0)
    # roll and pitch of the right foot, likewise
    right_tilt: tuple[float, float] = (0.0, 0.0)

    def row(self) -> tuple[float, ...]:
        """Return the 15 numbers of the fields, one after the other."""
        com, left, right, left_tilt, right_tilt = self
        return (*com, *left, *right, *left_tilt, *right_tilt)

    @classmethod
    def from_row(cls, row: Sequence[float]) -> "BodyReference":
        """Return the reference of a row; see :meth:`row`."""
        own: Any = tuple(row)
        return cls(own[:3], own[3:7], own[7:11], own[11:13], own[13:])

    @property
    def heading(self) -> float:
        """Mean heading of the feet, in [rad]."""
        left, right = self.left_foot[3], self.right_foot[3]
        return left + 0.5 * remainder(right - left, tau)

    def roll(self, lean: float) -> float:
        """Return the roll [rad] of a torso that leans over the stance foot.

        It is proportional to the lateral position of the CoM: zero midway
        between the feet, ``lean`` with the CoM over one of them.
        """
        return torso_roll(self.row(), lean)


FIXED_ROWS = 15  # of two feet and the CoM
BASE = 4  # unknowns of the torso
STATE = 6  # columns of a state beside the joints; see LegStates
DAMPING = 1e-8  # of the squared rows, in [m^2] and [rad^2]
SINGULAR = 1e-12  # pivot below which a matrix has no inverse
# Motion of the torso in a tick beyond which the undamped step is rejected,
# in [m] or [rad].
GREATEST_MOVE = 0.1


@inlined
def motion_by(
    tree: JointTree,
    axes: Array,
    places: Array,
    link: int,
    point: tuple[float, float, float],
) -> tuple[float, float, float, float, float, float]:
    """Return velocity and rate of a point by a joint at unit speed."""
    a, b, c = turned(axes, link, tree.axes, link)
    if not tree.hinges[link]:
        return a, b, c, 0.0, 0.0, 0.0
    x, y, z = point
    u, v, w = x - places[link, 0], y - places[link, 1], z - places[link, 2]
    return b * w - c * v, c * u - a * w, a * v - b * u, a, b, c


@compiled
def linearise(
    tree: JointTree,
    reference: Array,
    state: Array,
    roll: float,
    errors: Array,
    jacobian: Array,
) -> None:
    """Set the residuals [m, rad] of all rows, and their Jacobian.

    Columns of the Jacobian are the free joints, then the torso.
    """
    n, links = state.shape[0] - STATE, tree.parents.shape[0]
    axes, places = np.empty((links, 3, 3)), np.empty((links, 3))
    position, heading = state[n : n + 3], state[n + 3]
    place_links(tree, state, position, heading, roll, axes, places)
    for row in range(jacobian.shape[0]):
        for column in range(jacobian.shape[1]):
            jacobian[row, column] = 0.0
    for side in range(2):
        _add_foot(tree, reference, axes, places, side, errors, jacobian)
    # Mass and first moment of all that each joint carries.
    masses, moments = np.empty(links), np.empty((links, 3))
    for link in range(links):
        masses[link] = tree.masses[link]
        moment = turned(axes, link, tree.moments, link)
        for k in range(3):
            moments[link, k] = moment[k] + masses[link] * places[link, k]
    for link in range(links - 1, 0, -1):
        parent = tree.parents[link]
        masses[parent] += masses[link]
        for k in range(3):
            moments[parent, k] += moments[link, k]
    mass = masses[0]
    for k in range(3):
        errors[12 + k] = reference[k] - moments[0, k] / mass
        jacobian[12 + k, n + k] = 1.0
    jacobian[12, n + 3] = places[0, 1] - moments[0, 1] / mass
    jacobian[13, n + 3] = moments[0, 0] / mass - places[0, 0]
    for link in range(1, links):
        j = tree.columns[link]
        if j >= 0 and masses[link] > 0.0:
            share, own = masses[link] / mass, 1.0 / masses[link]
            point = (
                own * moments[link, 0],
                own * moments[link, 1],
                own * moments[link, 2],
            )
            u, v, w, _, _, _ = motion_by(tree, axes, places, link, point)
            jacobian[12, j] += share * u
            jacobian[13, j] += share * v
            jacobian[14, j] += share * w
    if errors.shape[0] > FIXED_ROWS:
        # Tangent of the way to the mean heading, whatever full turns.
        left, right = reference[6] - heading, reference[10] - heading
        errors[15] = (sin(left) + sin(right)) / (cos(left) + cos(right))
        jacobian[15, n + 3] = 1.0


@compiled
def _add_foot(
    tree: JointTree,
    reference: Array,
    axes: Array,
    places: Array,
    side: int,
    errors: Array,
    jacobian: Array,
) -> None:
    """Set the six rows of the left (0) or right (1) foot."""
    at, n = 6 * side, jacobian.shape[1] - BASE
    frame, place = np.empty((3, 3)), np.empty(3)
    place_frame(tree, side, axes, places, frame, place)
    x, y, z = place[0], place[1], place[2]
    goal, tilt = 3 + 4 * side, 11 + 2 * side
    errors[at] = reference[goal] - x
    errors[at + 1] = reference[goal + 1] - y
    errors[at + 2] = reference[goal + 2] - z
    # Small rotation to the level frame with the yaw of the reference, half
    # the sum of the cross products of the axes with their goals; and tilts.
    c, s = cos(reference[goal + 3]), sin(reference[goal + 3])
    ahead, left = frame[2, 0], frame[2, 1]
    level_x = 0.5 * (frame[1, 2] - ahead * s - left * c)
    level_y = 0.5 * (ahead * c - left * s - frame[0, 2])
    errors[at + 3] = level_x + c * reference[tilt] - s * reference[tilt + 1]
    errors[at + 4] = level_y + s * reference[tilt] + c * reference[tilt + 1]
    along, across = frame[0, 0] + frame[1, 1], frame[0, 1] - frame[1, 0]
    errors[at + 5] = 0.5 * (along * s + across * c)
    for k in range(3):
        jacobian[at + k, n + k] = 1.0
    jacobian[at, n + 3] = places[0, 1] - y
    jacobian[at + 1, n + 3] = x - places[0, 0]
    jacobian[at + 5, n + 3] = 1.0
    link = tree.carriers[side]
    while link > 0:
        j = tree.columns[link]
        if j >= 0:
            u, v, w, a, b, d = motion_by(tree, axes, places, link, (x, y, z))
            jacobian[at, j] += u
            jacobian[at + 1, j] += v
            jacobian[at + 2, j] += w
            jacobian[at + 3, j] += a
            jacobian[at + 4, j] += b
            jacobian[at + 5, j] += d
        link = tree.parents[link]


@compiled
def solve(matrix: Array, right: Array) -> bool:
    """Solve a square system in place, into ``right``; return whether so."""
    n = right.shape[0]
    for k in range(n):
        pivot, most = k, abs(matrix[k, k])
        for i in range(k + 1, n):
            if abs(matrix[i, k]) > most:
                pivot, most = i, abs(matrix[i, k])
        if not most > SINGULAR:
            return False
        if pivot != k:
            for j in range(k, n):
                kept = matrix[k, j]
                matrix[k, j] = matrix[pivot, j]
                matrix[pivot, j] = kept
            right[k], right[pivot] = right[pivot], right[k]
        inverse = 1.0 / matrix[k, k]
        for i in range(k + 1, n):
            factor = matrix[i, k] * inverse
            if factor != 0.0:
                for j in range(k + 1, n):
                    matrix[i, j] -= factor * matrix[k, j]
                right[i] -= factor * right[k]
    for k in range(n - 1, -1, -1):
        total = right[k]
        for j in range(k + 1, n):
            total -= matrix[k, j] * right[j]
        right[k] = total / matrix[k, k]
    return True


@compiled
def keeps_limits(step: Array, state: Array, limits: Array) -> bool:
    """Return whether a step keeps to all limits; see :func:`newton_steps`."""
    n = limits.shape[0]
    for j in range(n):
        low, high, reach = limits[j, 0], limits[j, 1], limits[j, 3]
        angle = state[j] + step[j]
        if not (abs(step[j]) <= reach and low <= angle <= high):
            return False
    for j in range(n, n + BASE):
        if not abs(step[j]) < GREATEST_MOVE:
            return False
    return True


@compiled
def move_within(
    jacobian: Array,
    errors: Array,
    state: Array,
    limits: Array,
    matrix: Array,
    step: Array,
) -> None:
    """Set a damped least-squares step within joint limits (active set).

    The joint farthest beyond its limit is fixed there and leaves the
    problem, which is solved again for the torso and the other joints; then
    the next one. Clipping joints alone would move the torso as if they had
    followed, and drag the feet along. ``matrix`` is changed.
    """
    rows, unknowns = jacobian.shape
    n = limits.shape[0]
    held, low, high = np.full(n, np.nan), np.empty(n), np.empty(n)
    for j in range(n):
        reach = limits[j, 3]
        low[j] = min(max(limits[j, 0] - state[j], -reach), reach)
        high[j] = min(max(limits[j, 1] - state[j], -reach), reach)
    for _ in range(n + 1):
        for i in range(unknowns):
            step[i] = 0.0
            for row in range(rows):
                step[i] += jacobian[row, i] * errors[row]
            for k in range(unknowns):
                matrix[i, k] = 0.0
                for row in range(rows):
                    matrix[i, k] += jacobian[row, i] * jacobian[row, k]
            matrix[i, i] += DAMPING
        for j in range(n):
            if held[j] == held[j]:
                for k in range(unknowns):
                    matrix[j, k] = 0.0
                matrix[j, j] = 1.0
                step[j] = held[j]
        solve(matrix, step)
        most = 0.0
        for j in range(n):
            if held[j] != held[j]:
                beyond = max(low[j] - step[j], step[j] - high[j])
                most = max(most, beyond / limits[j, 2])
        if not most > 0.0:
            break
        for j in range(n):
            beyond = max(low[j] - step[j], step[j] - high[j])
            # Mirror-image legs reach their limits together.
            if beyond >= most * (1.0 - 1e-9) * limits[j, 2]:
                if held[j] != held[j]:
                    held[j] = min(max(step[j], low[j]), high[j])


@compiled
def newton_steps(
    tree: JointTree,
    limits: Array,
    lean: float,
    direct: bool,
    greatest: float,
    references: Array,
    states: Array,
    errors: Array,
) -> int:
    """Track references by one step a tick; return how many are in reach.

    The step of Newton's method is taken if rows match unknowns and it meets
    all limits, else the damped one: near singularities the first is too
    long. Limits (free, 4) are lower and upper limit, speed limit and greatest
    move in a tick; states (ticks + 1, free + 6) are :class:`.LegStates`, of
    which the first is given. A damped step is refused beyond the greatest
    residual. ``errors`` are residuals before the last step.
    """
    n = states.shape[1] - STATE
    rows, unknowns = errors.shape[0], n + BASE
    jacobian = np.empty((rows, unknowns))
    matrix, step = np.empty((unknowns, unknowns)), np.empty(unknowns)
    for tick in range(references.shape[0]):
        reference, state = references[tick], states[tick]
        roll = torso_roll(reference, lean)
        linearise(tree, reference, state, roll, errors, jacobian)
        accepted = direct and rows == unknowns
        if accepted:
            for i in range(rows):
                step[i] = errors[i]
                for k in range(unknowns):
                    matrix[i, k] = jacobian[i, k]
            accepted = solve(matrix, step) and keeps_limits(
                step, state, limits
            )
        if not accepted:
            for i in range(rows):
                if not abs(errors[i]) <= greatest:
                    return tick
            move_within(jacobian, errors, state, limits, matrix, step)
        after = states[tick + 1]
        for j in range(n):
            angle = state[j] + step[j]
            after[j] = min(max(angle, limits[j, 0]), limits[j, 1])
        for j in range(n, n + BASE):
            after[j] = state[j] + step[j]
        after[n + 4], after[n + 5] = state[n + 3], roll
    return len(references)
