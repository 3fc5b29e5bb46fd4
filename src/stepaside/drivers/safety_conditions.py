"""Conditions that end a walk of a robot driven by its joints."""

from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum
from math import atan2, degrees, hypot, inf
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.constants import GRAVITY
from ..core.errors import ConfigurationError, check_positive, check_within
from ..core.poses import Array
from ..perception.measurement import RobotState

UPRIGHT = (0.0, 0.0, GRAVITY)
# Both limits tolerate the landings of a walk. The range of NAO's
# accelerometer is 2 g on each axis, so that it never reads more than 3.5 g.
MIN_FORCE, MAX_FORCE = 0.3 * GRAVITY, 3.5 * GRAVITY
MAX_LEAN = 1.0  # angle of the specific force from upright, in [rad]
FROZEN = 0.2  # constant reading while the legs move, in [s]
MIN_TRAVEL = 0.05  # of a leg's joint, in [rad]: that of 0.1 s of a walk


class SafetyReaction(IntEnum):
    """Response of the robot to a condition; the largest one applies."""

    STAND = 1  # end a walk; begin none while the condition lasts
    REST = 2  # end a walk, crouch and go limp
    LIMP = 3  # ramp the stiffness down at once


class SafetyInputs(NamedTuple):
    """Safety-relevant values of one valid frame.

    Attributes:
        time: Time of the frame, by the count of frames, in [s].
        chest_pressed: Whether the chest button is pressed.
        tilt: Largest tilt of the torso, present or predicted, in [rad].
        status: Worst status of a leg's motor.
        temperature: Temperature of the hottest leg motor, in [degC].
        reached: Whether a slow motion to a posture is complete.
        load: Sum of all foot sensors, in [kg].
        bumper: Whether a foot bumper is pressed.
        charge: Charge of the battery, from 0 to 1.
        current: Largest ratio of a motor's current to its stall current.
        force: Specific force by the accelerometer, in [m/s^2].
        frozen: Time for which the accelerometer's reading has been constant
            while the legs moved, in [s].
        hindrance: Reason by the robot why it must not walk; empty if it may.
    """

    time: float
    chest_pressed: bool = False
    tilt: float = 0.0
    status: int = 0
    temperature: float = 25.0
    reached: bool = False
    load: float = 5.3
    bumper: bool = False
    charge: float = 1.0
    current: float = 0.0
    force: tuple[float, float, float] = UPRIGHT
    frozen: float = 0.0
    hindrance: str = ""


@dataclass(frozen=True, slots=True)
class SafetySettings:
    """Limits of safe operation.

    Attributes:
        silence: Time without a valid frame after which the session is lost,
            in [s].
        warm_up: Number of valid frames before the first reaction.
        fall: Tilt of the torso that counts as a fall, in [rad].
        look_ahead: Time over which the tilt is predicted, in [s].
        hottest: Motor temperature at which the robot rests, in [degC]; an
            assumption, in addition to the robot's own status.
        longest_reach: Time limit of a motion to a posture, in [s].
        longest_stop: Time limit for control to stop the robot, in [s].
        lowest_charge: Charge of the battery at which the robot rests, from
            0 to 1. The vendor says that a walking robot may be empty 30 s
            after its own warning; stopping and crouching take up to 19 s.
            A tenth of a charge that lasts an hour or more is six minutes.
        least_load: Sum of all foot sensors below which both feet count as
            lifted, in [kg]; a tenth of the robot's weight, and above the
            40 g threshold of one sensor.
    """

    silence: float = 0.1
    warm_up: int = 3
    fall: float = 0.6
    look_ahead: float = 0.15
    hottest: float = 80.0
    longest_reach: float = 15.0
    longest_stop: float = 4.0
    lowest_charge: float = 0.1
    least_load: float = 0.5

    def __post_init__(self) -> None:
        """Validate the limits."""
        error = ConfigurationError
        check_within(self.silence, 0.012, 60.0, "silence", "s", error)
        check_within(self.warm_up, 1, 1000, "warm_up", "frames", error)
        check_within(self.fall, 0.1, 1.5, "fall", "rad", error)
        check_within(self.look_ahead, 0.0, 1.0, "look_ahead", "s", error)
        check_within(self.hottest, 40.0, 100.0, "hottest", "degC", error)
        for name in ("longest_reach", "longest_stop"):
            check_positive(getattr(self, name), name, "s", error)
        charge = self.lowest_charge
        check_within(charge, 0.0, 0.9, "lowest_charge", "share", error)
        check_within(self.least_load, 0.0, 5.0, "least_load", "kg", error)


class SafetyCondition(NamedTuple):
    """Condition and reaction.

    Attributes:
        reason: Function that returns why the robot must not continue; empty
            if it may.
        reaction: Response of the robot.
        lasting: Time for which the condition must hold without a break, in
            [s]; longer than a landing, or a single bad reading.
    """

    reason: Callable[[SafetyInputs, SafetySettings], str]
    reaction: SafetyReaction
    lasting: float = 0.0


def _falls(inputs: SafetyInputs, limits: SafetySettings) -> str:
    if inputs.tilt <= limits.fall:
        return ""
    return f"torso tilts by {inputs.tilt:.2f} rad: the robot falls"


def _is_critical(inputs: SafetyInputs, limits: SafetySettings) -> str:
    if inputs.status < 3:
        return ""
    return "a motor of the legs reports critical heat"


def _is_hot(inputs: SafetyInputs, limits: SafetySettings) -> str:
    if inputs.status == 2:
        return "a motor of the legs reports heat"
    if inputs.temperature > limits.hottest:
        return f"a motor of the legs has {inputs.temperature:.0f} degC"
    return ""


def _is_overloaded(inputs: SafetyInputs, limits: SafetySettings) -> str:
    if inputs.current <= 1.0:
        return ""
    return f"a motor draws {inputs.current:.1f} times its stall current"


def _has_bad_accelerometer(
    inputs: SafetyInputs, limits: SafetySettings
) -> str:
    x, y, z = inputs.force
    size = hypot(x, y, z)
    if size < MIN_FORCE or size > MAX_FORCE:
        return (
            f"accelerometer reads {size:.1f} m/s^2, outside "
            f"[{MIN_FORCE:.1f}, {MAX_FORCE:.1f}] m/s^2"
        )
    if (lean := atan2(hypot(x, y), z)) > MAX_LEAN:
        return (
            f"accelerometer reads a tilt of {degrees(lean):.0f} deg, which "
            "the torso does not have"
        )
    if inputs.frozen > FROZEN:
        return "accelerometer reading is constant while the legs move"
    return ""


def _is_empty(inputs: SafetyInputs, limits: SafetySettings) -> str:
    if inputs.charge >= limits.lowest_charge:
        return ""
    return f"battery is at {100.0 * inputs.charge:.0f} %"


def _is_lifted(inputs: SafetyInputs, limits: SafetySettings) -> str:
    if inputs.load >= limits.least_load:
        return ""
    return f"both feet are lifted: their load is {inputs.load:.1f} kg"


def _touches(inputs: SafetyInputs, limits: SafetySettings) -> str:
    return "a foot bumper is pressed" if inputs.bumper else ""


def _is_hindered(inputs: SafetyInputs, limits: SafetySettings) -> str:
    return inputs.hindrance


CONDITIONS = (
    SafetyCondition(_falls, SafetyReaction.LIMP),
    SafetyCondition(_is_critical, SafetyReaction.LIMP),
    SafetyCondition(_is_hot, SafetyReaction.REST),
    SafetyCondition(_is_overloaded, SafetyReaction.REST, lasting=0.5),
    SafetyCondition(_is_empty, SafetyReaction.REST, lasting=0.5),
    SafetyCondition(_has_bad_accelerometer, SafetyReaction.STAND, lasting=0.3),
    SafetyCondition(_is_lifted, SafetyReaction.STAND, lasting=0.3),
    SafetyCondition(_touches, SafetyReaction.STAND, lasting=0.05),
    SafetyCondition(_is_hindered, SafetyReaction.STAND),
)


class ConditionMonitor:
    """Evaluation of all conditions, frame by frame."""

    def __init__(self, settings: SafetySettings) -> None:
        """Start with no condition met."""
        self._settings = settings
        self._since: dict[int, float] = {}

    def check(self, inputs: SafetyInputs) -> tuple[SafetyReaction, str] | None:
        """Return the strongest reaction that is due, with its reason.

        Args:
            inputs: Values of the newest frame.
        """
        due: tuple[SafetyReaction, str] | None = None
        for row, (reason, reaction, lasting) in enumerate(CONDITIONS):
            why = reason(inputs, self._settings)
            if not why:
                self._since.pop(row, None)
            elif (
                inputs.time - self._since.setdefault(row, inputs.time)
                >= lasting
            ):
                if due is None or reaction > due[0]:
                    due = reaction, why
        return due


class SafetyMonitor:
    """Safety inputs of each report, with memory of the accelerometer."""

    def __init__(self, look_ahead: float, legs: NDArray[np.intp]) -> None:
        """Start before the first report.

        Args:
            look_ahead: Time over which the tilt is predicted, in [s].
            legs: Indices of the motors that carry the robot. Shape (legs,).
        """
        self._look_ahead, self._legs = look_ahead, legs
        self._read: Array | None = None
        self._since = 0.0
        self._begin: Array = np.zeros(0)
        self._travel = 0.0

    def update(
        self,
        report: RobotState,
        now: float,
        *,
        walks: bool,
        reached: bool,
        pressed: bool,
    ) -> SafetyInputs:
        """Return the safety inputs of a report.

        Args:
            report: Newest valid report.
            now: Time of the report, in [s].
            walks: Whether control moves the robot. Only then must the
                accelerometer's reading change: a slow motion may stay below
                the resolution of a coarse sensor.
            reached: Whether a slow motion to a posture is complete.
            pressed: Whether the button is pressed.
        """
        leans = zip(report.tilt or (0.0, 0.0), report.gyro, strict=False)
        x, y, z = report.accelerometer.tolist()
        forces, legs = report.foot_forces, self._legs
        inputs = SafetyInputs(
            now,
            chest_pressed=pressed,
            tilt=max(abs(a + self._look_ahead * rate) for a, rate in leans),
            reached=reached,
            load=inf
            if np.isnan(forces).all()
            else float(forces.sum()) / GRAVITY,
            force=(x, y, z),
            hindrance=report.hindrance,
            frozen=self._frozen(report, now) if walks else self._forget(),
        )
        if (status := report.status) is None:
            return inputs
        return inputs._replace(
            status=int(status.heat[legs].max()),
            temperature=float(status.temperature[legs].max()),
            bumper=status.bumped,
            charge=status.charge,
            current=float(np.abs(status.current).max()),
        )

    def _forget(self) -> float:
        self._read = None
        return 0.0

    def _frozen(self, report: RobotState, now: float) -> float:
        """Return the time of a constant reading, if the legs have moved."""
        legs, force = report.joint_positions[self._legs], report.accelerometer
        if self._read is None or np.any(force != self._read):
            self._read, self._since = force, now
            self._begin, self._travel = legs, 0.0
        away = float(np.abs(legs - self._begin).max())
        self._travel = max(self._travel, away)
        return now - self._since if self._travel > MIN_TRAVEL else 0.0
