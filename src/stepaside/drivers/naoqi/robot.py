"""What NAOqi's services know of a simulated robot that walks by itself."""

from collections import deque
from collections.abc import Sequence
from threading import Lock

from ..velocity.body import REST, Velocity
from ..velocity.footsteps import FootMove
from ..velocity.served import WalkerState


class Robot:
    """What the services share, guarded by one lock.

    Attributes:
        lock: Held by whoever reads or writes.
        state: What the robot said of itself last.
        asked: Velocity that was asked for last.
        steps: Footsteps that have not begun, each with its velocity.
        awake: Whether its motors are stiff.
        posture: Where it stands, or crouches.
        head: Angles that its head is asked for, in [rad], by joint.
        listeners: Who subscribed to its sonars.
        calls: How often anything was asked.
    """

    def __init__(self, state: WalkerState, names: Sequence[str]) -> None:
        """Begin at rest, asleep."""
        self.lock = Lock()
        self.steps: deque[tuple[FootMove, Velocity]] = deque()
        self.state, self.names = state, list(names)
        self.asked = REST
        self.awake, self.fallen, self.pressed = False, False, False
        self.posture = "Crouch"
        self.head: dict[str, float] = {}
        self.listeners: set[str] = set()
        self.calls = 0

    def rest(self) -> None:
        """Forget what was asked for; the lock is held."""
        self.asked = REST
        self.steps.clear()
