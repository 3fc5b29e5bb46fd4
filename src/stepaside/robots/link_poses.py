"""Link poses, mass moments and joint motion axes in the torso frame.

All functions accept floats and traced numbers, see
:mod:`.expression_tracing`.
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
    """Poses of all links in the torso frame, or in the level torso frame.

    Attributes:
        tree: Kinematic tree.
        axes: Rotation matrix of each link frame, the torso first.
        positions: Origin of each link frame, at its joint, in [m].
        rotations: Rotation matrix of each link relative to its parent.
        offsets: Origin of each link frame in its parent, in [m].
    """

    tree: RobotTree
    axes: list[Matrix]
    positions: list[Vector]
    rotations: list[Matrix]
    offsets: list[Vector]

    def position_of(self, frame: LinkFrame) -> list[Number]:
        """Return the origin of a frame, in [m]."""
        lever = turn(self.axes[frame.link], frame.place)
        return add(self.positions[frame.link], lever)

    def axes_of(self, frame: LinkFrame) -> list[list[Number]]:
        """Return the axes of a frame as columns."""
        return multiply(self.axes[frame.link], frame.axes)


def place_links(
    tree: RobotTree, angles: Sequence[Number], torso: Matrix = LEVEL
) -> LinkPoses:
    """Compute the poses of all links.

    Args:
        tree: Kinematic tree.
        angles: Angles of all joints, in [rad], or [m] for slides, in the
            order of the links.
        torso: Axes of the torso in the frame of the result.
    """
    zero: Vector = (0.0, 0.0, 0.0)
    axes, positions = [torso], [zero]
    rotations, offsets = [LEVEL], [zero]
    for link, angle in zip(tree.links[1:], angles, strict=True):
        moved = angle - link.zero
        offset: Vector = link.origin
        if link.kind == HINGE:
            rotation: Matrix = rotation_about(link.axis, moved)
        else:
            rotation = LEVEL
            offset = add(offset, scale(moved, link.axis))
        parent = axes[link.parent]
        axes.append(multiply(parent, rotation))
        positions.append(add(positions[link.parent], turn(parent, offset)))
        rotations.append(rotation)
        offsets.append(offset)
    return LinkPoses(tree, axes, positions, rotations, offsets)


class MassMoments(NamedTuple):
    """Mass and first moment of the subtree of each link.

    Attributes:
        firsts: Mass times CoM of each subtree, in the frame of its link, in
            [kg m].
        masses: Mass of each subtree, in [kg].
    """

    firsts: list[Vector]
    masses: list[float]


def gather_moments(poses: LinkPoses) -> MassMoments:
    """Accumulate the first moments from the last links to the torso.

    Each moment is rotated once, to the frame of its parent, which costs six
    multiplications for a rotation about a coordinate axis.
    """
    links = poses.tree.links
    masses = [link.mass for link in links]
    firsts: list[Vector] = [scale(x.mass, x.com) for x in links]
    for i in range(len(links) - 1, 0, -1):
        parent = links[i].parent
        in_parent = add(
            turn(poses.rotations[i], firsts[i]),
            scale(masses[i], poses.offsets[i]),
        )
        firsts[parent] = add(firsts[parent], in_parent)
        masses[parent] += masses[i]
    return MassMoments(firsts, masses)


class JointMotionAxis(NamedTuple):
    """Motion of a subtree by its joint at unit speed, in the torso frame.

    Attributes:
        angular: Angular velocity of the subtree, in [rad/s].
        linear: Velocity of a point of the subtree, in [m/s].
        moment: Momentum of the subtree, in [kg m/s].
    """

    angular: Vector
    linear: Vector
    moment: Vector


def motion_of(
    poses: LinkPoses, moments: MassMoments, link: int, point: Vector
) -> JointMotionAxis:
    """Return the motion by the joint of a link at unit speed.

    Args:
        poses: Link poses.
        moments: Mass moments of the links.
        link: Index of the link whose joint moves.
        point: Point that is fixed to the link, in [m].
    """
    described = poses.tree.links[link]
    axes, axis = poses.axes[link], described.axis
    along = turn(axes, axis)
    if described.kind != HINGE:
        mass = moments.masses[link]
        return JointMotionAxis((0.0, 0.0, 0.0), along, scale(mass, along))
    lever = [p - q for p, q in zip(point, poses.positions[link], strict=True)]
    moment = turn(axes, cross(axis, moments.firsts[link]))
    return JointMotionAxis(along, cross(along, lever), moment)
