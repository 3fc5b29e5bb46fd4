"""A robot that speaks LoLA, behind the interface that control moves."""

import logging
from collections.abc import Callable, Sequence
from time import monotonic, sleep

import numpy as np

from ...core.poses import Array
from ...perception.measurement import Measurement, Sighting
from ..cameras.image_source import ImageSource
from ..guardian_process import SessionLost
from ..lola.conventions import measurement_of
from ..lola.lights import lights_for
from ..lola.sight_channel import SightSubscription
from .frame_clock import TICK
from .frame_receiver import FrameReceiver
from .frames import ON_THE_WIRE, ActuatorFrame, Codec, SensorFrame
from .joint_map import LEGS, JointMap
from .link import FrameLink
from .motion_states import JointMotionState
from .safety import RobotState, Safety
from .safety_conditions import SafetyInputs, SafetySettings
from .stiffness_guardian import StiffnessGuardian
from .vitals import Vitals

log = logging.getLogger(__name__)


class JointBody:
    """One robot at the other end of a LoLA session.

    Joint targets of control reach the joints only while the state says so;
    otherwise the body moves by itself, slowly, or not at all. Between two
    calls of :meth:`read` nothing is sent: a control that hangs lets the
    robot's own watchdog act.

    Attributes:
        tick: Time from one frame to the next, in [s].
        frame: Newest good frame; None before the first.
        sighting: Newest sighting that came with it, if any did.
    """

    tick = TICK

    def __init__(
        self,
        link: FrameLink,
        joint_names: Sequence[str],
        stance: Array,
        *,
        sight: SightSubscription | None = None,
        eyes: ImageSource | None = None,
        guardian: StiffnessGuardian | None = None,
        safety: SafetySettings | None = None,
        dry_run: bool = False,
        codec: Codec = ON_THE_WIRE,
        clock: Callable[[], float] = monotonic,
        pause: Callable[[float], None] = sleep,
    ) -> None:
        """Take over a session.

        Args:
            link: What carries its frames; closed with the body.
            joint_names: Actuated joints, in the order of joint targets.
            stance: Posture in which control begins, in [rad].
                Shape (joints,).
            sight: Ideal line of sight, where a simulated robot offers one.
            eyes: Its cameras, if it is played with those.
            guardian: Who lets go of the robot if this process cannot.
            safety: Limits of what is safe.
            dry_run: Command nothing but lights.
            codec: Between frames and what the link carries.
            clock: Time of this computer, in [s].
            pause: Lets time pass, in [s].

        Raises:
            ModelError: If LoLA has no motor for one of the joints.
        """
        settings = safety or SafetySettings()
        self._link, self._sight, self._guardian = link, sight, guardian
        self._eyes = eyes
        self._joints = JointMap(joint_names)
        self._motion = JointMotionState(self._joints, stance)
        self._vitals = Vitals(settings.look_ahead)
        self._silence = settings.silence
        self._safety = Safety(settings)
        self._hearing = FrameReceiver(
            link, settings.silence, clock, codec.read
        )
        self._codec = codec
        self._dry_run = dry_run
        self._clock, self._pause = clock, pause
        self._start = 0
        self._state = RobotState.LIMP
        self.frame: SensorFrame | None = None
        self.sighting: Sighting | None = None

    @property
    def state(self) -> RobotState:
        """What the robot is doing."""
        return self._state

    @property
    def reason(self) -> str:
        """Why it does that, in words."""
        return self._safety.reason

    @property
    def refused(self) -> int:
        """Frames that were none, so far."""
        return self._hearing.refused

    def read(self) -> Measurement:
        """Wait for the robot's next frame and read its sensors.

        Time is zero at the frame with which walking begins.

        Raises:
            SessionLost: If there is none in time, or none that can be true;
                the robot has been told to let go then.
        """
        try:
            frame, gap = self._hearing.listen()
        except SessionLost as error:
            self._lose(str(error))
            raise
        if self._hearing.lock_step and self._guardian is not None:
            self._guardian.dismiss()  # time may stand still in such a world
            self._guardian = None
        count = self._hearing.count
        if self.frame is not None and gap > self._silence:
            if not self._hearing.lock_step:
                self._safety.fail(
                    f"no frame was read for {gap:.2f} s", self._time
                )
                self._motion.weaken(float(frame.stiffness[LEGS].max()))
        self.frame = frame
        walked = self._state.moves_by_control
        self._change(self._safety.frame(self._seen(frame)))
        if self._state is RobotState.WALKING and not walked:
            self._start = count
        if self._sight is not None:
            self.sighting = self._sight.newest(count, self._start)
        time = (count - self._start) * TICK
        measured = measurement_of(frame, self._joints, time, self.sighting)
        if self._eyes is None:
            return measured
        images = self._eyes.percepts(count, time, TICK)
        return measured._replace(percepts=(*images, *measured.percepts))

    def write(self, joint_targets: Array) -> None:
        """Answer the frame that was read last.

        Args:
            joint_targets: What control wants, in [rad]; followed only while
                the state lets it. Shape (joints,).

        Raises:
            SessionLost: If the robot takes no frame.
        """
        if self.frame is None:
            return
        if not np.all(np.isfinite(joint_targets)):
            self.fail("control asked for what is no number")
        targets, stiffness = self._motion.move(
            self._state, self.frame, joint_targets
        )
        lights = lights_for(
            self._state,
            sees=self.sighting is not None,
            charge=self.frame.battery[0],
        )
        if self._guardian is not None:
            self._guardian.tell(targets, stiffness)
        if self._dry_run:
            self._send(ActuatorFrame(lights=lights))
        elif self._motion.is_limp:
            self._send(ActuatorFrame(None, stiffness, lights))
        else:
            self._send(ActuatorFrame(targets, stiffness, lights))

    def step(self) -> None:
        """Do nothing: the next read waits for the robot's next frame."""

    def halted(self) -> None:
        """Note that control has brought a robot that stops to rest."""
        self._safety.halted(self._time)
        self._change(self._safety.state)

    def rest(self, reason: str) -> None:
        """Stop and rest."""
        self._safety.rest(reason, self._time)
        self._change(self._safety.state)

    def fail(self, reason: str) -> None:
        """Go limp, for a reason that control knows."""
        self._safety.fail(reason, self._time)
        self._change(self._safety.state)

    def close(self) -> None:
        """Let the stiffness fade, whatever the robot was doing, and go."""
        try:
            self._fade()
        finally:
            if self._guardian is not None:
                self._guardian.dismiss()
            for beside in (self._sight, self._eyes):
                if beside is not None:
                    beside.close()
            self._link.close()

    @property
    def _time(self) -> float:
        """When the newest frame was, in [s]: some worlds wait for us."""
        return self._hearing.count * TICK

    def _seen(self, frame: SensorFrame) -> SafetyInputs:
        state = self._state
        return self._vitals.seen(
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

    def _send(self, frame: ActuatorFrame) -> None:
        try:
            self._link.send(self._codec.write(frame))
        except SessionLost as error:
            self._lose(str(error))
            raise

    def _lose(self, reason: str) -> None:
        """Let go of a robot that cannot be trusted or heard."""
        self.fail(reason)
        self._fade()

    def _fade(self) -> None:
        """Send falling stiffness, as far as it can be sent."""
        if self._dry_run or self.frame is None:
            return
        while not self._motion.is_limp:
            targets, stiffness = self._motion.fade()
            if self._guardian is not None:
                self._guardian.tell(targets, stiffness)
            lights = lights_for(RobotState.LIMP, sees=False, charge=0.0)
            try:
                told = ActuatorFrame(targets, stiffness, lights)
                self._link.send(self._codec.write(told))
            except SessionLost:
                return
            self._pause(TICK)
