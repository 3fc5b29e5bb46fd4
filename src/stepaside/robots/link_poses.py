"""Where the links of a tree are, in the frame of its torso.

Works on floats and on traced numbers alike: see :mod:`.tracing`.
"""

from collections.abc import Sequence
from typing import NamedTuple

from .expression_tracing import Number
from .robot_tree import HINGE, LinkFrame, RobotTree
from .scalar_algebra import (
    Matrix,
    Vector,
    add,
    cross,
    multiply,
    rotation_about,
    scale,
    turn,
)

LEVEL: Matrix = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


class LinkPoses(NamedTuple):
    """Links of a tree in the torso frame, or in a level one at the torso.

    Attributes:
        tree: The tree.
        axes: Rotation of each link's frame, the torso's first.
        places: Origin of each, which is where its joint is, in [m].
        turns: Rotation of each in its parent.
        offsets: Origin of each in its parent, in [m].
    """

    tree: RobotTree
    axes: list[Matrix]
    places: list[Vector]
    turns: list[Matrix]
    offsets: list[Vector]

    def place_of(self, frame: LinkFrame) -> list[Number]:
        """Origin of a frame in the torso frame, in [m]."""
        lever = turn(self.axes[frame.link], frame.place)
        return add(self.places[frame.link], lever)

    def axes_of(self, frame: LinkFrame) -> list[list[Number]]:
        """Axes of a frame in the torso frame, as columns."""
        return multiply(self.axes[frame.link], frame.axes)


def place_links(
    tree: RobotTree, angles: Sequence[Number], torso: Matrix = LEVEL
) -> LinkPoses:
    """Place every link of a tree.

    Args:
        tree: The tree.
        angles: Of all joints, in [rad] or [m], in the order of the links.
        torso: Axes of the torso in the frame that all is seen from.
    """
    nowhere: Vector = (0.0, 0.0, 0.0)
    axes, places = [torso], [nowhere]
    turns, offsets = [LEVEL], [nowhere]
    for link, angle in zip(tree.links[1:], angles, strict=True):
        moved = angle - link.zero
        offset: Vector = link.origin
        if link.kind == HINGE:
            turned: Matrix = rotation_about(link.axis, moved)
        else:
            turned = LEVEL
            offset = add(offset, scale(moved, link.axis))
        above = axes[link.parent]
        axes.append(multiply(above, turned))
        places.append(add(places[link.parent], turn(above, offset)))
        turns.append(turned)
        offsets.append(offset)
    return LinkPoses(tree, axes, places, turns, offsets)


class MassMoments(NamedTuple):
    """Mass that hangs on each joint.

    Attributes:
        firsts: Mass times CoM of each link with all that hangs on it, from
            its origin and in its own frame, in [kg m].
        masses: That mass, in [kg].
    """

    firsts: list[Vector]
    masses: list[float]


def gather_moments(placed: LinkPoses) -> MassMoments:
    """First moments, from the last links to the torso.

    Each is turned once, into its parent's frame: for an axis of the frame
    this costs six operations.
    """
    links = placed.tree.links
    masses = [link.mass for link in links]
    firsts: list[Vector] = [scale(x.mass, x.com) for x in links]
    for i in range(len(links) - 1, 0, -1):
        parent = links[i].parent
        hung = add(
            turn(placed.turns[i], firsts[i]),
            scale(masses[i], placed.offsets[i]),
        )
        firsts[parent] = add(firsts[parent], hung)
        masses[parent] += masses[i]
    return MassMoments(firsts, masses)


class JointMotionAxis(NamedTuple):
    """What one joint does at unit speed, in the torso frame.

    Attributes:
        angular: Angular velocity of what hangs on it, in [rad/s].
        linear: Velocity of a point that hangs on it, in [m/s].
        moment: Momentum of all that hangs on it, in [kg m/s].
    """

    angular: Vector
    linear: Vector
    moment: Vector


def motion_of(
    placed: LinkPoses, moments: MassMoments, link: int, point: Vector
) -> JointMotionAxis:
    """What the joint of a link does to a point and to the masses.

    Args:
        placed: The links.
        moments: Their masses.
        link: Number of the link whose joint moves.
        point: The point, as if it hung on the link, in [m].
    """
    described = placed.tree.links[link]
    axes, axis = placed.axes[link], described.axis
    along = turn(axes, axis)
    if described.kind != HINGE:
        mass = moments.masses[link]
        return JointMotionAxis((0.0, 0.0, 0.0), along, scale(mass, along))
    lever = [p - q for p, q in zip(point, placed.places[link], strict=True)]
    moment = turn(axes, cross(axis, moments.firsts[link]))
    return JointMotionAxis(along, cross(along, lever), moment)
