"""Falling stiffness for a robot whose control died or froze.

The guardian (:mod:`..guardian`) holds the same socket as control, or a line
of its own, and is told what the joints are. A robot need not watch over its
client for this to work.
"""

import socket
from collections.abc import Callable
from contextlib import suppress
from time import sleep

import numpy as np

from ...core.poses import Array
from ..guardian_process import Guardian
from ..lola.lights import lights_for
from .frame_clock import TICK
from .frames import ActuatorFrame, pack_actuators
from .joint_map import JOINT_COUNT
from .safety import RobotState

SILENCE = 0.3  # of control before the guardian acts, in [s]
FADING = 0.5  # from full stiffness to none, in [s]


class StiffnessGuardian:
    """Who lets go of the joints if control cannot."""

    def __init__(self, fade: Callable[[Array, Array], None]) -> None:
        """Fork the guardian.

        Args:
            fade: Lets the stiffness fall, given targets and stiffness that
                the joints were told last, shapes (25,). It is called in the
                other process.
        """

        def let_go_of(word: bytes) -> None:
            told = np.frombuffer(word, np.float32).astype(np.float64)
            fade(told[:JOINT_COUNT], told[JOINT_COUNT:])

        self._guardian = Guardian(let_go_of, SILENCE)
        self.dismiss = self._guardian.dismiss

    def tell(self, targets: Array, stiffness: Array) -> None:
        """Say what the joints were told. Shapes (25,)."""
        if stiffness.any():
            word = np.concatenate([targets, stiffness]).astype(np.float32)
            self._guardian.hold(word.tobytes())
        else:
            self._guardian.leave()


def let_go(robot: socket.socket, targets: Array, stiffness: Array) -> None:
    """Send falling stiffness to a robot, as far as it can be sent."""
    robot.setblocking(False)
    count = round(FADING / TICK)
    for left in range(count - 1, -1, -1):
        frame = ActuatorFrame(
            targets,
            stiffness * (left / count),
            lights_for(RobotState.LIMP, sees=False, charge=0.0),
        )
        with suppress(BlockingIOError):
            while robot.recv(1 << 16):
                pass  # what it says does not matter now
        try:
            robot.send(pack_actuators(frame))
        except BlockingIOError:
            pass
        except OSError:
            return
        sleep(TICK)
