"""Client of the ideal line of sight of a simulated robot."""

import logging
from collections import deque

from ...perception.measurement import Sighting
from ..guardian_process import SessionLost
from ..joint.link import FrameLink
from .nao_joints import TICK
from .sight_message import SightError, SightMessage, unpack_sight

AHEAD = 8  # frames by which a sighting may come before its frame: 0.1 s
log = logging.getLogger(__name__)


class SightChannel:
    """Reader that returns each sighting with its sensor frame."""

    def __init__(self, link: FrameLink) -> None:
        """Read from a link of messages."""
        self._link: FrameLink | None = link
        self._early: deque[SightMessage] = deque()
        self._newest: SightMessage | None = None
        self._last = -1

    def newest(self, frame: int, start: int) -> Sighting | None:
        """Return the newest sighting of a frame or an earlier one.

        Invalid messages, and those of later frames or out of order, are
        dropped with a warning. After a broken connection no new sighting is
        returned.

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
        number, age, bearing, distance = self._newest
        return Sighting((number - start) * TICK - age, bearing, distance)

    def close(self) -> None:
        """Disconnect."""
        if self._link is not None:
            self._link.close()
            self._link = None

    def _receive(self) -> list[bytes]:
        if self._link is None:
            return []
        try:
            return self._link.receive()
        except SessionLost as error:
            log.warning("ideal line of sight disconnected: %s", error)
            self.close()
            return []
