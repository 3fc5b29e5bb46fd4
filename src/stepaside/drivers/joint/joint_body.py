"""Body of a robot that is driven by its joints over a link."""

import logging
from collections.abc import Callable, Mapping
from time import monotonic, sleep
from typing import NamedTuple, Protocol

import numpy as np

from ...core.poses import Array
from ...perception.measurement import Measurement, Sighting
from ..cameras.image_source import ImageSource
from ..guardian_process import SessionLost
from .frame_receiver import FrameReceiver
from .frames import Codec, JointCommand, JointFrame, MotorGains, measurement_of
from .joint_map import JointMap, MotorTable
from .link import FrameLink
from .motion_states import JointMotionState
from .safety_conditions import SafetyInputs, SafetySettings
from .safety_inputs import SafetyMonitor
from .safety_state_machine import RobotState, Safety
from .stiffness_guardian import StiffnessGuardian

log = logging.getLogger(__name__)


class SightSubscription(Protocol):
    """Source of the ideal line of sight of a simulated robot."""

    def newest(self, frame: int, start: int) -> Sighting | None:
        """Return the newest sighting of a frame or an earlier one.

        Args:
            frame: Number of the newest sensor frame.
            start: Number of the frame at which time is zero.
        """

    def close(self) -> None:
        """Disconnect."""


class JointInterface(NamedTuple):
    """Interface of a robot to its joints.

    Attributes:
        link: Link that carries the frames.
        motors: Motors of the robot, in the order of its frames.
        codec: Conversion between frames and what the link carries.
        gains: Gains of the motors while control moves them, from a robot that
            takes gains; None for its own.
        stands: Whether the robot stands by its own controller while it is not
            stiff: stiffness then rises and falls at once.
    """

    link: FrameLink
    motors: MotorTable
    codec: Codec
    gains: MotorGains | None = None
    stands: bool = False


class SystemClock(NamedTuple):
    """Clock of this computer.

    Attributes:
        read: Returns the time, in [s].
        pause: Sleeps for a time, in [s].
    """

    read: Callable[[], float] = monotonic
    pause: Callable[[float], None] = sleep


SYSTEM_CLOCK = SystemClock()


class JointBody:
    """Robot behind the interface read, write, step, close.

    The joint targets of control are followed only in the states that allow
    it; otherwise the joints move slowly to a posture, or are limp. Nothing
    is sent between two calls of :meth:`read`, so that the robot's own
    watchdog acts if control hangs.

    Attributes:
        tick: Time from one frame to the next, in [s].
        frame: Newest valid frame; None before the first.
        sighting: Newest sighting of the ideal line of sight, if any.
    """

    def __init__(
        self,
        interface: JointInterface,
        stance: Mapping[str, float],
        *,
        sight: SightSubscription | None = None,
        eyes: ImageSource | None = None,
        guardian: StiffnessGuardian | None = None,
        safety: SafetySettings | None = None,
        dry_run: bool = False,
        clock: SystemClock = SYSTEM_CLOCK,
    ) -> None:
        """Start a session; the robot is limp.

        Args:
            interface: Interface of the robot; its link is closed with the
                body.
            stance: Posture in which control begins, in [rad], by actuated
                joint, in the order of joint targets.
            sight: Ideal line of sight of a simulated robot, if used.
            eyes: Cameras, if used.
            guardian: Guardian that releases the robot if this process
                fails.
            safety: Limits of safe operation.
            dry_run: Whether to command nothing but lights.
            clock: Clock of this computer.

        Raises:
            ModelError: If the robot has no motor for one of the joints.
        """
        settings = safety or SafetySettings()
        link, motors, codec, gains, stands = interface
        self._gains = gains
        self._link, self._sight, self._guardian = link, sight, guardian
        self._eyes, self._motors = eyes, motors
        self.tick = motors.tick
        self._joints = JointMap(tuple(stance), motors)
        angles = np.array(list(stance.values()), dtype=np.float64)
        self._motion = JointMotionState(
            self._joints,
            angles,
            motors,
            soft=gains is not None,
            at_once=stands,
        )
        self._vitals = SafetyMonitor(settings.look_ahead, motors)
        self._silence = settings.silence
        self._safety = Safety(settings)
        self._hearing = FrameReceiver(
            link, settings.silence, clock.read, codec.read, motors.tick
        )
        self._codec = codec
        self._dry_run = dry_run
        self._clock, self._pause = clock
        self._start = 0
        self._state = RobotState.LIMP
        self.frame: JointFrame | None = None
        self.sighting: Sighting | None = None

    @property
    def state(self) -> RobotState:
        """State of the robot."""
        return self._state

    @property
    def reason(self) -> str:
        """Reason for the state, as a message."""
        return self._safety.reason

    @property
    def refused(self) -> int:
        """Number of invalid frames so far."""
        return self._hearing.refused

    def read(self) -> Measurement:
        """Wait for the robot's next frame and read its sensors.

        Time is zero at the frame with which walking begins.

        Raises:
            SessionLost: If there is no valid frame in time; the robot has
                been commanded to go limp then.
        """
        try:
            frame, gap = self._hearing.listen()
        except SessionLost as error:
            self._lose(str(error))
            raise
        if self._hearing.lock_step and self._guardian is not None:
            self._guardian.dismiss()  # simulated time may stand still
            self._guardian = None
        count = self._hearing.count
        if self.frame is not None and gap > self._silence:
            if not self._hearing.lock_step:
                self._safety.fail(
                    f"no frame was read for {gap:.2f} s", self._time
                )
                self._motion.weaken(
                    float(frame.stiffness[self._motors.legs].max())
                )
        self.frame = frame
        was_walking = self._state.moves_by_control
        self._change(self._safety.frame(self._safety_inputs(frame)))
        if self._state is RobotState.WALKING and not was_walking:
            self._start = count
        if self._sight is not None:
            self.sighting = self._sight.newest(count, self._start)
        time = (count - self._start) * self.tick
        measured = measurement_of(frame, self._joints, time, self.sighting)
        if self._eyes is None:
            return measured
        images = self._eyes.percepts(time)
        return measured._replace(percepts=(*images, *measured.percepts))

    def write(self, joint_targets: Array) -> None:
        """Answer the newest frame.

        Args:
            joint_targets: Joint targets of control, in [rad]; followed only
                in the states that allow it. Shape (joints,).

        Raises:
            SessionLost: If the command cannot be sent.
        """
        if self.frame is None:
            return
        if not np.all(np.isfinite(joint_targets)):
            self.fail("joint targets of control contain NaN or inf")
        targets, stiffness = self._motion.move(
            self._state, self.frame, joint_targets
        )
        if self._guardian is not None:
            self._guardian.update(targets, stiffness)
        is_limp = self._motion.is_limp
        self._send(
            JointCommand(
                None if self._dry_run or is_limp else targets,
                None if self._dry_run else stiffness,
                self._state,
                self.sighting is not None,
                self.frame.charge,
                self._gains if self._state.moves_by_control else None,
            )
        )

    def step(self) -> None:
        """Do nothing: the next read waits for the robot's next frame."""

    def halted(self) -> None:
        """Report that control has stopped the robot."""
        self._safety.halted(self._time)
        self._change(self._safety.state)

    def rest(self, reason: str) -> None:
        """Stop, crouch and go limp."""
        self._safety.rest(reason, self._time)
        self._change(self._safety.state)

    def fail(self, reason: str) -> None:
        """Go limp, for a reason of control."""
        self._safety.fail(reason, self._time)
        self._change(self._safety.state)

    def close(self) -> None:
        """Ramp the stiffness down, in any state, and disconnect."""
        try:
            self._fade()
        finally:
            if self._guardian is not None:
                self._guardian.dismiss()
            for sensor in (self._sight, self._eyes):
                if sensor is not None:
                    sensor.close()
            self._link.close()

    @property
    def _time(self) -> float:
        """Time of the newest frame, in [s], by the count of frames."""
        return self._hearing.count * self.tick

    def _safety_inputs(self, frame: JointFrame) -> SafetyInputs:
        state = self._state
        return self._vitals.update(
            frame,
            self._time,
            walks=state.moves_by_control,
            reached=self._dry_run
            or self._motion.reached(state, frame.position),
        )

    def _change(self, state: RobotState) -> None:
        if state is not self._state:
            log.info("%s: %s", state.value, self._safety.reason)
        self._state = state

    def _send(self, command: JointCommand) -> None:
        try:
            self._link.send(self._codec.write(command))
        except SessionLost as error:
            self._lose(str(error))
            raise

    def _lose(self, reason: str) -> None:
        """Release a robot whose connection has failed."""
        self.fail(reason)
        self._fade()

    def _fade(self) -> None:
        """Ramp the stiffness down, as far as commands can be sent."""
        if self._dry_run or self.frame is None:
            return
        while not self._motion.is_limp:
            targets, stiffness = self._motion.fade()
            if self._guardian is not None:
                self._guardian.update(targets, stiffness)
            try:
                command = JointCommand(
                    targets, stiffness, RobotState.LIMP, False, 0.0
                )
                self._link.send(self._codec.write(command))
            except SessionLost:
                return
            self._pause(self.tick)
