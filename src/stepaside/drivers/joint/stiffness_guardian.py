"""Guardian that releases the joints if control dies or freezes.

The guardian (:mod:`..guardian_process`) is informed of the newest command,
and uses the socket of control, or its own connection, to ramp the stiffness
down. The robot itself need not supervise its client.
"""

from collections.abc import Callable
from contextlib import suppress

import numpy as np

from ...core.errors import StepAsideError
from ...core.poses import Array
from ..guardian_process import Guardian

SILENCE = 0.3  # time without control before the guardian acts, in [s]
FADING = 0.5  # from full stiffness to none, in [s]


class StiffnessGuardian:
    """Guardian of a robot that is driven by its joints."""

    def __init__(
        self,
        fade: Callable[[Array, Array], None],
        *,
        prepare: Callable[[], None] | None = None,
    ) -> None:
        """Fork the guardian.

        Args:
            fade: Function that ramps the stiffness down, given the newest
                targets, in [rad], and stiffness. Called in the guardian
                process.
            prepare: Function called once when the guardian process starts,
                so that ``fade`` needs less time.
        """

        def release(data: bytes) -> None:
            values = np.frombuffer(data, np.float32).astype(np.float64)
            targets, stiffness = np.split(values, 2)
            fade(targets, stiffness)

        self._guardian = Guardian(release, SILENCE, prepare=prepare)
        self.dismiss = self._guardian.dismiss

    def update(self, targets: Array, stiffness: Array) -> None:
        """Report the newest command.

        Args:
            targets: Joint targets, in [rad]. Shape (joints,).
            stiffness: Stiffness, from 0 to 1. Shape (joints,).
        """
        if stiffness.any():
            values = np.concatenate([targets, stiffness]).astype(np.float32)
            self._guardian.hold(values.tobytes())
        else:
            self._guardian.leave()


def guard_release(
    connect: Callable[[], Callable[[], None]],
) -> StiffnessGuardian:
    """Fork a guardian that connects to the robot at once.

    Args:
        connect: Function that connects to the robot and returns a function
            that releases it. Called in the guardian process; called again,
            if it failed at first, when the robot is to be released.
    """
    releases: list[Callable[[], None]] = []

    def prepare() -> None:
        with suppress(StepAsideError):
            releases.append(connect())

    def fade(targets: Array, stiffness: Array) -> None:
        release = releases[0] if releases else connect()
        release()

    return StiffnessGuardian(fade, prepare=prepare)
