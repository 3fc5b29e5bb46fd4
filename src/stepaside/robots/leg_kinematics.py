"""Joint motion generation by damped pseudo-inverse (paper, Sec. III-A).

Unknowns are position and heading of the torso, whose roll is given, and the
leg joints; joints that share a motor are one unknown. Rows are the poses of
both feet and the CoM. Independent hip yaws add one unknown, and one row: the
torso heading equals the mean heading of the feet.
"""

from functools import cached_property
from math import cos, inf, remainder, sin, tau
from operator import itemgetter

import numpy as np

from ..core.errors import ReachError
from ..core.poses import Array
from .body_reference import BodyReference, Posture
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
# Motion of the torso in a tick beyond which the undamped step is rejected,
# in [m] or [rad].
GREATEST_MOVE = 0.1
ROWS = (
    *(f"left foot {c}" for c in ("x", "y", "z", "roll", "pitch", "yaw")),
    *(f"right foot {c}" for c in ("x", "y", "z", "roll", "pitch", "yaw")),
    *(f"CoM {c}" for c in ("x", "y", "z")),
    "torso heading",
)


class LegKinematics:
    """Floating-base inverse kinematics of one robot.

    Attributes:
        description: Robot description.
        joint_names: Actuated joints, in the order of the joint targets.
        legs: Leg joints.
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
        self._limits = list(
            zip(
                self._reach.tolist(),
                legs.low.tolist(),
                legs.high.tolist(),
                strict=True,
            )
        )
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
        self._error = np.zeros(FIXED_ROWS)
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
    def stance(self) -> Posture:
        """Torso pose and free joints of the present targets."""
        x, y, z = self._position
        return Posture((x, y, z), self._heading, self._free, self._roll)

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
            worst = int(np.argmax(np.abs(self._error)))
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
        return ReachableHeights(
            lambda height: self._reaches(reference, height),
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
            if float(np.abs(self._error).max()) < TOLERANCE:
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
        if self._step_freely(reference):
            return self.joint_targets
        self._step(reference, self._reach)
        error = self._error
        if not -GREATEST_ERROR <= error.min() <= error.max() <= GREATEST_ERROR:
            worst = int(np.argmax(np.abs(error)))
            raise ReachError(
                f"{self.description.name} cannot follow: {ROWS[worst]} is "
                f"off by {error[worst]:.3f}, more than {GREATEST_ERROR:g} "
                "[m, rad]"
            )
        return self.joint_targets

    def _step_freely(self, reference: BodyReference) -> bool:
        """Take the undamped step if it meets all limits.

        Near singularities it is too long and rejected: there the damped
        step is used.
        """
        newton_step, n = self._solver.newton_step, BASE + len(self._free)
        if newton_step is None:
            return False
        try:
            step = newton_step(*self._arguments(reference))
        except ZeroDivisionError:
            return False
        x, y, z, turn = step[:BASE]
        if not max(abs(x), abs(y), abs(z), abs(turn)) < GREATEST_MOVE:
            return False
        moved = step[n + BASE :]
        if not self._allows(step[BASE:n], moved):
            return False
        self._free = moved
        self._position = step[n : n + 3]
        self._last_heading = self._heading
        self._heading = step[n + 3]
        return True

    def _allows(
        self, moves: tuple[float, ...], moved: tuple[float, ...]
    ) -> bool:
        """Return whether a step keeps to the speeds and ranges of all joints.

        While all joints are far from their limits, the greatest move alone
        decides.
        """
        greatest = max(max(moves), -min(moves))
        self._range_margin -= greatest
        if greatest <= self._slowest and self._range_margin >= 0.0:
            return True
        margin = inf
        for angle, move, (reach, low, high) in zip(
            moved, moves, self._limits, strict=True
        ):
            if not (-reach <= move <= reach and low <= angle <= high):
                return False
            margin = min(margin, angle - low, high - angle)
        self._range_margin = margin
        return True

    def _arguments(self, reference: BodyReference) -> tuple[float, ...]:
        """Return the arguments of the generated functions."""
        com, left, right, left_tilt, right_tilt = reference
        feet = (*left, *right, *left_tilt, *right_tilt)
        self._roll = reference.roll(self.legs.lean)
        torso = (*self._position, self._heading)
        roll = self.legs.roll_argument(self._roll)
        return (*self._free, *torso, *com, *feet, *roll)

    def _step(self, reference: BodyReference, reach: Array) -> None:
        """Take one damped Newton step, and store the residuals before it.

        No joint moves by more than ``reach``, in [rad]: near a straight knee
        an unlimited step would land on the other branch of the leg.
        """
        legs = self.legs
        error, jacobian = self._solver.linearise(*self._arguments(reference))
        angles = np.array(self._free)
        low = np.clip(legs.low - angles, -reach, reach)
        high = np.clip(legs.high - angles, -reach, reach)
        move = move_within(jacobian, error, low, high, legs.speeds)
        c, s = cos(self._heading), sin(self._heading)
        to_world = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        turned = error[:FIXED_ROWS].reshape(-1, 3) @ to_world.T
        self._error = np.append(turned, error[FIXED_ROWS:])
        moved = np.clip(angles + move[BASE:], legs.low, legs.high)
        self._free = tuple(moved.tolist())
        self._range_margin = 0.0
        x, y, z = (self._position + to_world @ move[:3]).tolist()
        self._position = (x, y, z)
        self._last_heading = self._heading
        self._heading += float(move[3])
