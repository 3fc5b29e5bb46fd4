"""State machine of safe operation, without a clock or connection."""

from enum import Enum

from .safety_conditions import (
    ConditionMonitor,
    SafetyInputs,
    SafetyReaction,
    SafetySettings,
)


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


class Safety:
    """State machine that is updated by each frame.

    The chest button acts when it is released: it starts a robot that is
    ready, stops one that walks, and wakes one that is limp. The conditions
    that end a walk without it are in :mod:`.safety_conditions`.

    Attributes:
        state: State of the robot.
        reason: Reason for the state, as a message.
    """

    def __init__(self, settings: SafetySettings) -> None:
        """Start limp, before the first frame."""
        self._settings = settings
        self._watch = ConditionMonitor(settings)
        self._afterwards = SafetyState.RESTING
        self.state = SafetyState.LIMP
        self.reason = "no frame received yet"
        self._frames = 0
        self._pressed = False
        self._since = 0.0

    def frame(self, inputs: SafetyInputs) -> SafetyState:
        """Update the state by one valid frame.

        Args:
            inputs: Safety-relevant values of the frame.

        Returns:
            State until the next frame.
        """
        released = self._pressed and not inputs.chest_pressed
        self._pressed = inputs.chest_pressed
        self._frames += 1
        warm = self._settings.warm_up
        if self._frames < warm:
            return self.state
        due = self._watch.check(inputs)
        if due is not None and due[0] > SafetyReaction.STAND:
            self._endangered(*due, inputs)
        elif self._frames == warm:
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

    def _enter(self, state: SafetyState, reason: str, time: float) -> None:
        self.state, self.reason, self._since = state, reason, time

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
        state = self.state
        if inputs.reached and state is SafetyState.REACHING:
            self._enter(SafetyState.READY, "stands", inputs.time)
        elif inputs.reached and state is SafetyState.RESTING:
            self._enter(SafetyState.LIMP, "rests", inputs.time)
        else:
            self._check_duration(inputs.time)

    def _check_duration(self, time: float) -> None:
        """Leave a state that takes too long."""
        passed, limits = time - self._since, self._settings
        if self.state is SafetyState.STOPPING and passed > limits.longest_stop:
            self._enter(
                SafetyState.RESTING, "control did not stop in time", time
            )
        elif self.state in (SafetyState.REACHING, SafetyState.RESTING):
            if passed > limits.longest_reach:
                why = f"{self.state.value} took too long"
                self._enter(SafetyState.LIMP, why, time)
