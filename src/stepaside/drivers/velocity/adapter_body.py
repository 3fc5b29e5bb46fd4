"""Driver for a robot that a user connects in Python."""

import logging
from collections.abc import Callable
from concurrent.futures import Future
from math import nan
from time import monotonic, sleep
from typing import Any

from ...core.poses import Pose
from ...core.user_file import FAILURES, shown_briefly
from ...perception.measurement import Sighting
from ..guardian_process import SessionLost
from ..method_thread import (
    CLOSE_TIMEOUT,
    MethodThread,
    open_robot,
)
from .velocity_body import REST, VelocityCommand, VelocityReport
from .velocity_robot import VelocityRobot

PERIOD = 0.02  # between two reports at least, in [s]
POLL = 0.005  # between two calls of listen() that returned None, in [s]
PREPARE_TIMEOUT = 30.0  # for prepare(), in [s]: to stand up
UNSTOPPED = 0.5  # for stop() while another method is blocked, in [s]
FORSAKEN = 5.0  # time of a blocked method that ends the session, in [s]
log = logging.getLogger(__name__)


class AdapterBody:
    """Robot behind a user's :class:`VelocityRobot`.

    Its methods are called in a thread. While one of them does not return,
    stop() is called beside it, as soon as zero velocity is commanded.
    """

    def __init__(
        self,
        robot: VelocityRobot,
        *,
        dry_run: bool = False,
        clock: Callable[[], float] = monotonic,
    ) -> None:
        """Connect to the robot, and make it ready to walk.

        Args:
            robot: The robot, not connected.
            dry_run: Whether nothing is commanded.
            clock: Time of this computer, in [s].

        Raises:
            SessionLost: If the robot does not answer.
            ConfigurationError: If open() fails for another reason.
        """
        self._methods = MethodThread(robot, clock=clock)
        self._dry_run, self._clock = dry_run, clock
        open_robot(self._methods)
        if not dry_run:
            try:
                self._methods.run("prepare", PREPARE_TIMEOUT)
            except SessionLost:
                self._close_robot()
                raise
        self._reading: Future[Any] | None = None
        self._commanding: Future[Any] | None = None
        self._looking: Future[Any] | None = None
        self._stopping: Future[Any] | None = None
        self._stop_began = 0.0
        self._wanted = REST
        self._time = nan  # of the last report
        self._due = clock()

    def listen(self, patience: float) -> VelocityReport | None:
        """Return the newest report, or None; the last one if it is repeated.

        Args:
            patience: Longest time to wait for a report, in [s].

        Raises:
            SessionLost: If a method failed or does not return, or a report
                is invalid.
        """
        deadline = self._clock() + patience
        sleep(min(max(self._due - self._clock(), 0.0), patience))
        report: VelocityReport | None = None
        while True:
            self._raise_failure()
            if self._reading is None:
                self._reading = self._methods.begin("listen")
            try:
                got = self._reading.result(max(deadline - self._clock(), 0.0))
            except TimeoutError:
                return report
            self._reading = None
            if got is not None:
                report = converted_report(got, self._methods.name_of("listen"))
                if report.time != self._time:
                    self._time = report.time
                    self._due = self._clock() + PERIOD
                    return report
            if self._clock() >= deadline:
                return report
            sleep(POLL)

    def command(self, velocity: VelocityCommand) -> None:
        """Send a velocity command, without waiting for its return.

        Raises:
            SessionLost: If a method failed, or did not return in time.
        """
        if self._dry_run:
            return
        self._raise_failure()
        self._wanted = velocity
        if self._commanding is None or self._commanding.done():
            method = "stop" if velocity == REST else "command"
            self._commanding = self._methods.begin(method, self._command)
        blocked = self._methods.blocked
        if blocked is None:
            self._stopping = None
        elif velocity == REST:
            self._stop_beside(*blocked)

    def look(self, yaw: float, pitch: float) -> None:
        """Turn the head, without waiting for the return.

        Args:
            yaw: Direction from the heading, in [rad], positive leftward.
            pitch: Angle below the horizontal, in [rad].

        Raises:
            SessionLost: If the last call failed.
        """
        if self._dry_run:
            return
        if self._looking is not None:
            if not self._looking.done():
                return
            self._looking.result()
        robot = self._methods.robot
        self._looking = self._methods.begin(
            "look", lambda: robot.look(yaw, pitch)
        )

    def close(self) -> None:
        """Stop the robot and disconnect.

        Raises:
            SessionLost: If stop() failed or did not return.
        """
        failure: SessionLost | None = None
        if not self._dry_run:
            free = self._methods.blocked is None
            stopping = (
                self._methods.begin("stop")
                if free
                else self._stopping or self._methods.call_apart("stop")
            )
            try:
                stopping.result(CLOSE_TIMEOUT if free else UNSTOPPED)
            except SessionLost as error:
                failure = error
            except TimeoutError:
                failure = SessionLost(
                    f"{self._methods.name_of('stop')} did not return"
                )
        self._close_robot()
        if failure is not None:
            raise failure

    def _close_robot(self) -> None:
        """Call close(), and log its failure."""
        if self._methods.blocked is not None:
            return
        try:
            self._methods.run("close", CLOSE_TIMEOUT)
        except SessionLost as error:
            log.warning("%s", error)

    def _command(self) -> None:
        """Command the newest velocity; called by the thread."""
        robot, (forward, turn, lateral) = self._methods.robot, self._wanted
        if self._wanted == REST:
            robot.stop()
        else:
            robot.command(forward, lateral, turn)

    def _stop_beside(self, method: str, waited: float) -> None:
        """Stop the robot while a method does not return."""
        name = self._methods.name_of(method)
        if self._stopping is None:
            log.warning("%s has not returned for %.2f s", name, waited)
            self._stopping = self._methods.call_apart("stop")
            self._stop_began = self._clock()
        if self._stopping.done():
            self._stopping.result()
            if waited > FORSAKEN:
                raise SessionLost(
                    f"{name} has not returned for {waited:.1f} s"
                )
        elif self._clock() - self._stop_began > UNSTOPPED:
            raise SessionLost(
                f"{name} has not returned for {waited:.1f} s, and neither "
                "has stop()"
            )

    def _raise_failure(self) -> None:
        """Raise the failure of the last command, if it has failed."""
        if self._commanding is not None and self._commanding.done():
            self._commanding.result()


def connect_adapter_stopper(
    make: type[VelocityRobot],
) -> Callable[[], None]:
    """Connect to a robot in advance, and return a function that stops it.

    Args:
        make: Class of the robot.

    Raises:
        SessionLost: If the robot does not answer.
    """
    robot = make()
    if not robot.keeps_walking:
        return lambda: None  # it stops by itself
    methods = MethodThread(robot)
    open_robot(methods)
    return lambda: methods.run("stop", CLOSE_TIMEOUT)


def converted_report(got: Any, name: str) -> VelocityReport:
    """Return a report of plain numbers.

    Args:
        got: Result of listen().
        name: Name of the method, for messages.

    Raises:
        SessionLost: If it is no report.
    """
    try:
        time, pose, sighting, hindrance = got
        if sighting is not None:
            sighting = Sighting(*sighting)
            when, bearing, distance = (float(v) for v in sighting[:3])
            sighting = sighting._replace(
                time=when, bearing=bearing, distance=distance
            )
        x, y, theta = (float(value) for value in pose)
        return VelocityReport(
            float(time), Pose(x, y, theta), sighting, str(hindrance)
        )
    except FAILURES as error:
        raise SessionLost(
            f"{name} must return a VelocityReport(time, Pose(x, y, theta)) "
            f"or None, got {shown_briefly(got)}"
        ) from error
