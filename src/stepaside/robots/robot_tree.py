"""Kinematic tree of a robot, independent of MuJoCo.

Joints are hinges or slides. The frame of a link is at its joint; in the zero
posture all link frames are parallel to the torso frame. Bodies that are
welded together are one link.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

HINGE, SLIDE = "hinge", "slide"
UNLIMITED = 1e6  # limit of joints without limits, in [rad] or [m]
Triple = tuple[float, float, float]
# Beyond its radius points are still of a moving robot itself, in [m].
OWN_MARGIN = 0.06


class Link(NamedTuple):
    """A link and the joint to its parent."""

    joint: str  # name of the joint; empty for the torso
    parent: int  # index of the parent link; -1 for the torso
    kind: str  # ``hinge`` or ``slide``
    axis: Triple  # unit axis of the joint in the frame of the link
    origin: Triple  # position of the joint in the frame of the parent [m]
    zero: float  # joint angle [rad] or length [m] in the zero posture
    low: float  # lower limit [rad] or [m]
    high: float  # upper limit [rad] or [m]
    mass: float  # mass of the link [kg]
    com: Triple  # CoM of the link in its frame [m]


class Servo(NamedTuple):
    """Gains of the position servo of a joint."""

    # proportional gain [N m/rad]; 0 if the actuator is not a position servo
    stiffness: float
    damping: float  # derivative gain [N m s/rad]


class LinkFrame(NamedTuple):
    """A frame that is fixed to a link."""

    link: int
    place: Triple  # origin in the frame of the link [m]
    # rotation matrix in the frame of the link, row by row
    axes: tuple[Triple, Triple, Triple]


class BodySize(NamedTuple):
    """Measures of the standing robot, in [m]; by default those of a NAO."""

    height: float = 0.5725  # height of its highest point
    # radius around the axis of the torso that contains it
    radius: float = 0.1614
    # heights of the lower and upper end of what is painted to tell robots
    # apart
    trim: tuple[float, float] = (0.0495, 0.5385)


NAO_SIZE = BodySize()


@dataclass(frozen=True, slots=True, eq=False)
class RobotTree:
    """Links, frames and motors of one robot."""

    # the torso, then a link for each joint, parents first
    links: tuple[Link, ...]
    bodies: dict[str, LinkFrame]  # frames of the bodies of the model, by name
    sites: dict[str, LinkFrame]  # frames of the sites of the model, by name
    motors: tuple[str, ...]  # actuated joints, in the order of the actuators
    servos: tuple[Servo, ...]  # servo gains, in the same order
    # joints that share a motor, as follower to leader
    followers: dict[str, str]
    size: BodySize = NAO_SIZE  # measures of the standing robot

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

    def moved_by(
        self, names: Sequence[str], standing: Mapping[str, float]
    ) -> tuple[dict[str, int], dict[str, float]]:
        """Return which of the named joints moves each joint, by its index.

        The others stay at their standing angles, which follow, in [rad].
        """
        columns, fixed = {}, {}
        for joint in self.joints:
            leader = self.followers.get(joint, joint)
            if leader in names:
                columns[joint] = names.index(leader)
            else:
                fixed[joint] = float(standing.get(leader, 0.0))
        return columns, fixed

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
