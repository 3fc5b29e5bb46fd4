"""Monitor that derives the safety inputs from sensor frames."""

import numpy as np

from ...core.poses import Array
from .frames import JointFrame
from .joint_map import MotorTable
from .safety_conditions import SafetyInputs

MIN_TRAVEL = 0.05  # of a leg's joint, in [rad]: that of 0.1 s of a walk


class SafetyMonitor:
    """Monitor of sensor frames, with memory of the accelerometer."""

    def __init__(self, look_ahead: float, motors: MotorTable) -> None:
        """Start before the first frame.

        Args:
            look_ahead: Time over which the tilt is predicted, in [s].
            motors: Motors of the robot.
        """
        self._look_ahead, self._motors = look_ahead, motors
        self._read: Array | None = None
        self._since = 0.0
        self._legs: Array = np.zeros(0)
        self._travel = 0.0

    def update(
        self, frame: JointFrame, now: float, *, walks: bool, reached: bool
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
        x, y, z = frame.accelerometer.tolist()
        motors = self._motors
        current_ratios = np.abs(frame.current) / motors.stall_current
        return SafetyInputs(
            now,
            chest_pressed=frame.chest_pressed,
            tilt=max(abs(a + self._look_ahead * rate) for a, rate in leans),
            status=max(frame.status[leg] for leg in motors.legs),
            temperature=float(frame.temperature[motors.legs].max()),
            reached=reached,
            load=frame.load,
            bumper=frame.bumper_pressed,
            charge=frame.charge,
            current=float(current_ratios.max()),
            force=(x, y, z),
            hindrance=frame.hindrance,
            frozen=self._frozen(frame, now) if walks else self._forget(),
        )

    def _forget(self) -> float:
        self._read = None
        return 0.0

    def _frozen(self, frame: JointFrame, now: float) -> float:
        """Return the time of a constant reading, if the legs have moved."""
        legs = frame.position[self._motors.legs]
        if self._read is None or np.any(frame.accelerometer != self._read):
            self._read, self._since = frame.accelerometer, now
            self._legs, self._travel = legs, 0.0
        away = float(np.abs(legs - self._legs).max())
        self._travel = max(self._travel, away)
        return now - self._since if self._travel > MIN_TRAVEL else 0.0
