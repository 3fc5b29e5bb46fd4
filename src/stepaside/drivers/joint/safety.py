"""What a robot may do now: a state machine without clock or socket."""

from enum import Enum

from .safety_conditions import (
    ConditionWatch,
    SafetyInputs,
    SafetyReaction,
    SafetySettings,
)


class RobotState(Enum):
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
        return self in (RobotState.WALKING, RobotState.STOPPING)


class Safety:
    """Decides, frame by frame, what the robot may do, and says why.

    The chest button acts when it is let go: it starts a robot that is
    ready, stops one that walks, and wakes one that lies limp. What ends a
    walk without it stands in the table of :mod:`.conditions`.

    Attributes:
        state: What the robot is doing.
        reason: Why, in words.
    """

    def __init__(self, settings: SafetySettings) -> None:
        """Begin limp, before the first frame."""
        self._settings = settings
        self._watch = ConditionWatch(settings)
        self._afterwards = RobotState.RESTING
        self.state = RobotState.LIMP
        self.reason = "no frame has come yet"
        self._frames = 0
        self._pressed = False
        self._since = 0.0

    def frame(self, seen: SafetyInputs) -> RobotState:
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
        due = self._watch.look(seen)
        if due is not None and due[0] > SafetyReaction.STAND:
            self._endangered(*due, seen)
        elif self._frames == warm:
            self._enter(RobotState.REACHING, "connected", seen.time)
        elif due is not None and self.state is RobotState.WALKING:
            self._stop(RobotState.READY, due[1], seen.time)
        elif released:
            self._button(seen.time, due[1] if due else "")
        else:
            self._go_on(seen)
        return self.state

    def halted(self, time: float) -> None:
        """Note that control has brought the robot to rest."""
        if self.state is not RobotState.STOPPING:
            return
        if self._afterwards is RobotState.READY:
            self._enter(RobotState.READY, self.reason, time)
        else:
            self._enter(RobotState.RESTING, f"stopped: {self.reason}", time)

    def fail(self, reason: str, time: float) -> None:
        """Go limp for a reason that no frame says: it cannot be trusted."""
        if self.state is not RobotState.LIMP:
            self._enter(RobotState.LIMP, reason, time)

    def rest(self, reason: str, time: float) -> None:
        """Stop and rest, as someone asks for."""
        if self.state is RobotState.WALKING:
            self._stop(RobotState.RESTING, reason, time)
        elif self.state is RobotState.STOPPING:
            self._afterwards = RobotState.RESTING
        elif self.state in (RobotState.READY, RobotState.REACHING):
            self._enter(RobotState.RESTING, reason, time)

    def _enter(self, state: RobotState, reason: str, time: float) -> None:
        self.state, self.reason, self._since = state, reason, time

    def _stop(self, afterwards: RobotState, why: str, time: float) -> None:
        self._afterwards = afterwards
        self._enter(RobotState.STOPPING, why, time)

    def _endangered(
        self, reaction: SafetyReaction, why: str, seen: SafetyInputs
    ) -> None:
        state, time = self.state, seen.time
        if reaction is SafetyReaction.LIMP and state is not RobotState.LIMP:
            self._enter(RobotState.LIMP, why, time)
        elif state is RobotState.LIMP:
            self.reason = why
        elif state is RobotState.WALKING:
            self._stop(RobotState.RESTING, why, time)
        elif state in (RobotState.REACHING, RobotState.READY):
            self._enter(RobotState.RESTING, why, time)
        else:
            if self._afterwards is not RobotState.RESTING:
                self._afterwards, self.reason = RobotState.RESTING, why
            self._go_on(seen)

    def _button(self, time: float, hindrance: str) -> None:
        """Follow the chest button, unless a robot that stands must stay."""
        after = {
            RobotState.LIMP: RobotState.REACHING,
            RobotState.REACHING: RobotState.RESTING,
            RobotState.READY: RobotState.WALKING,
            RobotState.WALKING: RobotState.STOPPING,
            RobotState.STOPPING: RobotState.RESTING,
            RobotState.RESTING: RobotState.RESTING,
        }[self.state]
        if after is RobotState.WALKING and hindrance:
            self.reason = hindrance
        elif after is RobotState.STOPPING:
            self._stop(RobotState.RESTING, "chest button", time)
        elif after is not self.state:
            self._enter(after, "chest button", time)

    def _go_on(self, seen: SafetyInputs) -> None:
        state = self.state
        if seen.reached and state is RobotState.REACHING:
            self._enter(RobotState.READY, "stands", seen.time)
        elif seen.reached and state is RobotState.RESTING:
            self._enter(RobotState.LIMP, "rests", seen.time)
        else:
            self._overdue(seen.time)

    def _overdue(self, time: float) -> None:
        """End what takes too long."""
        passed, limits = time - self._since, self._settings
        if self.state is RobotState.STOPPING and passed > limits.longest_stop:
            self._enter(
                RobotState.RESTING, "control did not stop in time", time
            )
        elif self.state in (RobotState.REACHING, RobotState.RESTING):
            if passed > limits.longest_reach:
                why = f"{self.state.value} took too long"
                self._enter(RobotState.LIMP, why, time)
