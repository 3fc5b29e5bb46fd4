"""Joint motion generation by damped pseudo-inverse (paper, Sec. III-A).

Unknowns are position and heading of the torso, whose roll is given, and the
leg joints; joints that share a motor are one unknown. Rows are the poses of
both feet and the CoM. Independent hip yaws add one unknown, and one row: the
torso heading equals the mean heading of the feet.
"""

from collections.abc import Sequence
from copy import copy
from functools import cached_property
from math import cos, remainder, sin, tau
from operator import itemgetter
from typing import NamedTuple

import numpy as np

from ..core.compilation import bound
from ..core.errors import ReachError
from ..core.poses import Array
from .body_reference import BodyReference
from .com_reach import ReachableHeights
from .description import RobotDescription
from .ik_solver import move_within, solver_of
from .joint_configuration import Configuration
from .leg_joints import BASE, FIXED_ROWS
from .tree_cache import load_tree

__all__ = ["ROWS", "BodyReference", "LegKinematics"]

STAND_STEP = 0.3  # joint motion per iteration while standing, in [rad]
TOLERANCE = 1e-4  # residual at which a posture counts as reached
GREATEST_ERROR = 0.5  # residual that is refused, in [m] or [rad]
ROWS = (
    *(f"left foot {c}" for c in ("x", "y", "z", "roll", "pitch", "yaw")),
    *(f"right foot {c}" for c in ("x", "y", "z", "roll", "pitch", "yaw")),
    *(f"CoM {c}" for c in ("x", "y", "z")),
    "torso heading",
)


class LegStates(NamedTuple):
    """Postures of the legs at consecutive ticks.

    Attributes:
        rows: Angles of the free joints, in [rad]; position (x, y, z) of the
            torso, in [m], and its heading, in [rad], in the frame of the
            reference; its heading a tick earlier; lower bound of the distance
            to any joint limit; roll of the torso, all in [rad]. The first
            row is the posture before the first tick. Shape (ticks + 1,
            free + 7).
        targets: Joint targets, in [rad]. Shape (ticks, joints).
    """

    rows: Array
    targets: Array

    @property
    def torso_headings(self) -> list[float]:
        """:attr:`LegKinematics.torso_heading` after each tick, in [rad]."""
        return [remainder(x, tau) for x in self.rows[1:, -3].tolist()]


class LegKinematics:
    """Floating-base inverse kinematics of one robot.

    Attributes:
        description: Robot description.
        joint_names: Actuated joints, in the order of the joint targets.
        legs: Leg joints.
        error: Remaining error of each row of the last solution.
    """

    def __init__(self, description: RobotDescription, *, tick: float) -> None:
        """Begin at the standing angles, with the torso at the origin.

        Args:
            description: Robot description.
            tick: Time between tracked references, in [s].

        Raises:
            ModelError: If the kinematic tree cannot be loaded.
        """
        self.description = description
        self._tree = tree = load_tree(description)
        self.joint_names = tree.motors
        self._solver = solver_of(description, tree)
        self.legs = legs = self._solver.legs
        self._reach = legs.speeds * tick
        self._limits = np.column_stack([self._reach, legs.low, legs.high])
        self._slowest = float(self._reach.min())
        self._range_margin = 0.0  # lower bound of the distance to any limit
        self._start = tuple(
            float(description.standing.get(name, 0.0)) for name in legs.free
        )
        self._free: tuple[float, ...] = self._start
        self._position: tuple[float, ...] = (0.0, 0.0, 0.0)
        self._heading = 0.0
        self._last_heading = 0.0
        self._roll = 0.0
        self.error = np.zeros(FIXED_ROWS)
        fixed = dict(zip(tree.joints, legs.fixed, strict=True))
        self._fixed_targets = np.array([fixed[name] for name in tree.motors])
        columns = dict(zip(tree.joints, legs.columns[1:], strict=True))
        moved = {
            i: column
            for i, name in enumerate(tree.motors)
            if (column := columns[name]) is not None
        }
        first, last = min(moved), max(moved) + 1
        self._leg_motors: slice | list[int] = list(moved)
        if self._leg_motors == list(range(first, last)):
            self._leg_motors = slice(first, last)  # much faster
        self._to_motors = itemgetter(*moved.values())
        self._leg_columns = list(moved.values())
        self._states: LegStates
        # Arrays of one tick: its reference, and the states around it.
        self._reference_row = np.zeros((1, 16))
        self._state_rows = np.zeros((2, len(self._start) + 7))
        self._track_row = None
        if self._solver.track_rows is not None:
            self._track_row = bound(
                self._solver.track_rows,
                *(self._reference_row, self._state_rows),
                *(self._limits, self._slowest),
            )

    @property
    def joint_targets(self) -> Array:
        """Angles of the actuated joints, in [rad]. Shape (joints,)."""
        targets = self._fixed_targets.copy()
        targets[self._leg_motors] = self._to_motors(self._free)
        return targets

    @property
    def posture(self) -> Array:
        """Position and quaternion of the torso, then all joints.

        Shape (7 + joints,).
        """
        half, tilt = 0.5 * self._heading, 0.5 * self._roll
        c, s, r, t = cos(half), sin(half), cos(tilt), sin(tilt)
        turned = (c * r, c * t + 0.0, s * t + 0.0, s * r)
        joints = self.legs.angles(self._free)
        return np.array([*self._position, *turned, *joints], dtype=np.float64)

    @property
    def torso_heading(self) -> float:
        """Heading of the torso in the frame of the reference, in [rad].

        Of the posture before the last step, which is where the body is by
        the time of the next one.
        """
        return remainder(self._last_heading, tau)

    def stand(self, reference: BodyReference) -> Array:
        """Solve a posture from the standing angles.

        Args:
            reference: Target of CoM and feet.

        Returns:
            Joint targets, in [rad]. Shape (joints,).

        Raises:
            ReachError: If the legs cannot reach it; names the worst row.
        """
        if not self._try_stand(reference):
            worst = int(np.argmax(np.abs(self.error)))
            heights = self._heights(reference).describe(reference.com[2])
            raise ReachError(
                f"{self.description.name} cannot reach {ROWS[worst]} with a "
                f"CoM height of {reference.com[2]:g} m; "
                f"it reaches {heights} in this stance"
            )
        return self.joint_targets

    def highest_com(self, reference: BodyReference) -> float:
        """Return the greatest CoM height with the feet of ``reference``.

        Returns:
            The height, in [m]; 0 if there is none.
        """
        return self._heights(reference).greatest

    def lowest_com(self, reference: BodyReference) -> float:
        """Return the least CoM height with the feet of ``reference``.

        Returns:
            The height, in [m]; 0 if there is none.
        """
        return self._heights(reference).least

    @cached_property
    def _natural_height(self) -> float:
        """Height of the CoM over the soles at the standing angles, in [m]."""
        joints = np.array(self.legs.angles(self._start))
        stance = Configuration(self._tree, joints)
        soles = [
            stance.position_site_in_world(name)[2] for name in self.legs.sites
        ]
        return float(stance.com[2] - max(soles))

    def _heights(self, reference: BodyReference) -> ReachableHeights:
        trial = copy(self)  # the robot itself does not move
        return ReachableHeights(
            lambda height: trial._reaches(reference, height),
            self._natural_height,
        )

    def _reaches(self, reference: BodyReference, height: float) -> bool:
        x, y, _ = reference.com
        return self._try_stand(reference._replace(com=(x, y, height)))

    def _try_stand(self, reference: BodyReference) -> bool:
        self._position = reference.com
        self._heading = reference.heading
        self._free = self._start
        reach = np.full(len(self._free), STAND_STEP)
        for _ in range(60):
            self._step(reference, reach)
            if float(np.abs(self.error).max()) < TOLERANCE:
                return True
        return False

    def track(self, reference: BodyReference) -> Array:
        """Track a reference by one damped step from the last posture.

        A joint at a limit of its range or speed stays there, and the torso
        and the other joints minimise the residuals.

        Args:
            reference: Target of CoM and feet at this tick.

        Returns:
            Joint targets, in [rad]. Shape (joints,).

        Raises:
            ReachError: If a residual is too large; names the worst row.
        """
        if self._step_freely(self._row(reference)):
            return self.joint_targets
        self._step(reference, self._reach)
        error = self.error
        if not -GREATEST_ERROR <= error.min() <= error.max() <= GREATEST_ERROR:
            worst = int(np.argmax(np.abs(error)))
            raise ReachError(
                f"{self.description.name} cannot follow: {ROWS[worst]} is "
                f"off by {error[worst]:.3f}, more than {GREATEST_ERROR:g} "
                "[m, rad]"
            )
        return self.joint_targets

    def track_rows(self, references: Array) -> LegStates:
        """Track references tick by tick, up to a tick that meets a limit.

        The targets are those of :meth:`track` called for each of them; from
        the tick after the last, where a limit acts, only that follows them.

        Args:
            references: Rows of :meth:`.BodyReference.row`. Shape (ticks, 15).

        Returns:
            States and targets of the ticks that keep to all limits.
        """
        lean, rolls = self.legs.lean, np.zeros(len(references))
        if lean > 0.0:
            bodies = map(BodyReference.from_row, references.tolist())
            rolls[:] = [body.roll(lean) for body in bodies]
        references = np.column_stack([references, rolls])
        rows = np.empty((len(references) + 1, len(self._free) + 7))
        rows[0] = self.state
        count, steps = 0, self._solver.track_rows
        if steps is not None:
            count = steps(references, rows, self._limits, self._slowest)
            self._resume(rows[count])
        targets = np.tile(self._fixed_targets, (count, 1))
        targets[:, self._leg_motors] = rows[1 : count + 1, self._leg_columns]
        self._states = LegStates(rows[: count + 1], targets)
        return self._states

    def rewind(self, ticks: int) -> None:
        """Return to the posture after the first ``ticks`` of the last rows."""
        self._resume(self._states.rows[ticks])

    @property
    def state(self) -> tuple[float, ...]:
        """Present posture, as a row of :class:`LegStates`."""
        return (
            *self._free,
            *self._position,
            self._heading,
            self._last_heading,
            self._range_margin,
            self._roll,
        )

    def _resume(self, state: Array) -> None:
        """Take the posture of a row of :class:`LegStates`."""
        *free, x, y, z, heading, last, margin, roll = state.tolist()
        self._free, self._position = tuple(free), (x, y, z)
        self._heading, self._last_heading = heading, last
        self._range_margin, self._roll = margin, roll

    def _row(self, reference: BodyReference) -> tuple[float, ...]:
        """Return the row of a reference, and the roll of the torso."""
        return (*reference.row(), reference.roll(self.legs.lean))

    def _step_freely(self, reference: Sequence[float]) -> bool:
        """Take the undamped step if it meets all limits.

        Near singularities it is too long and rejected: there the damped
        step is used.
        """
        if self._track_row is None:
            return False
        self._state_rows[0] = self.state
        self._reference_row[0] = reference
        if self._track_row() == 0:
            return False
        self._resume(self._state_rows[1])
        return True

    def _arguments(self, reference: Sequence[float]) -> tuple[float, ...]:
        """Return the arguments of the generated functions."""
        self._roll = reference[15]
        if self.legs.lean == 0.0:
            reference = reference[:15]
        return (*self._free, *self._position, self._heading, *reference)

    def _step(self, reference: BodyReference, reach: Array) -> None:
        """Take one damped Newton step, and store the residuals before it.

        No joint moves by more than ``reach``, in [rad]: near a straight knee
        an unlimited step would land on the other branch of the leg.
        """
        legs = self.legs
        row = self._row(reference)
        error, jacobian = self._solver.linearise(*self._arguments(row))
        angles = np.array(self._free)
        low = np.clip(legs.low - angles, -reach, reach)
        high = np.clip(legs.high - angles, -reach, reach)
        move = move_within(jacobian, error, low, high, legs.speeds)
        c, s = cos(self._heading), sin(self._heading)
        to_world = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        turned = error[:FIXED_ROWS].reshape(-1, 3) @ to_world.T
        self.error = np.append(turned, error[FIXED_ROWS:])
        moved = np.clip(angles + move[BASE:], legs.low, legs.high)
        self._free = tuple(moved.tolist())
        self._range_margin = 0.0
        x, y, z = (self._position + to_world @ move[:3]).tolist()
        self._position = (x, y, z)
        self._last_heading = self._heading
        self._heading += float(move[3])
