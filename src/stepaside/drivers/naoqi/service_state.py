"""What NAOqi's services know of a simulated robot that walks by itself."""

from collections import deque
from collections.abc import Mapping, Sequence
from threading import Lock

from ..velocity.footstep_commands import FootCommand
from ..velocity.velocity_body import REST, VelocityCommand
from ..velocity.walking_robot import WalkerState
from .joint_chains import LEGS


class WalkServiceState:
    """What the services share, guarded by one lock.

    Attributes:
        lock: Held by whoever reads or writes.
        state: What the robot said of itself last.
        asked: Velocity that was asked for last.
        steps: Footsteps that have not begun, each with its velocity.
        awake: Whether its legs are stiff.
        limp: Joints without stiffness, of a robot that is awake.
        posture: Where it stands, or crouches.
        head: Angles that its head is asked for, in [rad], by joint.
        listeners: Who subscribed to its sonars.
        calls: How often anything was asked.
    """

    def __init__(self, state: WalkerState, names: Sequence[str]) -> None:
        """Begin at rest, asleep."""
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

    def stiffen(self, shares: Mapping[str, float]) -> None:
        """Set the stiffness of joints; the lock is held.

        A robot whose legs go limp is asleep, and does not walk any more.

        Args:
            shares: Of the full torque, by joint.
        """
        for joint, share in shares.items():
            (self.limp.discard if share > 0.0 else self.limp.add)(joint)
        legs = [name for name in self.names if name in LEGS] or self.names
        if any(leg in shares for leg in legs):
            self.awake = not any(leg in self.limp for leg in legs)
            if not self.awake:
                self.rest()

    def rest(self) -> None:
        """Forget what was asked for; the lock is held."""
        self.asked = REST
        self.steps.clear()
