"""Joint motion generation by damped pseudo-inverse (paper, Sec. III-A).

Unknowns are place and heading of the torso, which is level or leans as it is
told, and the leg joints, where joints that share a motor are one unknown; rows
are the poses of both feet and the CoM. Where hip yaws are independent there is
one more unknown, and a row: the torso heads where the feet do on average.
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

LEAP = 0.3  # of a joint in one step while a stance is searched, in [rad]
TOLERANCE = 1e-4  # residual at which a posture counts as reached
LOST = 0.5  # residual, in [m] or [rad], beyond which a request is refused
FAR = 0.1  # move of the torso in a tick that is looked at twice, [m], [rad]
ROWS = (
    *(f"left foot {c}" for c in ("x", "y", "z", "roll", "pitch", "yaw")),
    *(f"right foot {c}" for c in ("x", "y", "z", "roll", "pitch", "yaw")),
    *(f"CoM {c}" for c in ("x", "y", "z")),
    "torso heading",
)


class LegKinematics:
    """Floating-base inverse kinematics of one robot.

    Attributes:
        description: The robot.
        joint_names: Actuated joints, in the order of the joint targets.
        legs: What of it moves.
    """

    def __init__(self, description: RobotDescription, *, tick: float) -> None:
        """Take the standing angles, with the torso at the origin.

        Args:
            description: The robot.
            tick: Time from one tracked reference to the next, in [s].

        Raises:
            ModelError: If the kinematic tree of the robot cannot be had.
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
        self._room = 0.0  # from the free joints to the ends of their ranges
        self._start = tuple(
            float(description.standing.get(name, 0.0)) for name in legs.free
        )
        self._free: tuple[float, ...] = self._start
        self._place: tuple[float, ...] = (0.0, 0.0, 0.0)
        self._heading = self._faced = self._roll = 0.0
        self._error = np.zeros(FIXED_ROWS)
        fixed = dict(zip(tree.joints, legs.fixed, strict=True))
        self._still = np.array([fixed[name] for name in tree.motors])
        columns = dict(zip(tree.joints, legs.columns[1:], strict=True))
        moved = {
            i: column
            for i, name in enumerate(tree.motors)
            if (column := columns[name]) is not None
        }
        first, last = min(moved), max(moved) + 1
        self._at: slice | list[int] = list(moved)
        if self._at == list(range(first, last)):
            self._at = slice(first, last)  # much faster
        self._pick = itemgetter(*moved.values())

    @property
    def joint_targets(self) -> Array:
        """Angles of the actuated joints, in [rad]. Shape (joints,)."""
        targets = self._still.copy()
        targets[self._at] = self._pick(self._free)
        return targets

    @property
    def posture(self) -> Array:
        """Position and quaternion of the torso, then all joints."""
        half, tilt = 0.5 * self._heading, 0.5 * self._roll
        c, s, r, t = cos(half), sin(half), cos(tilt), sin(tilt)
        turned = (c * r, c * t + 0.0, s * t + 0.0, s * r)
        joints = self.legs.angles(self._free)
        return np.array([*self._place, *turned, *joints], dtype=np.float64)

    @property
    def stance(self) -> Posture:
        """Torso and free joints as they are asked for now."""
        x, y, z = self._place
        return Posture((x, y, z), self._heading, self._free, self._roll)

    @property
    def torso_heading(self) -> float:
        """Heading of the torso in the frame of the reference, in [rad].

        That of the posture before the last step: by the time of the next
        one the body has come as far as that.
        """
        return remainder(self._faced, tau)

    def stand(self, reference: BodyReference) -> Array:
        """Take a posture from scratch.

        Args:
            reference: What to reach.

        Returns:
            Joint targets, in [rad]. Shape (joints,).

        Raises:
            ReachError: If the legs cannot reach it; names what is missed.
        """
        if not self._try_stand(reference):
            worst = int(np.argmax(np.abs(self._error)))
            heights = self._heights(reference).in_words(reference.com[2])
            raise ReachError(
                f"{self.description.name} cannot reach {ROWS[worst]} with a "
                f"CoM height of {reference.com[2]:g} m; "
                f"it reaches {heights} in this stance"
            )
        return self.joint_targets

    def highest_com(self, reference: BodyReference) -> float:
        """Greatest CoM height with the feet of ``reference``, in [m].

        Returns:
            The height; 0 if there is none.
        """
        return self._heights(reference).greatest

    def lowest_com(self, reference: BodyReference) -> float:
        """Least CoM height with the feet of ``reference``, in [m].

        Returns:
            The height; 0 if there is none.
        """
        return self._heights(reference).least

    @cached_property
    def _natural_height(self) -> float:
        """Height of the CoM over the soles in the natural stance, in [m]."""
        joints = np.array(self.legs.angles(self._start))
        stance = Configuration(self._tree, joints)
        soles = [stance.place_of_site(name)[2] for name in self.legs.sites]
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
        self._place = reference.com
        self._heading = reference.heading
        self._free = self._start
        reach = np.full(len(self._free), LEAP)
        for _ in range(60):
            self._step(reference, reach)
            if float(np.abs(self._error).max()) < TOLERANCE:
                return True
        return False

    def track(self, reference: BodyReference) -> Array:
        """Follow a reference by one damped step from the last posture.

        A joint at a limit of its range or speed stays there, and torso and
        other joints do what they can.

        Args:
            reference: What to reach at this tick.

        Returns:
            Joint targets, in [rad]. Shape (joints,).

        Raises:
            ReachError: If the legs are hopelessly short of it; names what is.
        """
        if self._step_freely(reference):
            return self.joint_targets
        self._step(reference, self._reach)
        error = self._error
        if not -LOST <= error.min() <= error.max() <= LOST:
            worst = int(np.argmax(np.abs(error)))
            raise ReachError(
                f"{self.description.name} cannot follow: {ROWS[worst]} is "
                f"off by {error[worst]:.3f}, more than {LOST:g} [m, rad]"
            )
        return self.joint_targets

    def _step_freely(self, reference: BodyReference) -> bool:
        """Take the step that no limit holds back, if it is one.

        Without damping: that is for legs which are nearly singular, whose
        steps are too long to be taken here.
        """
        quick, n = self._solver.quick, BASE + len(self._free)
        if quick is None:
            return False
        try:
            step = quick(*self._arguments(reference))
        except ZeroDivisionError:
            return False
        x, y, z, turn = step[:BASE]
        if not max(abs(x), abs(y), abs(z), abs(turn)) < FAR:
            return False
        moved = step[n + BASE :]
        if not self._allows(step[BASE:n], moved):
            return False
        self._free = moved
        self._place, self._faced = step[n : n + 3], self._heading
        self._heading = step[n + 3]
        return True

    def _allows(
        self, moves: tuple[float, ...], moved: tuple[float, ...]
    ) -> bool:
        """Whether joints that move keep to their speeds and ranges.

        While all of them have room to every limit, the greatest move alone
        says so.
        """
        greatest = max(max(moves), -min(moves))
        self._room -= greatest
        if greatest <= self._slowest and self._room >= 0.0:
            return True
        room = inf
        for angle, move, (reach, low, high) in zip(
            moved, moves, self._limits, strict=True
        ):
            if not (-reach <= move <= reach and low <= angle <= high):
                return False
            room = min(room, angle - low, high - angle)
        self._room = room
        return True

    def _arguments(self, reference: BodyReference) -> tuple[float, ...]:
        """Arguments of the solver's functions."""
        com, left, right, left_tilt, right_tilt = reference
        feet = (*left, *right, *left_tilt, *right_tilt)
        self._roll = reference.roll(self.legs.lean)
        rolled = self.legs.rolled(self._roll)
        return (*self._free, *self._place, self._heading, *com, *feet, *rolled)

    def _step(self, reference: BodyReference, reach: Array) -> None:
        """One damped Newton step; leaves the error before it.

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
        self._room = 0.0
        x, y, z = (self._place + to_world @ move[:3]).tolist()
        self._place, self._faced = (x, y, z), self._heading
        self._heading += float(move[3])
