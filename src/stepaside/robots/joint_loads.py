"""Inverse dynamics of a walking reference: torques of the leg joints.

Links are point masses at their CoM. The ground reaction matches the ZMP of
the plan: a force at the anchor of each foot, and the remaining moment. The
torques follow from the link positions at three consecutive ticks.
"""

from math import cos, sin

import numpy as np

from ..core.constants import GRAVITY
from ..core.poses import Array
from .body_reference import BodyReference
from .expression_tracing import ExpressionTrace, Number
from .jit import Function, preferred
from .leg_joints import LegJoints
from .leg_kinematics import LegKinematics
from .link_poses import place_links
from .scalar_algebra import Vector, add, cross, dot, scale, subtract, turn

LIFTED = 1e-6  # height above which a foot carries no load, in [m]
ZERO: Vector = (0.0, 0.0, 0.0)
CACHE_SIZE = 16  # robots whose formulas are cached


class LegLoads:
    """Torques of the leg joints of one robot that tracks a reference."""

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
        self._leg_motors = [motors.index(name) for name in _motors(legs)]
        self._number_of_motors = len(motors)
        self._evaluate = _load_formulas(legs)
        points = (0.0,) * (3 * len(_lumped_masses(legs)[1]))
        self._points_before_last = points
        self._points_last = points
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
        position, heading, free, roll = self._kinematics.stance
        results = self._evaluate(
            *free,
            *position,
            cos(heading),
            sin(heading),
            *self._points_before_last,
            *self._points_last,
            self._rate if self._calls > 1 else 0.0,
            *self._ground_contact(reference, zmp),
            *self._kinematics.legs.roll_argument(roll),
        )
        count = len(self._leg_motors)
        self._points_before_last = self._points_last
        self._points_last = results[count:]
        self._calls += 1
        torques = np.zeros(self._number_of_motors)
        torques[self._leg_motors] = results[:count]
        return torques

    def _ground_contact(
        self, reference: BodyReference, zmp: tuple[float, float]
    ) -> tuple[float, ...]:
        """Return the anchors of both feet and the load fraction of the left.

        Anchors are in the frame of the reference, in [m].
        """
        x, y, z, yaw = reference.left_foot
        u, v, w, turned = reference.right_foot
        forward = self._zmp_forward
        x, y = x + forward * cos(yaw), y + forward * sin(yaw)
        u, v = u + forward * cos(turned), v + forward * sin(turned)
        if z > LIFTED:
            fraction = 0.0
        elif w > LIFTED:
            fraction = 1.0
        else:
            fraction = (zmp[0] - u) * (x - u) + (zmp[1] - v) * (y - v)
            fraction /= (x - u) * (x - u) + (y - v) * (y - v)
            fraction = min(max(fraction, 0.0), 1.0)
        return x, y, z, u, v, w, fraction


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


_cache: dict[tuple[object, ...], Function] = {}


def _load_formulas(legs: LegJoints) -> Function:
    """Return the torque formulas of a robot, cached by tree."""
    key = (
        legs.tree,
        legs.columns,
        legs.fixed,
        legs.sites,
        legs.lean > 0.0,
        preferred(),
    )
    if key not in _cache:
        if len(_cache) >= CACHE_SIZE:
            _cache.clear()
        _cache[key] = _trace_loads(legs)
    return _cache[key]


def _trace_loads(legs: LegJoints) -> Function:
    """Generate the function of motor torques and mass positions.

    Arguments: free joints; position of the torso, cosine and sine of its
    heading; mass positions two ticks ago and one tick ago; factor of their
    second difference; anchors of both feet; load fraction of the left one;
    roll of a torso that leans.
    """
    trace = ExpressionTrace()
    tree = legs.tree

    def variables(name: str, count: int) -> list[Number]:
        return [trace.variable(f"{name}{i}") for i in range(count)]

    joints, masses = _lumped_masses(legs)
    free = variables("q", len(legs.free))
    position = variables("p", 3)
    c, s = variables("t", 2)
    before = variables("b", 3 * len(masses))
    last = variables("l", 3 * len(masses))
    (rate,) = variables("r", 1)
    anchors = (variables("a", 3), variables("o", 3))
    (fraction,) = variables("w", 1)
    fractions = (fraction, 1.0 - fraction)

    def to_world(a: Vector) -> list[Number]:
        """Rotate a vector from the torso to the world frame."""
        return [c * a[0] - s * a[1], s * a[0] + c * a[1], a[2]]

    axes = legs.torso_axes(trace)
    links = place_links(tree, legs.angles(free), axes)
    firsts: list[Vector] = [ZERO] * len(masses)
    for i, described in enumerate(tree.links):
        com = add(links.positions[i], turn(links.axes[i], described.com))
        carrier = _carrier(legs, joints, i)
        firsts[carrier] = add(firsts[carrier], scale(described.mass, com))
    points: list[Number] = []
    forces: list[Vector] = []
    moments: list[Vector] = []
    for i, (first, mass) in enumerate(zip(firsts, masses, strict=True)):
        # Of several hinges in one body all but the last have no mass.
        inverse_mass = 1.0 / mass if mass > 0.0 else 0.0
        point = add(position, to_world(scale(inverse_mass, first)))
        old, older = last[3 * i : 3 * i + 3], before[3 * i : 3 * i + 3]
        difference = add(subtract(point, scale(2.0, old)), older)
        force = scale(mass, add(scale(rate, difference), (0.0, 0.0, GRAVITY)))
        points += point
        forces.append(force)
        moments.append(cross(point, force))
    total, total_moment = _sum(forces), _sum(moments)
    zmp = add(scale(fractions[0], anchors[0]), scale(fractions[1], anchors[1]))
    torques: dict[str, Number] = {}
    row = 0
    for side in (0, 1):
        lever = subtract(anchors[side], zmp)
        ground_force = scale(fractions[side], total)
        ground_moment = scale(
            fractions[side], add(total_moment, cross(lever, total))
        )
        # From the foot up: loads below a joint less the ground reaction.
        force, moment = scale(-1.0, ground_force), scale(-1.0, ground_moment)
        chain = legs.chain(side)
        for k in range(len(chain) - 1, -1, -1):
            link = chain[k]
            force = add(force, forces[row + k])
            moment = add(moment, moments[row + k])
            at = add(position, to_world(links.positions[link]))
            axis = to_world(turn(links.axes[link], tree.links[link].axis))
            joint = tree.links[link].joint
            motor = tree.followers.get(joint, joint)
            torque = dot(axis, subtract(moment, cross(at, force)))
            torques[motor] = torques.get(motor, 0.0) + torque
        row += len(chain)
    results = [torques[name] for name in _motors(legs)]
    return trace.function("loads", [*results, *points])


def _sum(vectors: list[Vector]) -> Vector:
    total: Vector = ZERO
    for vector in vectors:
        total = add(total, vector)
    return total
