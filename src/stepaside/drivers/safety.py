"""Safe operation of a robot driven by its joints: states and conditions."""

import logging
from enum import Enum, IntEnum
from math import atan2, degrees, hypot, inf
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.constants import GRAVITY
from ..core.poses import Array
from ..perception.measurement import RobotState

log = logging.getLogger(__name__)
WARM_UP = 3  # valid frames before the first reaction
FALL = 0.6  # tilt of the torso that counts as a fall, in [rad]
LOOK_AHEAD = 0.15  # over which the tilt is predicted, in [s]
HOTTEST = 80.0  # motor at which the robot rests, in [degC]; an assumption
LONGEST_REACH = 15.0  # of a motion to a posture, in [s]
LONGEST_STOP = 4.0  # for control to stop the robot, in [s]
# The vendor says that a walking robot may be empty 30 s after its own
# warning; stopping and crouching take up to 19 s. A tenth of a charge that
# lasts an hour or more is six minutes.
LOWEST_CHARGE = 0.1  # of the battery at which the robot rests, from 0 to 1
# A tenth of a NAO's weight, and above the 40 g threshold of one sensor.
LEAST_LOAD = 0.5  # below which both feet count as lifted, in [kg]
# Both limits tolerate the landings of a walk. The range of NAO's
# accelerometer is 2 g on each axis, so that it never reads more than 3.5 g.
MIN_FORCE, MAX_FORCE = 0.3 * GRAVITY, 3.5 * GRAVITY
MAX_LEAN = 1.0  # angle of the specific force from upright, in [rad]
FROZEN = 0.2  # constant reading while the legs move, in [s]
MIN_TRAVEL = 0.05  # of a leg's joint, in [rad]: that of 0.1 s of a walk


class SafetyState(Enum):
    """State of a robot that is driven by its joints."""

    LIMP = "limp"  # no stiffness
    REACHING = "reaching"  # moves slowly from any posture to the stance
    READY = "ready"  # stands and waits for the chest button
    WALKING = "walking"  # follows control
    STOPPING = "stopping"  # follows control, which brings the feet together
    RESTING = "resting"  # moves slowly to a crouch, then goes limp

    @property
    def moves_by_control(self) -> bool:
        """Whether the joint targets of control are followed."""
        return self in (SafetyState.WALKING, SafetyState.STOPPING)


class SafetyReaction(IntEnum):
    """Response of the robot to a condition; the largest one applies."""

    STAND = 1  # end a walk; begin none while the condition lasts
    REST = 2  # end a walk, crouch and go limp
    LIMP = 3  # ramp the stiffness down at once


class SafetyInputs(NamedTuple):
    """Safety-relevant values of one valid frame."""

    time: float  # of the frame, by the count of frames, in [s]
    chest_pressed: bool = False
    tilt: float = 0.0  # largest of the torso, now or predicted, in [rad]
    status: int = 0  # worst of a leg's motor
    temperature: float = 25.0  # of the hottest leg motor, in [degC]
    reached: bool = False  # whether a slow motion to a posture is complete
    load: float = inf  # on both feet, in [kg]
    bumper: bool = False
    charge: float = 1.0  # of the battery, from 0 to 1
    current: float = 0.0  # largest of a motor over its stall current
    force: tuple[float, float, float] = (0.0, 0.0, GRAVITY)  # in [m/s^2]
    frozen: float = 0.0  # constant force while the legs move, in [s]
    hindrance: str = ""  # why the robot must not walk


def _accelerometer_fault(inputs: SafetyInputs) -> str:
    x, y, z = inputs.force
    size, lean = hypot(x, y, z), atan2(hypot(x, y), z)
    if size < MIN_FORCE or size > MAX_FORCE:
        return (
            f"accelerometer reads {size:.1f} m/s^2, outside "
            f"[{MIN_FORCE:.1f}, {MAX_FORCE:.1f}] m/s^2"
        )
    if lean > MAX_LEAN:
        return (
            f"accelerometer reads a tilt of {degrees(lean):.0f} deg, which "
            "the torso does not have"
        )
    if inputs.frozen > FROZEN:
        return "accelerometer reading is constant while the legs move"
    return ""


def _conditions(
    inputs: SafetyInputs,
) -> tuple[tuple[SafetyReaction, float, object, str], ...]:
    """Return what may forbid to continue.

    Reactions; times for which they must hold without a break, in [s], longer
    than a landing or a single bad reading; whether they hold; and reasons.
    """
    limp, rest, stand = reversed(SafetyReaction)
    tilt, load, heat = inputs.tilt, inputs.load, inputs.temperature
    current, charge = inputs.current, inputs.charge
    fault, hindrance = _accelerometer_fault(inputs), inputs.hindrance
    lean = f"torso tilts by {tilt:.2f} rad: the robot falls"
    draw = f"a motor draws {current:.1f} times its stall current"
    lifted = f"both feet are lifted: their load is {load:.1f} kg"
    critical = "a motor of the legs reports critical heat"
    hot = "a motor of the legs reports heat"
    warm = f"a motor of the legs has {heat:.0f} degC"
    empty = f"battery is at {100.0 * charge:.0f} %"
    return (
        (limp, 0.0, tilt > FALL, lean),
        (limp, 0.0, inputs.status >= 3, critical),
        (rest, 0.0, inputs.status == 2, hot),
        (rest, 0.0, heat > HOTTEST, warm),
        (rest, 0.5, current > 1.0, draw),
        (rest, 0.5, charge < LOWEST_CHARGE, empty),
        (stand, 0.3, fault, fault),
        (stand, 0.3, load < LEAST_LOAD, lifted),
        (stand, 0.05, inputs.bumper, "a foot bumper is pressed"),
        (stand, 0.0, hindrance, hindrance),
    )


class Safety:
    """State machine that is updated by each frame, without a clock.

    The chest button acts when it is released: it starts a robot that is
    ready, stops one that walks, and wakes one that is limp.

    Attributes:
        state: State of the robot.
        reason: Reason for the state, as a message.
    """

    def __init__(self) -> None:
        """Start limp, before the first frame."""
        self._afterwards = SafetyState.RESTING
        self.state = SafetyState.LIMP
        self.reason = "no frame received yet"
        self._frames = 0
        self._pressed = False
        self._since = 0.0
        self._met: dict[int, float] = {}  # conditions, since times [s]

    def frame(self, inputs: SafetyInputs) -> SafetyState:
        """Update the state by one valid frame, and return it."""
        released = self._pressed and not inputs.chest_pressed
        self._pressed = inputs.chest_pressed
        self._frames += 1
        if self._frames < WARM_UP:
            return self.state
        due = self._due(inputs)
        if due is not None and due[0] > SafetyReaction.STAND:
            self._endangered(*due, inputs)
        elif self._frames == WARM_UP:
            self._enter(SafetyState.REACHING, "connected", inputs.time)
        elif due is not None and self.state is SafetyState.WALKING:
            self._stop(SafetyState.READY, due[1], inputs.time)
        elif released:
            self._button(inputs.time, due[1] if due else "")
        else:
            self._go_on(inputs)
        return self.state

    def halted(self, time: float) -> None:
        """Report that control has stopped the robot."""
        if self.state is not SafetyState.STOPPING:
            return
        if self._afterwards is SafetyState.READY:
            self._enter(SafetyState.READY, self.reason, time)
        else:
            self._enter(SafetyState.RESTING, f"stopped: {self.reason}", time)

    def fail(self, reason: str, time: float) -> None:
        """Go limp for a reason outside the frames, such as a lost link."""
        if self.state is not SafetyState.LIMP:
            self._enter(SafetyState.LIMP, reason, time)

    def rest(self, reason: str, time: float) -> None:
        """Stop and rest on request."""
        if self.state is SafetyState.WALKING:
            self._stop(SafetyState.RESTING, reason, time)
        elif self.state is SafetyState.STOPPING:
            self._afterwards = SafetyState.RESTING
        elif self.state in (SafetyState.READY, SafetyState.REACHING):
            self._enter(SafetyState.RESTING, reason, time)

    def _due(self, inputs: SafetyInputs) -> tuple[SafetyReaction, str] | None:
        """Return the strongest reaction that is due, with its reason."""
        due: tuple[SafetyReaction, str] | None = None
        rows = enumerate(_conditions(inputs))
        for row, (reaction, lasting, holds, why) in rows:
            if not holds:
                self._met.pop(row, None)
                continue
            lasted = inputs.time - self._met.setdefault(row, inputs.time)
            if lasted >= lasting and (due is None or reaction > due[0]):
                due = reaction, why
        return due

    def _enter(self, state: SafetyState, reason: str, time: float) -> None:
        self.state, self.reason, self._since = state, reason, time
        log.info("%s: %s", state.value, reason)

    def _stop(self, afterwards: SafetyState, why: str, time: float) -> None:
        self._afterwards = afterwards
        self._enter(SafetyState.STOPPING, why, time)

    def _endangered(
        self, reaction: SafetyReaction, why: str, inputs: SafetyInputs
    ) -> None:
        state, time = self.state, inputs.time
        if reaction is SafetyReaction.LIMP and state is not SafetyState.LIMP:
            self._enter(SafetyState.LIMP, why, time)
        elif state is SafetyState.LIMP:
            self.reason = why
        elif state is SafetyState.WALKING:
            self._stop(SafetyState.RESTING, why, time)
        elif state in (SafetyState.REACHING, SafetyState.READY):
            self._enter(SafetyState.RESTING, why, time)
        else:
            if self._afterwards is not SafetyState.RESTING:
                self._afterwards, self.reason = SafetyState.RESTING, why
            self._go_on(inputs)

    def _button(self, time: float, hindrance: str) -> None:
        """Follow the chest button, unless a hindrance forbids to walk."""
        after = {
            SafetyState.LIMP: SafetyState.REACHING,
            SafetyState.REACHING: SafetyState.RESTING,
            SafetyState.READY: SafetyState.WALKING,
            SafetyState.WALKING: SafetyState.STOPPING,
            SafetyState.STOPPING: SafetyState.RESTING,
            SafetyState.RESTING: SafetyState.RESTING,
        }[self.state]
        if after is SafetyState.WALKING and hindrance:
            self.reason = hindrance
        elif after is SafetyState.STOPPING:
            self._stop(SafetyState.RESTING, "chest button", time)
        elif after is not self.state:
            self._enter(after, "chest button", time)

    def _go_on(self, inputs: SafetyInputs) -> None:
        """Leave a state that is complete, or that takes too long."""
        state, time = self.state, inputs.time
        passed = time - self._since
        if inputs.reached and state is SafetyState.REACHING:
            self._enter(SafetyState.READY, "stands", time)
        elif inputs.reached and state is SafetyState.RESTING:
            self._enter(SafetyState.LIMP, "rests", time)
        elif state is SafetyState.STOPPING and passed > LONGEST_STOP:
            why = "control did not stop in time"
            self._enter(SafetyState.RESTING, why, time)
        elif state in (SafetyState.REACHING, SafetyState.RESTING):
            if passed > LONGEST_REACH:
                self._enter(
                    SafetyState.LIMP, f"{state.value} took too long", time
                )


class FrozenMeter:
    """Time for which an accelerometer reads the same while legs move."""

    def __init__(self) -> None:
        """Start before the first report."""
        self._read: Array | None = None
        self._since = self._travel = 0.0
        self._begin: Array = np.zeros(0)

    def frozen(
        self, force: Array, legs: Array, now: float, *, walks: bool
    ) -> float:
        """Return the time of a constant reading, if the legs have moved.

        Args:
            force: Specific force, in [m/s^2]. Shape (3,).
            legs: Measured and commanded angles of the legs, in [rad].
            now: Time of the report, in [s].
            walks: Whether control moves the robot. Only then must the
                reading change: a slow motion may stay below the resolution
                of a coarse sensor.
        """
        if not walks:
            self._read = None
            return 0.0
        if self._read is None or np.any(force != self._read):
            self._read, self._since = force, now
            self._begin, self._travel = legs, 0.0
        away = float(np.abs(legs - self._begin).max())
        self._travel = max(self._travel, away)
        return now - self._since if self._travel > MIN_TRAVEL else 0.0


def safety_inputs(
    report: RobotState,
    legs: NDArray[np.intp],
    now: float,
    *,
    pressed: bool,
    reached: bool,
    frozen: float,
) -> SafetyInputs:
    """Return the safety inputs of a report."""
    leans = zip(report.tilt or (0.0, 0.0), report.gyro, strict=False)
    x, y, z = report.accelerometer.tolist()
    inputs = SafetyInputs(
        now,
        chest_pressed=pressed,
        tilt=max(abs(a + LOOK_AHEAD * rate) for a, rate in leans),
        reached=reached,
        force=(x, y, z),
        frozen=frozen,
        hindrance=report.hindrance,
    )
    if not np.isnan(report.foot_forces).all():
        load = float(report.foot_forces.sum()) / GRAVITY
        inputs = inputs._replace(load=load)
    if (status := report.status) is None:
        return inputs
    return inputs._replace(
        status=int(status.heat[legs].max()),
        temperature=float(status.temperature[legs].max()),
        bumper=status.bumped,
        charge=status.charge,
        current=float(np.abs(status.current).max()),
    )
