"""Session with a robot: its methods in a thread, its reports, its guardian."""

import logging
import sys
from collections.abc import Callable
from concurrent.futures import Future, wait
from time import monotonic, sleep
from typing import Any

from ..perception.measurement import RobotState
from .dead_man_switch import DeadManSwitch
from .guardian_process import FEEDING, Guardian, halting_method
from .method_thread import (
    BLOCKED,
    CLOSE_TIMEOUT,
    OPEN_TIMEOUT,
    SIMULATOR_TIMEOUT,
    MethodThread,
    SessionLost,
)
from .robot_reports import plain_report

POLL = 0.001  # between two calls of listen() without a new report, in [s]
UNHALTED = 0.5  # for stop() or release() beside a blocked method, in [s]
FORSAKEN = 5.0  # time of a blocked method that ends the session, in [s]
PREPARE_TIMEOUT = 30.0  # for prepare(), in [s]: to stand up
log = logging.getLogger(__name__)


class RobotSession:
    """Connection to a robot.

    Its methods are called in a thread, so that one that does not return does
    not block control. While one of them does not return, the method that
    halts the robot is called beside it. The guardian is informed of every
    command; the robot is safe without it once a halt has returned.

    Attributes:
        robot: The robot.
        halted: Whether the last command was to halt.
    """

    def __init__(
        self,
        robot: Any,
        *,
        opened: bool = False,
        guardian: Guardian | None = None,
        switch: DeadManSwitch | None = None,
        dry_run: bool = False,
        clock: Callable[[], float] = monotonic,
    ) -> None:
        """Connect to the robot, unless it is connected already.

        Guardian and dead-man switch end with the session. In a dry run
        nothing is commanded.

        Raises:
            SessionLost: If the robot does not answer.
            ConfigurationError: If open() fails for another reason.
        """
        self.robot, self._dry_run = robot, dry_run
        self._halting = halting_method(robot)
        self._methods = MethodThread(robot, clock=clock)
        if not opened:
            self._methods.open(
                OPEN_TIMEOUT if robot.paced else SIMULATOR_TIMEOUT
            )
        self._guardian, self._switch, self._clock = guardian, switch, clock
        self.halted = True
        self._reading: Future[Any] | None = None
        self._commanding: Future[Any] | None = None
        self._beside: Future[Any] | None = None
        self._beside_began = 0.0
        self._time: float | None = None  # of the newest report
        self._answers = 0  # of listen() since then

    def name_of(self, method: str) -> str:
        """Return the name of a method for messages."""
        return self._methods.name_of(method)

    def run(self, method: str, within: float) -> None:
        """Call a method, and wait for its return up to a time in [s]."""
        self._methods.run(method, within)

    def listen(self, patience: float) -> RobotState | None:
        """Return the newest report, or None; the last one if repeated."""
        deadline = self._clock() + patience
        report: RobotState | None = None
        while True:
            self._raise_failure()
            if self._reading is None:
                self._reading = self._methods.begin("listen")
            try:
                got = self._reading.result(max(deadline - self._clock(), 0.0))
            except TimeoutError:
                return report
            self._reading = None
            self._answers += 1
            if got is not None:
                report = plain_report(got, self.robot, self.name_of("listen"))
                if report.time != self._time:
                    self._time, self._answers = report.time, 0
                    return report
            if self._clock() >= deadline:
                return report
            sleep(POLL)

    def silence(self, waited: float) -> str:
        """Return why there was no new report for a time, in [s]."""
        blocked = self._methods.blocked
        if blocked is None and self._answers:
            return (
                f"{self.name_of('listen')} returned no new report for "
                f"{waited:.2f} s"
            )
        return self._blocked_text(*(blocked or ("listen", waited)))

    def command(self, call: Callable[[], None]) -> None:
        """Begin a command that moves the robot, without waiting for it.

        It replaces one that has not begun yet.
        """
        if self._dry_run:
            return
        self._raise_failure()
        self.halted = False
        self.attend()
        self._begin("command", call)
        if self._methods.blocked is None:
            self._beside = None

    def halt(self) -> None:
        """Begin to stop or release the robot, without waiting for it."""
        if self._dry_run:
            return
        self._raise_failure()
        self.attend()
        self.halted = True
        self._begin(self._halting)
        blocked = self._methods.blocked
        if blocked is None:
            self._beside = None
        else:
            self._halt_beside(*blocked)

    def attend(self) -> None:
        """Tell the guardian whether the robot is safe without control."""
        if self._guardian is not None:
            safe = self.halted and not self._waits
            (self._guardian.leave if safe else self._guardian.hold)()

    def tell(self, method: str, call: Callable[[], None]) -> "Future[Any]":
        """Begin a method beside the commands; return its result."""
        return self._methods.begin(method, call)

    def released(self) -> str:
        """Return why the dead-man switch hinders the robot, if it does."""
        return "" if self._switch is None else self._switch.released()

    def check_blocked(self) -> None:
        """Check that methods return."""
        if self._methods.blocked is not None:
            raise SessionLost(self._blocked_text(*self._methods.blocked))

    def close(self, *, halts: bool = True) -> None:
        """Halt the robot, by the guardian if need be, and disconnect."""
        if self._switch is not None:
            self._switch.close()
        failure = None
        unsure = self._waits or not self.halted
        if not self._dry_run and (halts or unsure):
            failure = self._last_halt()
        guardian, self._guardian = self._guardian, None
        if guardian is not None and failure is not None:
            log.warning("%s; the guardian halts the robot", failure)
            guardian.release()
        elif guardian is not None:
            guardian.leave()
        if self._methods.blocked is None:
            try:
                self._methods.run("close", self.robot.closing)
            except SessionLost as error:
                log.warning("%s", error)
        self._methods.end()
        if guardian is not None:
            guardian.dismiss()
        elif failure is not None and sys.exc_info()[1] is None:
            raise failure
        elif failure is not None:
            log.warning("%s", failure)  # beside what ended the session

    @property
    def _waits(self) -> bool:
        """Whether the last command, or halt, has not returned yet."""
        last = self._commanding
        return last is not None and not last.done()

    def _last_halt(self) -> SessionLost | None:
        """Halt the robot, and wait for it; return what failed."""
        methods, halting = self._methods, self._halting
        halted, within = self._beside, UNHALTED
        if methods.blocked is None:
            halted, within = self._begin(halting), CLOSE_TIMEOUT
            self._await(halted, BLOCKED)
            if halted.cancel():  # another method does not return
                halted, within = None, UNHALTED
        halted = halted or methods.call_apart(halting)
        self._await(halted, within)
        try:
            halted.result(0.0)
        except SessionLost as error:
            return error
        except TimeoutError:
            return SessionLost(f"{self.name_of(halting)} did not return")
        return None

    def _await(self, halted: "Future[Any]", within: float) -> None:
        """Wait for a last halt; the guardian acts if control dies now."""
        end = monotonic() + within
        while not halted.done() and (left := end - monotonic()) > 0.0:
            if self._guardian is not None:
                self._guardian.hold()
            wait([halted], min(left, FEEDING))

    def _begin(
        self, method: str, call: Callable[[], None] | None = None
    ) -> "Future[Any]":
        """Begin a command, in place of one that has not begun yet."""
        if self._commanding is not None:
            self._commanding.cancel()
        self._commanding = self._methods.begin(method, call)
        return self._commanding

    def _halt_beside(self, method: str, waited: float) -> None:
        """Halt the robot while a method does not return."""
        text = self._blocked_text(method, waited)
        if self._beside is None:
            log.warning("%s", text)
            self._beside = self._methods.call_apart(self._halting)
            self._beside_began = self._clock()
        if self._beside.done():
            self._beside.result()
            if waited > FORSAKEN:
                raise SessionLost(text)
        elif self._clock() - self._beside_began > UNHALTED:
            raise SessionLost(f"{text}, and neither has {self._halting}()")

    def _blocked_text(self, method: str, waited: float) -> str:
        name = self.name_of(method)
        return f"{name} has not returned for {waited:.2f} s"

    def _raise_failure(self) -> None:
        """Raise the failure of the last command, if it has failed."""
        if self._commanding is not None and self._commanding.done():
            self._commanding.result()


def opened_here(robot: Any) -> None:
    """Connect to a robot in this thread, so that this process can fork."""
    try:
        robot.open()
    except OSError as error:
        raise SessionLost(str(error)) from error
