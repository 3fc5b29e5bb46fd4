"""Conditions under which a robot whose joints are moved must not walk on."""

from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum
from math import atan2, degrees, hypot
from typing import NamedTuple

from ...core.constants import GRAVITY
from ...core.errors import ConfigurationError, check_positive, check_within

UPRIGHT = (0.0, 0.0, GRAVITY)
# Both limits leave room for the landings of a walk. The range of NAO's
# accelerometer is 2 g on each axis, so that it never reads more than 3.5 g.
LEAST_FORCE, MOST_FORCE = 0.3 * GRAVITY, 3.5 * GRAVITY
LEANS = 1.0  # of the specific force from upright, in [rad]
FROZEN = 0.2  # without a change of a digit while the legs move, in [s]


class SafetyReaction(IntEnum):
    """Response of the robot to a condition; the greatest one counts."""

    STAND = 1  # a walk is stopped, and none begins while that lasts
    REST = 2  # a walk is stopped, the robot crouches and goes limp
    LIMP = 3  # the stiffness fades at once


class SafetyInputs(NamedTuple):
    """What the machine needs to know of one good frame.

    Attributes:
        time: Of the frame, by the robot's count of them, in [s].
        chest_pressed: Whether the chest button is down.
        tilt: Largest tilt of the torso, now or soon, in [rad].
        status: Worst status of a leg's motor.
        temperature: Of the hottest motor of the legs, in [degC].
        reached: Whether targets and joints are where the slow motion ends.
        load: Sum of all foot sensors, in [kg].
        bumper: Whether a foot bumper is pressed.
        charge: Of the battery, from 0 to 1.
        current: Largest motor current, as a share of the current at which
            that motor stalls.
        force: Specific force by the accelerometer, in [m/s^2].
        frozen: Time for which the accelerometer has not changed by a digit
            while the legs moved, in [s].
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


@dataclass(frozen=True, slots=True)
class SafetySettings:
    """Limits of what is safe.

    Attributes:
        silence: Without a good frame for this long the session is lost,
            in [s].
        warm_up: Good frames before anything is believed.
        fall: Tilt of the torso from which it is falling, in [rad].
        look_ahead: How far ahead the tilt is looked at, in [s].
        hottest: Temperature at which the robot rests, in [degC]; an
            assumption, the robot's own status comes on top.
        longest_reach: Time in which it must reach a posture, in [s].
        longest_stop: Time in which control must bring it to rest, in [s].
        lowest_charge: Charge of the battery at which the robot rests, from
            0 to 1. The vendor says that a walking robot may be empty 30 s
            after its own warning; stopping and crouching take up to 19 s.
            A tenth of a charge that lasts an hour or more is six minutes.
        least_load: Sum of all foot sensors at which both feet are in the
            air, in [kg]; a tenth of the robot's weight, and above the
            40 g that one sensor does not notice.
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
        """Refuse limits that limit nothing."""
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
    """One row of the table of conditions.

    Attributes:
        reason: Return why the robot must not go on; empty if it may.
        reaction: Response of the robot.
        lasting: Time for which the condition must hold without a break, in
            [s]. Landings are shorter, and so is a single bad reading.
    """

    reason: Callable[[SafetyInputs, SafetySettings], str]
    reaction: SafetyReaction
    lasting: float = 0.0


def _falls(seen: SafetyInputs, limits: SafetySettings) -> str:
    if seen.tilt <= limits.fall:
        return ""
    return f"torso tilts by {seen.tilt:.2f} rad: it falls"


def _is_critical(seen: SafetyInputs, limits: SafetySettings) -> str:
    if seen.status < 3:
        return ""
    return "a motor of the legs reports critical heat"


def _is_hot(seen: SafetyInputs, limits: SafetySettings) -> str:
    if seen.status == 2:
        return "a motor of the legs reports heat"
    if seen.temperature > limits.hottest:
        return f"a motor of the legs has {seen.temperature:.0f} degC"
    return ""


def _is_overloaded(seen: SafetyInputs, limits: SafetySettings) -> str:
    if seen.current <= 1.0:
        return ""
    return f"a motor draws {seen.current:.1f} times its stall current"


def _has_bad_accelerometer(seen: SafetyInputs, limits: SafetySettings) -> str:
    x, y, z = seen.force
    size = hypot(x, y, z)
    if size < LEAST_FORCE or size > MOST_FORCE:
        return f"accelerometer reads {size:.1f} m/s^2 in all: it is broken"
    if (leans := atan2(hypot(x, y), z)) > LEANS:
        return (
            f"accelerometer reads a tilt of {degrees(leans):.0f} deg, which "
            "the torso has not"
        )
    if seen.frozen > FROZEN:
        return "accelerometer does not change while the legs move: it is dead"
    return ""


def _is_empty(seen: SafetyInputs, limits: SafetySettings) -> str:
    if seen.charge >= limits.lowest_charge:
        return ""
    return f"battery is at {100.0 * seen.charge:.0f} %"


def _is_lifted(seen: SafetyInputs, limits: SafetySettings) -> str:
    if seen.load >= limits.least_load:
        return ""
    return f"both feet are in the air: they bear {seen.load:.1f} kg"


def _touches(seen: SafetyInputs, limits: SafetySettings) -> str:
    return "a foot bumper is pressed" if seen.bumper else ""


CONDITIONS = (
    SafetyCondition(_falls, SafetyReaction.LIMP),
    SafetyCondition(_is_critical, SafetyReaction.LIMP),
    SafetyCondition(_is_hot, SafetyReaction.REST),
    SafetyCondition(_is_overloaded, SafetyReaction.REST, lasting=0.5),
    SafetyCondition(_is_empty, SafetyReaction.REST, lasting=0.5),
    SafetyCondition(_has_bad_accelerometer, SafetyReaction.STAND, lasting=0.3),
    SafetyCondition(_is_lifted, SafetyReaction.STAND, lasting=0.3),
    SafetyCondition(_touches, SafetyReaction.STAND, lasting=0.05),
)


class ConditionWatch:
    """Goes through the table of conditions, frame by frame."""

    def __init__(self, settings: SafetySettings) -> None:
        """Begin with no condition met."""
        self._settings = settings
        self._since: dict[int, float] = {}

    def look(self, seen: SafetyInputs) -> tuple[SafetyReaction, str] | None:
        """Return the worst reaction that is due, and its reason, if any.

        Args:
            seen: What the newest frame says.
        """
        due: tuple[SafetyReaction, str] | None = None
        for row, (reason, reaction, lasting) in enumerate(CONDITIONS):
            why = reason(seen, self._settings)
            if not why:
                self._since.pop(row, None)
            elif seen.time - self._since.setdefault(row, seen.time) >= lasting:
                if due is None or reaction > due[0]:
                    due = reaction, why
        return due
