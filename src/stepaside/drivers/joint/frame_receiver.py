"""Receiver of sensor frames, which detects silence and invalid frames."""

import logging
from collections.abc import Callable
from typing import Any

from ..guardian_process import SessionLost
from .frame_clock import FrameClock, FrameOrderError
from .frames import FrameError, JointFrame
from .link import FrameLink

PATIENCE = 10.0  # longest wait for the first frame or in lock step, in [s]
log = logging.getLogger(__name__)


class FrameReceiver:
    """Receiver of the newest valid sensor frame.

    Attributes:
        count: Number of the newest valid frame, from 0.
        refused: Number of invalid frames.
        lock_step: Whether the robot is simulated and waits for answers.
    """

    def __init__(
        self,
        link: FrameLink,
        silence: float,
        clock: Callable[[], float],
        read: Callable[[Any], JointFrame],
        tick: float,
    ) -> None:
        """Start before the first frame.

        Args:
            link: Link that carries the frames.
            silence: Time without a valid frame after which the session is
                lost, in [s].
            clock: Time of this computer, in [s].
            read: Function that decodes what the link carries.
            tick: Time from one frame to the next, in [s].
        """
        self._read, self._tick = read, tick
        self._link, self._silence, self._clock = link, silence, clock
        self._frames: FrameClock | None = None
        self._heard = clock()  # time of the last valid frame
        self._passed = 0  # frames since then
        self.count = -1
        self.refused = 0
        self._refusal = ""
        self.lock_step = False

    def listen(self) -> tuple[JointFrame, float]:
        """Wait for the newest valid frame; older queued ones are skipped.

        Returns:
            The frame, and the time since the previous one, in [s].

        Raises:
            SessionLost: After silence, at the end of the connection, or if
                frames are out of order or ahead of the clock.
        """
        patient = self._frames is None or self.lock_step
        limit = PATIENCE if patient else self._silence
        deadline = max(self._heard + limit, self._clock())
        while True:
            ready = self._link.wait(deadline - self._clock())
            received = self._link.receive() if ready else []
            self._passed += len(received)
            now = self._clock()
            frame = self._decoded(received[-1]) if received else None
            if frame is not None:
                gap, self._heard = now - self._heard, now
                self._number(frame, now)
                return frame, gap
            if now >= deadline:
                refused = ""
                if self.refused:
                    refused = f", {self.refused} refused: {self._refusal}"
                raise SessionLost(
                    f"no valid frame for {now - self._heard:.3f} s{refused}"
                )

    def _decoded(self, data: Any) -> JointFrame | None:
        try:
            return self._read(data)
        except FrameError as error:
            self.refused += 1
            self._refusal = str(error)
            if self.refused.bit_count() == 1:  # 1, 2, 4, 8...
                log.warning("frame refused (%d): %s", self.refused, error)
            return None

    def _number(self, frame: JointFrame, now: float) -> None:
        if self._frames is None:
            self.lock_step = frame.lock_step
            self._frames = FrameClock(
                self._tick,
                counted=frame.counted,
                paced=not self.lock_step,
            )
            self._passed = 1  # frames before the first valid one don't count
        try:
            self.count = self._frames.note(now, frame.number, self._passed)
        except FrameOrderError as error:
            raise SessionLost(str(error)) from error
        self._passed = 0
