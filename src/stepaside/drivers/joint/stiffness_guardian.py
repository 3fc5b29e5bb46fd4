"""Guardian that releases the joints if control dies or freezes.

The guardian (:mod:`..guardian_process`) is informed of the newest command,
and uses the socket of control, or its own connection, to ramp the stiffness
down. The robot itself need not supervise its client.
"""

from collections.abc import Callable

import numpy as np

from ...core.poses import Array
from ..guardian_process import Guardian

SILENCE = 0.3  # time without control before the guardian acts, in [s]
FADING = 0.5  # from full stiffness to none, in [s]


class StiffnessGuardian:
    """Guardian of a robot that is driven by its joints."""

    def __init__(self, fade: Callable[[Array, Array], None]) -> None:
        """Fork the guardian.

        Args:
            fade: Function that ramps the stiffness down, given the newest
                targets, in [rad], and stiffness. Called in the guardian
                process.
        """

        def release(data: bytes) -> None:
            values = np.frombuffer(data, np.float32).astype(np.float64)
            targets, stiffness = np.split(values, 2)
            fade(targets, stiffness)

        self._guardian = Guardian(release, SILENCE)
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
