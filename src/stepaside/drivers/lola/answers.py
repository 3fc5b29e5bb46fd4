"""Actuator frames out of a stream of bytes."""

from typing import Any

import msgpack

from .frames import ActuatorFrame, take_actuators
from .wire import LIMITS, LONGEST_ANSWER, WireError


class AnswerReader:
    """Cuts a client's stream into frames.

    Answers have no fixed length: some peers write whole numbers as
    integers. A stream that held anything but answers cannot be read on.
    """

    def __init__(self) -> None:
        """Begin with an empty stream."""
        self._unpacker: Any = msgpack.Unpacker(
            max_buffer_size=16 * LONGEST_ANSWER, **LIMITS
        )
        self._pending = 0

    def feed(self, data: bytes) -> list[ActuatorFrame]:
        """Take bytes, give the frames that they complete.

        Raises:
            WireError: If the stream holds anything else.
        """
        frames = []
        try:
            self._unpacker.feed(data)
            decoded = list(self._unpacker)
        except Exception as error:  # whatever foreign bytes make it raise
            name = type(error).__name__
            raise WireError(f"no answer: {name} {error}".strip()) from error
        for answer in decoded:
            frames.append(take_actuators(answer))
        self._pending = len(data) + (0 if frames else self._pending)
        if self._pending > 2 * LONGEST_ANSWER and not frames:
            raise WireError(
                f"no answer ends within {2 * LONGEST_ANSWER} bytes"
            )
        return frames
