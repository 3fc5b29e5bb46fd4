"""The client's end of the ideal line of sight."""

import logging
from collections import deque
from typing import Protocol

from ...perception.measurement import Sighting
from ..guardian_process import SessionLost
from ..joint.frame_clock import TICK
from ..joint.link import FrameLink
from .sight_message import SightError, SightMessage, unpack_sight

AHEAD = 8  # frames by which a sighting may come before its frame: 0.1 s
log = logging.getLogger(__name__)


class SightSubscription(Protocol):
    """Where a simulated robot tells its ideal line of sight."""

    def newest(self, frame: int, start: int) -> Sighting | None:
        """Newest sighting that belongs to a frame or to one before it.

        Args:
            frame: Number of the newest sensor frame.
            start: Number of the frame at which time is zero.
        """

    def close(self) -> None:
        """Stop listening."""


class SightChannel:
    """Hands over each sighting with the frame that it belongs to."""

    def __init__(self, link: FrameLink) -> None:
        """Listen on a link of messages."""
        self._link: FrameLink | None = link
        self._early: deque[SightMessage] = deque()
        self._newest: SightMessage | None = None
        self._last = -1

    def newest(self, frame: int, start: int) -> Sighting | None:
        """Newest sighting that belongs to a frame or to one before it.

        What comes from the future, out of order or as garbage is dropped,
        and the log says so. A channel that breaks is silent from then on.

        Args:
            frame: Number of the newest sensor frame.
            start: Number of the frame at which time is zero.
        """
        for data in self._receive():
            try:
                message = unpack_sight(data)
            except SightError as error:
                log.warning("sighting dropped: %s", error)
                continue
            if message.frame < self._last or message.frame > frame + AHEAD:
                log.warning(
                    "sighting of frame %d dropped at frame %d",
                    message.frame,
                    frame,
                )
                continue
            self._last = message.frame
            self._early.append(message)
        while self._early and self._early[0].frame <= frame:
            self._newest = self._early.popleft()
        if self._newest is None:
            return None
        seen, age, bearing, distance = self._newest
        return Sighting((seen - start) * TICK - age, bearing, distance)

    def close(self) -> None:
        """Stop listening."""
        if self._link is not None:
            self._link.close()
            self._link = None

    def _receive(self) -> list[bytes]:
        if self._link is None:
            return []
        try:
            return self._link.receive()
        except SessionLost as error:
            log.warning("line of sight lost: %s", error)
            self.close()
            return []
