"""Numbering of sensor frames, with checks of their order and rate.

Frames carry no time: one frame is one tick. The clock of this computer
bounds how many frames can have passed. Simulated robots number their
frames, which reveals missing and repeated ones.
"""

from ...core.errors import StepAsideError

COUNTER_RANGE = 1 << 16  # frames are numbered modulo this
LEAD = 0.1  # time by which frames may run ahead of the clock, in [s]
MISSING = 8  # frames that may be missing between two: 0.1 s
DRIFT = 0.02  # relative difference of two clocks' rates at most


class FrameOrderError(StepAsideError, ValueError):
    """Frame that is out of order, or ahead of the clock."""


class FrameClock:
    """Counter of sensor frames.

    Attributes:
        count: Number of the newest frame, from 0; -1 before the first.
    """

    def __init__(
        self, tick: float, *, counted: bool = False, paced: bool = True
    ) -> None:
        """Start before the first frame.

        Args:
            tick: Time from one frame to the next, in [s].
            counted: Whether the frames carry their number.
            paced: Whether the frames come in real time.
        """
        self.count = -1
        self._tick, self._counted, self._paced = tick, counted, paced
        self._lead = 0.0
        self._arrived: float | None = None
        self._number: int | None = None

    def note(self, arrived: float, number: float, passed: int = 1) -> int:
        """Count a frame.

        Args:
            arrived: Time of arrival, in [s].
            number: Number that the frame carries, if frames are counted.
            passed: Frames since the last call, including this one.

        Returns:
            Number of the frame, from 0 for the first.

        Raises:
            FrameOrderError: If frames run ahead of the clock, or their
                numbers are not in order.
        """
        passed = self._check_number(number, passed)
        if self._paced:
            self._check_lead(arrived, passed)
        self.count += passed
        return self.count

    def _check_number(self, number: float, passed: int) -> int:
        """Return the frames passed, by the frames' numbers if counted."""
        if not self._counted:
            return passed
        if not 0 <= number < COUNTER_RANGE or number != int(number):
            raise FrameOrderError(
                "a frame's number must be a whole number in "
                f"[0, {COUNTER_RANGE - 1}], got {number}"
            )
        last = self._number
        if last is not None:
            by_number = (int(number) - last) % COUNTER_RANGE
            if not 0 <= by_number - passed <= MISSING:
                raise FrameOrderError(
                    f"frame {number:.0f} came after frame {last}"
                )
            passed = by_number
        self._number = int(number)
        return passed

    def _check_lead(self, arrived: float, passed: int) -> None:
        """Compare the frames' time with that of the clock."""
        if self._arrived is not None:
            elapsed = arrived - self._arrived
            lead = self._lead + passed * self._tick - (1.0 + DRIFT) * elapsed
            self._lead = max(0.0, lead)
        self._arrived = arrived
        if self._lead > LEAD:
            raise FrameOrderError(
                f"frames are {self._lead:.3f} s ahead of the clock"
            )
