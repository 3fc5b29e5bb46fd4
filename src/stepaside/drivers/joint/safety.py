"""What a robot may do now: a state machine without clock or socket."""

from enum import Enum

from .safety_conditions import Reaction, SafetySettings, Seen, Watch


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
        self._watch = Watch(settings)
        self._afterwards = State.RESTING
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
        due = self._watch.look(seen)
        if due is not None and due[0] > Reaction.STAND:
            self._endangered(*due, seen)
        elif self._frames == warm:
            self._enter(State.REACHING, "connected", seen.time)
        elif due is not None and self.state is State.WALKING:
            self._stop(State.READY, due[1], seen.time)
        elif released:
            self._button(seen.time, due[1] if due else "")
        else:
            self._go_on(seen)
        return self.state

    def halted(self, time: float) -> None:
        """Note that control has brought the robot to rest."""
        if self.state is not State.STOPPING:
            return
        if self._afterwards is State.READY:
            self._enter(State.READY, self.reason, time)
        else:
            self._enter(State.RESTING, f"stopped: {self.reason}", time)

    def fail(self, reason: str, time: float) -> None:
        """Go limp for a reason that no frame says: it cannot be trusted."""
        if self.state is not State.LIMP:
            self._enter(State.LIMP, reason, time)

    def rest(self, reason: str, time: float) -> None:
        """Stop and rest, as someone asks for."""
        if self.state is State.WALKING:
            self._stop(State.RESTING, reason, time)
        elif self.state is State.STOPPING:
            self._afterwards = State.RESTING
        elif self.state in (State.READY, State.REACHING):
            self._enter(State.RESTING, reason, time)

    def _enter(self, state: State, reason: str, time: float) -> None:
        self.state, self.reason, self._since = state, reason, time

    def _stop(self, afterwards: State, why: str, time: float) -> None:
        self._afterwards = afterwards
        self._enter(State.STOPPING, why, time)

    def _endangered(self, reaction: Reaction, why: str, seen: Seen) -> None:
        state, time = self.state, seen.time
        if reaction is Reaction.LIMP and state is not State.LIMP:
            self._enter(State.LIMP, why, time)
        elif state is State.LIMP:
            self.reason = why
        elif state is State.WALKING:
            self._stop(State.RESTING, why, time)
        elif state in (State.REACHING, State.READY):
            self._enter(State.RESTING, why, time)
        else:
            if self._afterwards is not State.RESTING:
                self._afterwards, self.reason = State.RESTING, why
            self._go_on(seen)

    def _button(self, time: float, hindrance: str) -> None:
        """Follow the chest button, unless a robot that stands must stay."""
        after = {
            State.LIMP: State.REACHING,
            State.REACHING: State.RESTING,
            State.READY: State.WALKING,
            State.WALKING: State.STOPPING,
            State.STOPPING: State.RESTING,
            State.RESTING: State.RESTING,
        }[self.state]
        if after is State.WALKING and hindrance:
            self.reason = hindrance
        elif after is State.STOPPING:
            self._stop(State.RESTING, "chest button", time)
        elif after is not self.state:
            self._enter(after, "chest button", time)

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
