"""What the joints of walking legs bear: inverse dynamics of a reference.

A link counts as a point with mass at its CoM. The floor presses where the
plan has the ZMP: by a force on either foot, at its anchor, and by what is
left of the moment. So the torques follow from where the links are at three
ticks in a row.
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

LIFTED = 1e-6  # a foot that is higher bears nothing, in [m]
NOTHING: Vector = (0.0, 0.0, 0.0)


class LegLoads:
    """Torques of the leg joints of one robot that walks by a reference."""

    def __init__(
        self, kinematics: LegKinematics, *, zmp_forward: float, tick: float
    ) -> None:
        """Weigh a robot.

        Args:
            kinematics: Whose postures are weighed, tick by tick.
            zmp_forward: Sagittal place of a foot's anchor in its frame, [m].
            tick: Control period, in [s].
        """
        self._kinematics, self._ahead = kinematics, zmp_forward
        self._rate = 1.0 / (tick * tick)
        legs = kinematics.legs
        motors = legs.tree.motors
        moved = _motors(legs)
        self._at = [motors.index(name) for name in moved]
        self._torques = np.zeros(len(motors))
        self._write = _written(legs)
        nowhere = (0.0,) * (3 * len(_carried(legs)[1]))
        self._before, self._last = nowhere, nowhere
        self._seen = 0

    def torques(
        self, reference: BodyReference, zmp: tuple[float, float]
    ) -> Array:
        """Torques that the present posture of the kinematics asks for.

        To be called once a tick: accelerations are those of the last three
        postures.

        Args:
            reference: What that posture was to reach.
            zmp: ZMP of the plan, in [m].

        Returns:
            Of all motors, in [N m]. Shape (joints,).
        """
        place, heading, free, roll = self._kinematics.stance
        found = self._write(
            *free,
            *place,
            cos(heading),
            sin(heading),
            *self._before,
            *self._last,
            self._rate if self._seen > 1 else 0.0,
            *self._floor(reference, zmp),
            *self._kinematics.legs.rolled(roll),
        )
        count = len(self._at)
        self._before, self._last = self._last, found[count:]
        self._seen += 1
        torques = np.zeros(self._torques.size)
        torques[self._at] = found[:count]
        return torques

    def _floor(
        self, reference: BodyReference, zmp: tuple[float, float]
    ) -> tuple[float, ...]:
        """Anchors of both feet, and the share of the weight on the left."""
        x, y, z, yaw = reference.left_foot
        u, v, w, turned = reference.right_foot
        ahead = self._ahead
        x, y = x + ahead * cos(yaw), y + ahead * sin(yaw)
        u, v = u + ahead * cos(turned), v + ahead * sin(turned)
        if z > LIFTED:
            share = 0.0
        elif w > LIFTED:
            share = 1.0
        else:
            share = (zmp[0] - u) * (x - u) + (zmp[1] - v) * (y - v)
            share /= (x - u) * (x - u) + (y - v) * (y - v)
            share = min(max(share, 0.0), 1.0)
        return x, y, z, u, v, w, share


def _motors(legs: LegJoints) -> list[str]:
    """Motors that move the legs."""
    tree = legs.tree
    names = [tree.links[link].joint for link in _carried(legs)[0]]
    leaders = [tree.followers.get(name, name) for name in names]
    return [name for name in tree.motors if name in leaders]


def _carried(legs: LegJoints) -> tuple[list[int], list[float]]:
    """Links of both legs, and the mass that each carries; last the torso's.

    What hangs on a link and does not move by itself is carried by it.
    """
    joints = [*legs.chain(0), *legs.chain(1)]
    masses = [0.0] * (len(joints) + 1)
    for link, weighed in enumerate(legs.tree.links):
        masses[_carrier(legs, joints, link)] += weighed.mass
    return joints, masses


def _carrier(legs: LegJoints, joints: list[int], link: int) -> int:
    above = [x for x in legs.tree.chain(link) if x in joints]
    return joints.index(above[-1]) if above else len(joints)


_KNOWN: dict[tuple[object, ...], Function] = {}
KEPT = 16  # robots whose formulas are kept


def _written(legs: LegJoints) -> Function:
    """Torques of a robot's legs; formulas are written once for each tree."""
    key = (
        *(legs.tree, legs.columns, legs.fixed, legs.sites),
        *(legs.lean > 0.0, preferred()),
    )
    if key not in _KNOWN:
        if len(_KNOWN) >= KEPT:
            _KNOWN.clear()
        _KNOWN[key] = _trace_loads(legs)
    return _KNOWN[key]


def _trace_loads(legs: LegJoints) -> Function:
    """Write out the torques of the motors, and where the masses are.

    Arguments: free joints; place of the torso, cosine and sine of its
    heading; places of the masses two ticks ago and one; by what their
    second difference counts; anchors of both feet; share of the left one;
    roll of a torso that leans.
    """
    trace, tree = ExpressionTrace(), legs.tree

    def variables(name: str, count: int) -> list[Number]:
        return [trace.variable(f"{name}{i}") for i in range(count)]

    joints, masses = _carried(legs)
    free, place = variables("q", len(legs.free)), variables("p", 3)
    c, s = variables("t", 2)
    before = variables("b", 3 * len(masses))
    last = variables("l", 3 * len(masses))
    (rate,) = variables("r", 1)
    anchors = (variables("a", 3), variables("o", 3))
    (share,) = variables("w", 1)
    shares = (share, 1.0 - share)

    def seen(a: Vector) -> list[Number]:
        """A vector of the torso in the world."""
        return [c * a[0] - s * a[1], s * a[0] + c * a[1], a[2]]

    axes = legs.torso_axes(trace)
    placed = place_links(tree, legs.angles(free), axes)
    firsts: list[Vector] = [NOTHING] * len(masses)
    for i, weighed in enumerate(tree.links):
        com = add(placed.places[i], turn(placed.axes[i], weighed.com))
        carrier = _carrier(legs, joints, i)
        firsts[carrier] = add(firsts[carrier], scale(weighed.mass, com))
    points: list[Number] = []
    forces: list[Vector] = []
    moments: list[Vector] = []
    for i, (first, mass) in enumerate(zip(firsts, masses, strict=True)):
        # Of several hinges in one body all but the last carry nothing.
        share_of_mass = 1.0 / mass if mass > 0.0 else 0.0
        point = add(place, seen(scale(share_of_mass, first)))
        old, older = last[3 * i : 3 * i + 3], before[3 * i : 3 * i + 3]
        bent = add(subtract(point, scale(2.0, old)), older)
        force = scale(mass, add(scale(rate, bent), (0.0, 0.0, GRAVITY)))
        points += point
        forces.append(force)
        moments.append(cross(point, force))
    total, spin = _sum(forces), _sum(moments)
    middle = add(scale(shares[0], anchors[0]), scale(shares[1], anchors[1]))
    torques: dict[str, Number] = {}
    row = 0
    for side in (0, 1):
        lever = subtract(anchors[side], middle)
        press = scale(shares[side], total)
        twist = scale(shares[side], add(spin, cross(lever, total)))
        # From the foot up: what hangs on a joint, less what the floor bears.
        force, moment = scale(-1.0, press), scale(-1.0, twist)
        chain = legs.chain(side)
        for k in range(len(chain) - 1, -1, -1):
            link = chain[k]
            force = add(force, forces[row + k])
            moment = add(moment, moments[row + k])
            at = add(place, seen(placed.places[link]))
            axis = seen(turn(placed.axes[link], tree.links[link].axis))
            joint = tree.links[link].joint
            motor = tree.followers.get(joint, joint)
            torque = dot(axis, subtract(moment, cross(at, force)))
            torques[motor] = torques.get(motor, 0.0) + torque
        row += len(chain)
    results = [torques[name] for name in _motors(legs)]
    return trace.function("loads", [*results, *points])


def _sum(vectors: list[Vector]) -> Vector:
    total: Vector = NOTHING
    for vector in vectors:
        total = add(total, vector)
    return total
