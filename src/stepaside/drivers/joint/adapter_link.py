"""Link to a joint-driven robot that a user connects in Python."""

import logging
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from math import inf, isfinite
from time import sleep
from typing import Any

import numpy as np

from ...core.constants import GRAVITY
from ...core.errors import ConfigurationError
from ...perception.measurement import Sighting
from ..cameras.robot_camera import JointRobotCamera
from ..dead_man_switch import DeadManSwitch
from ..guardian_process import SessionLost
from ..method_thread import (
    CLOSE_TIMEOUT,
    OPEN_TIMEOUT,
    SIMULATOR_TIMEOUT,
    MethodThread,
    open_robot,
)
from .frame_clock import COUNTER_RANGE
from .frames import Codec, FrameError, JointCommand, JointFrame, MotorGains
from .joint_map import MotorTable
from .joint_robot import JointReport, JointRobot, JointTarget
from .report_checks import (
    FOOT_SENSORS,
    converted_joint_report,
    joint_report_fault,
    values_of,
)
from .safety_state_machine import RobotState

POLL = 0.001  # between two calls of listen() without a new report, in [s]
UNRELEASED = 0.5  # for release() while another method is blocked, in [s]
OLDEST = 0.5  # age of a sighting that counts as none, in [s]
log = logging.getLogger(__name__)


class AdapterLink:
    """Frames from listen(), and commands to command(), of a user's robot.

    Its methods are called in a thread, so that one that does not return does
    not block control. Reports count as frames by their times: there is one
    per tick, the first at or after its time.
    """

    def __init__(
        self,
        robot: JointRobot,
        motors: MotorTable,
        own: MotorGains,
        *,
        needs_forces: bool = False,
        switch: DeadManSwitch | None = None,
    ) -> None:
        """Connect to the robot.

        Args:
            robot: The robot, not connected.
            motors: Joints of its description.
            own: Gains that hold a posture.
            needs_forces: Whether control cannot work without foot forces.
            switch: Dead-man switch, if used; closed with the link.

        Raises:
            SessionLost: If the robot does not answer.
            ConfigurationError: If open() fails for another reason.
        """
        self._methods = MethodThread(robot)
        self._robot, self._motors, self._own = robot, motors, own
        self._needs_forces, self._switch = needs_forces, switch
        self._name = self._methods.name_of("listen")
        open_robot(
            self._methods,
            OPEN_TIMEOUT if robot.paced else SIMULATOR_TIMEOUT,
        )
        self._reading: Future[Any] | None = None
        self._commanding: Future[Any] | None = None
        self._reports: list[Any] = []
        self._first: float | None = None
        self._number = -1
        self._seen: Sighting | None = None  # at most OLDEST old
        self._age = 0.0
        self._state = RobotState.LIMP
        self._presses = False
        self._is_released = True
        self._is_refused = False  # the newest report
        self._camera: JointRobotCamera | None = None

    def open_camera(self) -> JointRobotCamera:
        """Return the camera of the robot, which the caller closes.

        Sightings then come from its images: those of the reports are not
        needed, and the robot must stand without images.
        """
        self._camera = JointRobotCamera(self._robot)
        return self._camera

    def wait(self, timeout: float) -> bool:
        """Wait up to ``timeout``, in [s]; return whether a report arrived.

        Raises:
            SessionLost: If a method failed, listen() does not return, or
                nothing new arrives in time.
        """
        clock = self._methods.clock
        deadline, answers = clock() + timeout, 0
        while not self._reports:
            if self._reading is None:
                self._reading = self._methods.begin("listen")
            try:
                got = self._reading.result(max(deadline - clock(), 0.0))
            except TimeoutError:
                if self._is_refused:
                    return False  # and the receiver says why
                raise SessionLost(self._silence(answers, timeout)) from None
            self._reading = None
            answers += 1
            if got is not None:
                self._note(got)
            if not self._reports:
                sleep(POLL)
        return True

    def receive(self) -> list[Any]:
        """Return the reports that have arrived, oldest first."""
        reports, self._reports = self._reports, []
        return reports

    def send(self, data: Any) -> None:
        """Command the joints, or release them; not waiting for the return.

        Args:
            data: Targets by joint; None releases the joints.

        Raises:
            SessionLost: If a method failed, or did not return in time.
        """
        pending = self._commanding
        if pending is not None and pending.done():
            pending.result()  # raises its failure
            pending = None
        blocked = self._methods.blocked
        if blocked is not None:
            raise SessionLost(self._blocked_text(*blocked))
        if data is None:
            if not self._is_released:
                self._is_released = True
                self._commanding = self._methods.begin("release")
        elif pending is None:
            self._is_released = False
            self._commanding = self._methods.begin(
                "command", lambda: self._robot.command(data)
            )

    def close(self) -> None:
        """Release the joints and disconnect."""
        if self._switch is not None:
            self._switch.close()
        methods, free = self._methods, self._methods.blocked is None
        try:
            if not self._is_released:
                self._is_released = True
                if free:
                    methods.run("release", CLOSE_TIMEOUT)
                else:
                    methods.call_apart("release").result(UNRELEASED)
            if free:
                methods.run("close", CLOSE_TIMEOUT)
        except TimeoutError:
            log.warning("%s did not return", methods.name_of("release"))
        except SessionLost as error:
            log.warning("%s", error)

    def newest(self, frame: int, start: int) -> Sighting | None:
        """Return the newest sighting, by the time of control.

        Args:
            frame: Number of the newest sensor frame.
            start: Number of the frame at which time is zero.
        """
        if self._seen is None:
            return None
        time = (frame - start) * self._motors.tick - self._age
        return self._seen._replace(time=time)

    @property
    def codec(self) -> Codec:
        """Conversion between reports or targets and frames."""
        return Codec(self.read, self.write)

    def write(self, command: JointCommand) -> dict[str, JointTarget] | None:
        """Convert a command to targets by joint; None to release them."""
        self._state = command.state
        if command.position is None or command.stiffness is None:
            return None
        if not command.stiffness.any():
            return None
        gains = command.gains or self._own
        rows = zip(
            self._motors.names,
            command.position.tolist(),
            (command.stiffness * gains.stiffness).tolist(),
            (command.stiffness * gains.damping).tolist(),
            strict=True,
        )
        return {name: JointTarget(*values) for name, *values in rows}

    def read(self, data: Any) -> JointFrame:
        """Convert a report to a frame.

        Raises:
            FrameError: If values are implausible.
        """
        number, report = data
        fault = self._fault(report)
        self._is_refused = bool(fault)
        if fault:
            raise FrameError(f"{self._name}: {fault}")
        names, count = self._motors.names, self._motors.count
        forces = np.full(FOOT_SENSORS, np.nan)
        load = inf
        if report.foot_forces is not None:
            forces = np.array(report.foot_forces)
            load = float(forces.sum()) / GRAVITY
        hindrance = report.hindrance
        if self._camera is not None:
            hindrance = hindrance or self._camera.hindrance
        elif self._seen is None:
            hindrance = hindrance or "no sighting of the opponent"
        if self._switch is not None:
            hindrance = self._switch.released() or hindrance
        # There is no button: walking begins when the robot is ready.
        self._presses = self._state is RobotState.READY and not self._presses
        return JointFrame(
            position=values_of(report.positions, names),
            stiffness=np.ones(count),
            current=np.zeros(count),
            temperature=np.zeros(count),
            status=(0,) * count,
            accelerometer=np.array(report.accelerometer),
            gyroscope=np.array(report.gyro),
            angles=report.tilt,
            foot_forces=forces,
            load=load,
            echoes={},
            chest_pressed=self._presses,
            bumper_pressed=False,
            charge=1.0,
            number=float(number % COUNTER_RANGE),
            counted=True,
            lock_step=not self._robot.paced,
            velocity=values_of(report.velocities, names),
            hindrance=hindrance,
        )

    def _silence(self, answers: int, timeout: float) -> str:
        """Return why there is no report after a time, in [s]."""
        blocked = self._methods.blocked
        if blocked is None and answers:
            return f"{self._name} returned no new report for {timeout:.2f} s"
        return self._blocked_text(*(blocked or ("listen", timeout)))

    def _blocked_text(self, method: str, waited: float) -> str:
        name = self._methods.name_of(method)
        return f"{name} has not returned for {waited:.2f} s"

    def _note(self, got: Any) -> None:
        """Store a report if it is the first of its tick.

        Raises:
            SessionLost: If it is no report, or lacks joints.
        """
        report = converted_joint_report(got, self._name, self._motors.names)
        if not isfinite(report.time):
            raise SessionLost(
                f"{self._name}: the time must be finite, got {report.time}"
            )
        if self._first is None:
            self._first = report.time
        number = round((report.time - self._first) / self._motors.tick)
        if number <= self._number:
            if report.time < self._first:
                raise SessionLost(
                    f"{self._name}: the time went back to {report.time:.3f} s"
                )
            return
        self._number = number
        if self._camera is not None:
            self._camera.report_time = report.time
        self._seen = None
        if report.sighting is not None:
            self._age = report.time - report.sighting.time
            if 0.0 <= self._age <= OLDEST:
                self._seen = report.sighting
        self._reports.append((number, report))

    def _fault(self, report: JointReport) -> str:
        """Return why a report cannot be used; empty if it can."""
        if self._needs_forces and report.foot_forces is None:
            return "foot_forces are needed by the paper's walk; use --legs"
        return joint_report_fault(report, self._motors)


def own_gains(
    robot: JointRobot,
    motors: MotorTable,
    described: Mapping[str, tuple[float, float]],
) -> MotorGains:
    """Return the gains that hold a posture.

    Args:
        robot: The robot, whose gains are used.
        motors: Joints of its description.
        described: Gains of the description, where the robot has none.

    Raises:
        ConfigurationError: If a joint has no gains.
    """
    gains = {**described, **(robot.gains or {})}
    missing = [name for name in motors.names if name not in gains]
    if missing:
        raise ConfigurationError(
            f"{type(robot).__name__}: gains lack {', '.join(missing)}"
        )
    pairs = np.array([gains[name] for name in motors.names], dtype=np.float64)
    return MotorGains(pairs[:, 0], pairs[:, 1])


def connect_releaser(make: Callable[[], JointRobot]) -> Callable[[], None]:
    """Connect to a robot in advance, and return a function that releases it.

    Args:
        make: Class of the robot.

    Raises:
        SessionLost: If the robot does not answer.
    """
    robot = make()
    if not robot.keeps_targets or not robot.paced:
        return lambda: None  # it releases itself, or is simulated
    methods = MethodThread(robot)
    open_robot(methods)
    return lambda: methods.run("release", CLOSE_TIMEOUT)
