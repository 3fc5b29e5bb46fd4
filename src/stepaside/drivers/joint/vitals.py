"""Monitor that derives the safety inputs from sensor frames."""

import numpy as np

from ...core.poses import Array
from ..lola.conventions import CHEST_BUTTON, FOOT_BUMPERS
from .frames import SensorFrame
from .joint_map import LEGS, STALL_CURRENT
from .safety_conditions import SafetyInputs

MIN_TRAVEL = 0.05  # of a leg's joint, in [rad]: that of 0.1 s of a walk


class Vitals:
    """Monitor of sensor frames, with memory of the accelerometer."""

    def __init__(self, look_ahead: float) -> None:
        """Start before the first frame.

        Args:
            look_ahead: Time over which the tilt is predicted, in [s].
        """
        self._look_ahead = look_ahead
        self._read: Array | None = None
        self._since = 0.0
        self._legs: Array = np.zeros(0)
        self._travel = 0.0

    def update(
        self, frame: SensorFrame, now: float, *, walks: bool, reached: bool
    ) -> SafetyInputs:
        """Return the safety inputs of a frame.

        Args:
            frame: Newest valid frame.
            now: Time of the frame, in [s].
            walks: Whether control moves the robot. Only then must the
                accelerometer's reading change: a slow motion may stay below
                the resolution of a coarse sensor.
            reached: Whether a slow motion to a posture is complete.
        """
        leans = zip(frame.angles, frame.gyroscope.tolist(), strict=False)
        x, y, z = (-frame.accelerometer).tolist()
        return SafetyInputs(
            now,
            chest_pressed=frame.touch[CHEST_BUTTON] > 0.5,
            tilt=max(abs(a + self._look_ahead * rate) for a, rate in leans),
            status=max(frame.status[LEGS]),
            temperature=float(frame.temperature[LEGS].max()),
            reached=reached,
            load=float(frame.fsr.sum()),
            bumper=any(frame.touch[at] > 0.5 for at in FOOT_BUMPERS),
            charge=frame.battery[0],
            current=float((np.abs(frame.current) / STALL_CURRENT).max()),
            force=(x, y, z),
            frozen=self._frozen(frame, now) if walks else self._forget(),
        )

    def _forget(self) -> float:
        self._read = None
        return 0.0

    def _frozen(self, frame: SensorFrame, now: float) -> float:
        """Return the time of a constant reading, if the legs have moved."""
        legs = frame.position[LEGS]
        if self._read is None or np.any(frame.accelerometer != self._read):
            self._read, self._since = frame.accelerometer, now
            self._legs, self._travel = legs, 0.0
        away = float(np.abs(legs - self._legs).max())
        self._travel = max(self._travel, away)
        return now - self._since if self._travel > MIN_TRAVEL else 0.0
