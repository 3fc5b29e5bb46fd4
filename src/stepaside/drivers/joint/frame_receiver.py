"""The newest good frame of a robot, or word that the session is lost."""

import logging
from collections.abc import Callable
from typing import Any

from ..guardian_process import SessionLost
from ..lola.conventions import COUNTER, LOCK_STEP, REAL_TIME
from ..lola.wire import WireError
from .frame_clock import FrameClock, FrameOrderError
from .frames import SensorFrame, unpack_sensors
from .link import FrameLink

PATIENCE = 10.0  # longest wait for the first frame or in lock step, in [s]
log = logging.getLogger(__name__)


class FrameReceiver:
    """Reads frames, drops bad ones, notices silence and lies.

    Attributes:
        count: Number of the newest good frame, from 0.
        refused: Frames that were none.
        lock_step: Whether the robot's world waits for our answers.
    """

    def __init__(
        self,
        link: FrameLink,
        silence: float,
        clock: Callable[[], float],
        read: Callable[[Any], SensorFrame] = unpack_sensors,
    ) -> None:
        """Listen.

        Args:
            link: What carries the frames.
            silence: Time without a good frame after which the session is
                lost, in [s].
            clock: Time of this computer, in [s].
            read: Makes a frame of what the link carries.
        """
        self._read = read
        self._link, self._silence, self._clock = link, silence, clock
        self._frames: FrameClock | None = None
        self._heard = clock()  # when the last good frame came
        self._passed = 0  # frames since then
        self.count = -1
        self.refused = 0
        self.lock_step = False

    def listen(self) -> tuple[SensorFrame, float]:
        """Wait for the next good frame; older ones that queue are skipped.

        Returns:
            The frame, and how long none was read before it, in [s].

        Raises:
            SessionLost: If there is silence, the other side has closed, or
                frames come out of order or from the future.
        """
        patient = self._frames is None or self.lock_step
        limit = PATIENCE if patient else self._silence
        deadline = max(self._heard + limit, self._clock())
        while True:
            ready = self._link.wait(deadline - self._clock())
            received = self._link.receive() if ready else []
            self._passed += len(received)
            now = self._clock()
            frame = self._good(received[-1]) if received else None
            if frame is not None:
                gap, self._heard = now - self._heard, now
                self._number(frame, now)
                return frame, gap
            if now >= deadline:
                refused = f", {self.refused} refused" if self.refused else ""
                raise SessionLost(
                    f"no good frame for {now - self._heard:.3f} s{refused}"
                )

    def _good(self, data: Any) -> SensorFrame | None:
        try:
            return self._read(data)
        except WireError as error:
            self.refused += 1
            if self.refused.bit_count() == 1:  # 1, 2, 4, 8...
                log.warning("frame refused (%d): %s", self.refused, error)
            return None

    def _number(self, frame: SensorFrame, now: float) -> None:
        if self._frames is None:
            body = frame.robot_config[0]
            self.lock_step = body == LOCK_STEP
            self._frames = FrameClock(
                counted=body in (LOCK_STEP, REAL_TIME),
                paced=not self.lock_step,
            )
            self._passed = 1  # what came before the first counts for nothing
        number = frame.battery[COUNTER]
        try:
            self.count = self._frames.note(now, number, self._passed)
        except FrameOrderError as error:
            raise SessionLost(str(error)) from error
        self._passed = 0
