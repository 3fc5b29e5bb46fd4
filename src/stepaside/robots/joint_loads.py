"""Inverse dynamics of a walking reference: torques of the leg joints.

Links are point masses at their CoM. The ground reaction matches the ZMP of
the plan: a force at the anchor of each foot, and the remaining moment. The
torques follow from the link positions at three consecutive ticks.
"""

from typing import NamedTuple

import numpy as np

from ..core.compilation import bound
from ..core.constants import GRAVITY
from ..core.poses import Array
from .body_reference import BodyReference
from .expression_tracing import (
    ExpressionTrace,
    Formula,
    Number,
)
from .kept_formulas import kept_formula
from .leg_joints import LegJoints
from .leg_kinematics import LegKinematics
from .link_poses import LinkPoses, place_links
from .scalar_algebra import Vector, add, cross, dot, scale, subtract, turn

LIFTED = 1e-6  # height above which a foot carries no load, in [m]
ZERO: Vector = (0.0, 0.0, 0.0)
CACHE_SIZE = 16  # robots whose formulas are cached


LOOP = """\
def load_rows(states, contacts, points, torques, rate, calls):
    n, motors = states.shape[1] - 7, torques.shape[1]
    for i in range(torques.shape[0]):
        factor = rate if calls + i > 1.0 else 0.0
        c, s = cos(states[i + 1, n + 3]), sin(states[i + 1, n + 3])
        results = loads({arguments})
        for j in range(motors):
            torques[i, j] = results[j]
        for j in range(points.shape[1]):
            points[i + 2, j] = results[motors + j]
"""


class LoadFormulas:
    """Generated torque formulas of one robot.

    Attributes:
        coordinates: Number of coordinates of the masses.
        rows: Function that sets torques of the leg motors and mass positions
            of many ticks; see :data:`LOOP`.
    """

    def __init__(self, legs: LegJoints) -> None:
        """Generate the formulas."""
        n, self.coordinates = len(legs.free), 3 * len(_lumped_masses(legs)[1])
        formula = kept_formula("loads", legs, trace_loads)
        arguments = [
            *(f"states[i + 1, {j}]" for j in range(n + 3)),
            *("c", "s"),
            *(f"points[i, {j}]" for j in range(self.coordinates)),
            *(f"points[i + 1, {j}]" for j in range(self.coordinates)),
            "factor",
            *(f"contacts[i, {j}]" for j in range(7)),
            *([f"states[i + 1, {n + 6}]"] if legs.lean > 0.0 else []),
        ]
        loop = LOOP.format(arguments=", ".join(arguments))
        self.rows = formula.loop("load_rows", loop)


class LegLoads:
    """Torques of the leg joints of one robot that tracks a reference.

    Attributes:
        formulas: Generated formulas.
        leg_motors: Indices of the motors that move the legs.
    """

    def __init__(
        self, kinematics: LegKinematics, *, zmp_forward: float, tick: float
    ) -> None:
        """Generate the formulas of a robot.

        Args:
            kinematics: Inverse kinematics, whose present posture is
                evaluated at every tick.
            zmp_forward: Sagittal coordinate of the anchor of a foot in its
                frame, in [m].
            tick: Control period, in [s].
        """
        self._kinematics = kinematics
        self._zmp_forward = zmp_forward
        self._rate = 1.0 / (tick * tick)
        legs = kinematics.legs
        motors = legs.tree.motors
        self.leg_motors = [motors.index(name) for name in _motors(legs)]
        self._number_of_motors = len(motors)
        self.formulas = _load_formulas(legs)
        # Mass positions two ticks ago and one tick ago, then of the last rows.
        self._points = np.zeros((2, self.formulas.coordinates))
        some = np.zeros((1, 1))
        bound(self.formulas.rows, *4 * (some,), self._rate, 0.0)  # compiles
        self._calls = 0

    def torques(
        self, reference: BodyReference, zmp: tuple[float, float]
    ) -> Array:
        """Return the torques at the present posture of the kinematics.

        To be called once a tick: accelerations are second differences of
        the last three postures; they are zero in the first two calls.

        Args:
            reference: Reference of that posture.
            zmp: ZMP of the plan in the frame of the reference, in [m].

        Returns:
            Torques of all motors, in [N m]. Shape (joints,).
        """
        states = np.array([self._kinematics.state] * 2)
        row = np.array([reference.row()])
        torques: Array = self.torque_rows(states, row, np.array([zmp]))[0]
        return torques

    def torque_rows(
        self, states: Array, references: Array, zmp: Array
    ) -> Array:
        """Return the torques of consecutive ticks, as :meth:`torques` does.

        Args:
            states: States of the kinematics, the one before the first tick
                included; see :class:`.LegStates`.
            references: References of the ticks, rows of
                :meth:`.BodyReference.row`. Shape (ticks, 15).
            zmp: ZMP of the plan, in [m]. Shape (ticks, 2).

        Returns:
            Torques of all motors, in [N m]. Shape (ticks, joints).
        """
        ticks = len(references)
        points = np.empty((ticks + 2, self._points.shape[1]))
        points[:2] = self._points[-2:]
        contacts = self._ground_contacts(references, zmp)
        legs = np.empty((ticks, len(self.leg_motors)))
        calls = float(self._calls)
        self.formulas.rows(states, contacts, points, legs, self._rate, calls)
        self._points = points
        self._calls += ticks
        torques = np.zeros((ticks, self._number_of_motors))
        torques[:, self.leg_motors] = legs
        return torques

    def rewind(self, ticks: int) -> None:
        """Return to the state after the first ``ticks`` of the last rows."""
        self._calls -= len(self._points) - 2 - ticks
        self._points = self._points[ticks : ticks + 2]

    def _ground_contacts(self, references: Array, zmp: Array) -> Array:
        """Return anchors of both feet, in [m], and load fraction of the left.

        Anchors are in the frame of the reference. Shape (ticks, 7).
        """
        x, y, z, yaw, u, v, w, turned = references[:, 3:11].T
        forward = self._zmp_forward
        x, y = x + forward * np.cos(yaw), y + forward * np.sin(yaw)
        u, v = u + forward * np.cos(turned), v + forward * np.sin(turned)
        fraction = (zmp[:, 0] - u) * (x - u) + (zmp[:, 1] - v) * (y - v)
        fraction /= (x - u) * (x - u) + (y - v) * (y - v)
        fraction = np.where(fraction < 0.0, 0.0, fraction)
        fraction = np.where(fraction > 1.0, 1.0, fraction)
        fraction = np.where(w > LIFTED, 1.0, fraction)
        fraction = np.where(z > LIFTED, 0.0, fraction)
        return np.column_stack([x, y, z, u, v, w, fraction])


def _motors(legs: LegJoints) -> list[str]:
    """Return the motors that move the legs."""
    tree = legs.tree
    names = [tree.links[link].joint for link in _lumped_masses(legs)[0]]
    leaders = [tree.followers.get(name, name) for name in names]
    return [name for name in tree.motors if name in leaders]


def _lumped_masses(legs: LegJoints) -> tuple[list[int], list[float]]:
    """Return the links of both legs and their masses, the torso's last.

    Links that inverse kinematics does not move are lumped with the leg link
    or torso that carries them.
    """
    joints = [*legs.chain(0), *legs.chain(1)]
    masses = [0.0] * (len(joints) + 1)
    for index, link in enumerate(legs.tree.links):
        masses[_carrier(legs, joints, index)] += link.mass
    return joints, masses


def _carrier(legs: LegJoints, joints: list[int], link: int) -> int:
    above = [x for x in legs.tree.chain(link) if x in joints]
    return joints.index(above[-1]) if above else len(joints)


_cache: dict[tuple[object, ...], LoadFormulas] = {}


def _load_formulas(legs: LegJoints) -> LoadFormulas:
    """Return the torque formulas of a robot, cached by tree."""
    key = legs.key
    if key not in _cache:
        if len(_cache) >= CACHE_SIZE:
            _cache.clear()
        _cache[key] = LoadFormulas(legs)
    return _cache[key]


def trace_loads(legs: LegJoints) -> Formula:
    """Generate the function of torques and mass positions of one tick.

    Args:
        legs: Leg joints.

    Returns:
        Function of the arguments of :class:`TracedMasses`. Its results are
        the torques of the leg motors, in [N m], and the positions of the
        masses.
    """
    traced = TracedMasses.of(legs)
    results = [*traced.torques(), *traced.points]
    return traced.trace.formula("loads", results)


class TracedMasses(NamedTuple):
    """Traced point masses of the links of both legs, the torso's last.

    The arguments of the trace: free joints; position of the torso, cosine
    and sine of its heading; then, of :meth:`torques`, mass positions two
    ticks ago and one tick ago; factor of their second difference; anchors of
    both feet; load fraction of the left one; and the roll of a torso that
    leans.

    Attributes:
        legs: Leg joints.
        trace: The trace.
        links: Poses of all links.
        masses: Lumped masses, in [kg].
        turn: Cosine and sine of the heading of the torso.
        position: Position of the torso, in [m].
        points: Positions of the masses, one coordinate after the other.
        load: Variables of the loads; none if they are not traced.
    """

    legs: LegJoints
    trace: ExpressionTrace
    links: LinkPoses
    masses: list[float]
    turn: list[Number]
    position: list[Number]
    points: list[Number]
    load: dict[str, list[Number]]

    @classmethod
    def of(cls, legs: LegJoints, *, loaded: bool = True) -> "TracedMasses":
        """Trace the positions of the masses.

        Args:
            legs: Leg joints.
            loaded: Whether to add the variables of the loads.
        """
        trace = ExpressionTrace()

        def variables(name: str, count: int) -> list[Number]:
            return [trace.variable(f"{name}{i}") for i in range(count)]

        joints, masses = _lumped_masses(legs)
        free = variables("q", len(legs.free))
        position = variables("p", 3)
        cosine_and_sine = variables("t", 2)
        load = {}
        if loaded:
            for name, count in (
                *(("b", 3 * len(masses)), ("l", 3 * len(masses))),
                *(("r", 1), ("a", 3), ("o", 3), ("w", 1)),
            ):
                load[name] = variables(name, count)
        axes = legs.torso_axes(trace)
        links = place_links(legs.tree, legs.angles(free), axes)
        firsts: list[Vector] = [ZERO] * len(masses)
        for i, described in enumerate(legs.tree.links):
            com = add(links.positions[i], turn(links.axes[i], described.com))
            carrier = _carrier(legs, joints, i)
            firsts[carrier] = add(firsts[carrier], scale(described.mass, com))
        points: list[Number] = []
        for first, mass in zip(firsts, masses, strict=True):
            # Of several hinges in one body all but the last have no mass.
            inverse_mass = 1.0 / mass if mass > 0.0 else 0.0
            lever = _turned(cosine_and_sine, scale(inverse_mass, first))
            points += add(position, lever)
        return cls(
            *(legs, trace, links, masses, cosine_and_sine, position),
            *(points, load),
        )

    def torques(self) -> list[Number]:
        """Return the torques of the leg motors, in [N m]."""
        forces: list[Vector] = []
        moments: list[Vector] = []
        (rate,) = self.load["r"]
        for i, mass in enumerate(self.masses):
            at = slice(3 * i, 3 * i + 3)
            point = self.points[at]
            old, older = self.load["l"][at], self.load["b"][at]
            difference = add(subtract(point, scale(2.0, old)), older)
            acceleration = scale(rate, difference)
            force = scale(mass, add(acceleration, (0.0, 0.0, GRAVITY)))
            forces.append(force)
            moments.append(cross(point, force))
        total, total_moment = _sum(forces), _sum(moments)
        anchors = (self.load["a"], self.load["o"])
        (fraction,) = self.load["w"]
        fractions = (fraction, 1.0 - fraction)
        zmp = add(
            scale(fractions[0], anchors[0]), scale(fractions[1], anchors[1])
        )
        torques: dict[str, Number] = {}
        row = 0
        for side in (0, 1):
            lever = subtract(anchors[side], zmp)
            ground_moment = scale(
                fractions[side], add(total_moment, cross(lever, total))
            )
            # From the foot up: loads below a joint less the ground reaction.
            force = scale(-1.0, scale(fractions[side], total))
            moment = scale(-1.0, ground_moment)
            chain = self.legs.chain(side)
            for k in range(len(chain) - 1, -1, -1):
                force = add(force, forces[row + k])
                moment = add(moment, moments[row + k])
                motor, torque = self._torque(chain[k], force, moment)
                torques[motor] = torques.get(motor, 0.0) + torque
            row += len(chain)
        return [torques[name] for name in _motors(self.legs)]

    def _torque(
        self, link: int, force: Vector, moment: Vector
    ) -> tuple[str, Number]:
        """Return the motor of a link's joint, and its torque, in [N m].

        Args:
            link: Index of the link.
            force: Force on the leg from this joint on, in [N].
            moment: Its moment about the origin, in [N m].
        """
        tree, links = self.legs.tree, self.links
        at = add(self.position, _turned(self.turn, links.positions[link]))
        axis = turn(links.axes[link], tree.links[link].axis)
        joint = tree.links[link].joint
        lever = subtract(moment, cross(at, force))
        return (
            tree.followers.get(joint, joint),
            dot(_turned(self.turn, axis), lever),
        )


def _turned(cosine_and_sine: Vector, a: Vector) -> list[Number]:
    """Rotate a vector from the torso to the world frame."""
    c, s = cosine_and_sine
    return [c * a[0] - s * a[1], s * a[0] + c * a[1], a[2]]


def _sum(vectors: list[Vector]) -> Vector:
    total: Vector = ZERO
    for vector in vectors:
        total = add(total, vector)
    return total
