"""Kinematic tree of a robot, independent of MuJoCo.

Joints are hinges or slides. The frame of a link is at its joint; in the zero
posture all link frames are parallel to the torso frame. Bodies that are
welded together are one link.
"""

from dataclasses import dataclass
from typing import NamedTuple

from ..core.brief_repr import brief_repr

HINGE, SLIDE = "hinge", "slide"
Triple = tuple[float, float, float]
# Beyond its radius points are still of a moving robot itself, in [m].
OWN_MARGIN = 0.06


class Link(NamedTuple):
    """A link and the joint to its parent.

    Attributes:
        joint: Name of the joint; empty for the torso.
        parent: Index of the parent link; -1 for the torso.
        kind: ``hinge`` or ``slide``.
        axis: Unit axis of the joint in the frame of the link.
        origin: Position of the joint in the frame of the parent, in [m].
        zero: Joint angle [rad] or length [m] in the zero posture.
        low: Lower limit, in [rad] or [m].
        high: Upper limit, in [rad] or [m].
        mass: Mass of the link, in [kg].
        com: CoM of the link in its frame, in [m].
    """

    joint: str
    parent: int
    kind: str
    axis: Triple
    origin: Triple
    zero: float
    low: float
    high: float
    mass: float
    com: Triple


class Servo(NamedTuple):
    """Gains of the position servo of a joint.

    Attributes:
        stiffness: Proportional gain, in [N m/rad]; 0 if the actuator is not
            a position servo.
        damping: Derivative gain, in [N m s/rad].
    """

    stiffness: float
    damping: float


class LinkFrame(NamedTuple):
    """A frame that is fixed to a link.

    Attributes:
        link: Index of the link.
        place: Origin in the frame of the link, in [m].
        axes: Rotation matrix in the frame of the link, row by row.
    """

    link: int
    place: Triple
    axes: tuple[Triple, Triple, Triple]


class BodySize(NamedTuple):
    """Measures of the standing robot, in [m]; by default those of a NAO.

    Attributes:
        height: Height of its highest point.
        radius: Radius around the axis of the torso that contains it.
        trim: Heights of the lower and upper end of what is painted to tell
            robots apart.
    """

    height: float = 0.5725
    radius: float = 0.1614
    trim: tuple[float, float] = (0.0495, 0.5385)


NAO_SIZE = BodySize()


@dataclass(frozen=True, slots=True, eq=False)
class RobotTree:
    """Links, frames and motors of one robot.

    Attributes:
        links: The torso, then a link for each joint, parents first.
        bodies: Frames of the bodies of the model, by name.
        sites: Frames of the sites of the model, by name.
        motors: Actuated joints, in the order of the actuators.
        servos: Servo gains, in the same order.
        followers: Joints that share a motor, as follower to leader.
        size: Measures of the standing robot.
    """

    __repr__ = brief_repr

    links: tuple[Link, ...]
    bodies: dict[str, LinkFrame]
    sites: dict[str, LinkFrame]
    motors: tuple[str, ...]
    servos: tuple[Servo, ...]
    followers: dict[str, str]
    size: BodySize = NAO_SIZE

    @property
    def joints(self) -> tuple[str, ...]:
        """Names of all joints, in the order of the links."""
        return tuple(link.joint for link in self.links[1:])

    @property
    def mass(self) -> float:
        """Mass of the robot, in [kg]."""
        return sum(link.mass for link in self.links)

    @property
    def driven_joints(self) -> tuple[str, ...]:
        """Joints with a motor, their own or that of their leader."""
        return (*self.motors, *self.followers)

    def motor_of(self, joint: str) -> int:
        """Return the index of the motor that moves a joint."""
        return self.motors.index(self.followers.get(joint, joint))

    def link_of(self, joint: str) -> int:
        """Return the index of the link that a joint moves."""
        return self.joints.index(joint) + 1

    def chain(self, link: int) -> list[int]:
        """Return the links from below the torso to ``link``."""
        chain: list[int] = []
        while link > 0:
            chain.insert(0, link)
            link = self.links[link].parent
        return chain
