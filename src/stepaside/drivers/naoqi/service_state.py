"""State shared by the NAOqi services of a robot with walking control."""

from collections import deque
from collections.abc import Mapping, Sequence
from threading import Lock

from ..velocity.footstep_commands import FootCommand
from ..velocity.velocity_body import REST, VelocityCommand
from ..velocity.walking_robot import WalkerState
from .joint_chains import LEGS


class WalkServiceState:
    """State that the services share, guarded by a lock.

    Attributes:
        lock: Must be held to read or write the other attributes.
        state: Newest state of the robot.
        asked: Newest velocity command.
        steps: Pending footsteps, each with its velocity.
        awake: Whether the legs are stiff.
        limp: Joints whose stiffness has been set to zero.
        posture: Present posture, one of ``POSTURES``.
        head: Commanded angles of the head joints, in [rad], by name.
        listeners: Names of the sonars' subscribers.
        calls: Number of calls so far.
    """

    def __init__(self, state: WalkerState, names: Sequence[str]) -> None:
        """Start crouched and limp."""
        self.lock = Lock()
        self.steps: deque[tuple[FootCommand, VelocityCommand]] = deque()
        self.state, self.names = state, list(names)
        self.asked = REST
        self.awake, self.fallen, self.pressed = False, False, False
        self.limp: set[str] = set()
        self.posture = "Crouch"
        self.head: dict[str, float] = {}
        self.listeners: set[str] = set()
        self.calls = 0

    def stiffen(self, stiffness: Mapping[str, float]) -> None:
        """Set the stiffness of joints; the caller holds the lock.

        A robot with a limp leg joint is not awake, and stops.

        Args:
            stiffness: Stiffness by joint, from 0 to 1.
        """
        for joint, value in stiffness.items():
            if value > 0.0:
                self.limp.discard(joint)
            else:
                self.limp.add(joint)
        legs = [name for name in self.names if name in LEGS] or self.names
        if any(leg in stiffness for leg in legs):
            self.awake = not any(leg in self.limp for leg in legs)
            if not self.awake:
                self.rest()

    def rest(self) -> None:
        """Clear velocity and footsteps; the caller holds the lock."""
        self.asked = REST
        self.steps.clear()
