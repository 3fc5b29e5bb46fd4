"""What a robot may do now: a state machine without clock or socket."""

from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple

from ...errors import ConfigurationError, check_positive, check_within


class State(Enum):
    """What the robot is doing."""

    LIMP = "limp"  # no stiffness
    REACHING = "reaching"  # slowly from where it is to the stance
    READY = "ready"  # stands, waits for the chest button
    WALKING = "walking"  # control moves it
    STOPPING = "stopping"  # control brings its feet together
    RESTING = "resting"  # slowly down to a crouch, then limp

    @property
    def moves_by_control(self) -> bool:
        """Whether the targets of control reach the joints."""
        return self in (State.WALKING, State.STOPPING)


class Seen(NamedTuple):
    """What the machine needs to know of one good frame.

    Attributes:
        time: On the clock of this computer, in [s].
        chest_pressed: Whether the chest button is down.
        tilt: Largest tilt of the torso, now or soon, in [rad].
        status: Worst status of a leg's motor.
        temperature: Of the hottest motor of the legs, in [degC].
        reached: Whether targets and joints are where the slow motion ends.
    """

    time: float
    chest_pressed: bool = False
    tilt: float = 0.0
    status: int = 0
    temperature: float = 25.0
    reached: bool = False


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
    """

    silence: float = 0.1
    warm_up: int = 3
    fall: float = 0.6
    look_ahead: float = 0.15
    hottest: float = 80.0
    longest_reach: float = 15.0
    longest_stop: float = 4.0

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


class Safety:
    """Decides, frame by frame, what the robot may do, and says why.

    The chest button acts when it is let go: it starts a robot that is
    ready, stops one that walks, and wakes one that lies limp.

    Attributes:
        state: What the robot is doing.
        reason: Why, in words.
    """

    def __init__(self, settings: SafetySettings) -> None:
        """Begin limp, before the first frame."""
        self._settings = settings
        self.state = State.LIMP
        self.reason = "no frame has come yet"
        self._frames = 0
        self._pressed = False
        self._since = 0.0

    def frame(self, seen: Seen) -> State:
        """Take what one good frame says.

        Args:
            seen: What it says.

        Returns:
            What the robot may do until the next.
        """
        released = self._pressed and not seen.chest_pressed
        self._pressed = seen.chest_pressed
        self._frames += 1
        warm = self._settings.warm_up
        if self._frames < warm:
            return self.state
        danger = self._danger(seen)
        if danger is not None:
            self._endangered(*danger, seen)
        elif self._frames == warm:
            self._enter(State.REACHING, "connected", seen.time)
        elif released:
            self._button(seen.time)
        else:
            self._go_on(seen)
        return self.state

    def halted(self, time: float) -> None:
        """Note that control has brought the robot to rest."""
        if self.state is State.STOPPING:
            self._enter(State.RESTING, "stopped", time)

    def fail(self, reason: str, time: float) -> None:
        """Go limp for a reason that no frame says: it cannot be trusted."""
        if self.state is not State.LIMP:
            self._enter(State.LIMP, reason, time)

    def rest(self, reason: str, time: float) -> None:
        """Stop and rest, as someone asks for."""
        if self.state is State.WALKING:
            self._enter(State.STOPPING, reason, time)
        elif self.state in (State.READY, State.REACHING):
            self._enter(State.RESTING, reason, time)

    def _enter(self, state: State, reason: str, time: float) -> None:
        self.state, self.reason, self._since = state, reason, time

    def _danger(self, seen: Seen) -> tuple[State, str] | None:
        """What must end whatever the robot does; the worst first."""
        limits = self._settings
        if seen.tilt > limits.fall:
            return State.LIMP, f"torso tilts by {seen.tilt:.2f} rad: it falls"
        if seen.status >= 3:
            return State.LIMP, "a motor of the legs reports critical heat"
        if seen.status == 2:
            return State.RESTING, "a motor of the legs reports heat"
        if seen.temperature > limits.hottest:
            return (
                State.RESTING,
                f"a motor of the legs has {seen.temperature:.0f} degC",
            )
        return None

    def _endangered(self, wanted: State, why: str, seen: Seen) -> None:
        state, time = self.state, seen.time
        if wanted is State.LIMP:
            if state is not State.LIMP:
                self._enter(State.LIMP, why, time)
            else:
                self.reason = why
        elif state is State.WALKING:
            self._enter(State.STOPPING, why, time)
        elif state is State.LIMP:
            self.reason = why
        elif state in (State.REACHING, State.READY):
            self._enter(State.RESTING, why, time)
        else:
            self._go_on(seen)

    def _button(self, time: float) -> None:
        after = {
            State.LIMP: State.REACHING,
            State.REACHING: State.RESTING,
            State.READY: State.WALKING,
            State.WALKING: State.STOPPING,
            State.STOPPING: State.RESTING,
            State.RESTING: State.RESTING,
        }
        if after[self.state] is self.state:
            return
        self._enter(after[self.state], "chest button", time)

    def _go_on(self, seen: Seen) -> None:
        state = self.state
        if seen.reached and state is State.REACHING:
            self._enter(State.READY, "stands", seen.time)
        elif seen.reached and state is State.RESTING:
            self._enter(State.LIMP, "rests", seen.time)
        else:
            self._overdue(seen.time)

    def _overdue(self, time: float) -> None:
        """End what takes too long."""
        passed, limits = time - self._since, self._settings
        if self.state is State.STOPPING and passed > limits.longest_stop:
            self._enter(State.RESTING, "control did not stop in time", time)
        elif self.state in (State.REACHING, State.RESTING):
            if passed > limits.longest_reach:
                why = f"{self.state.value} took too long"
                self._enter(State.LIMP, why, time)
