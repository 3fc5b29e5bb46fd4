"""Which tick a frame belongs to, and whether it can be true.

LoLA's frames carry no time. Their number is their time, 12 ms each; the
clock of this computer says whether so many can have passed. Simulated
robots count their frames in a battery value, which shows frames that are
missing or come twice.
"""

from ...core.errors import StepAsideError
from ..lola.conventions import COUNTER_RANGE

TICK = 0.012  # from one frame to the next, in [s]
LEAD = 0.1  # how far frames may run ahead of the clock, in [s]
MISSING = 8  # frames that may be missing between two: 0.1 s
DRIFT = 0.02  # by which two clocks may differ, relatively


class FrameOrderError(StepAsideError, ValueError):
    """A frame that comes from the future, or out of order."""


class FrameClock:
    """Counts frames.

    Attributes:
        count: Number of the newest frame, from 0; -1 before the first.
    """

    def __init__(self, *, counted: bool = False, paced: bool = True) -> None:
        """Begin before the first frame.

        Args:
            counted: Whether the frames carry their own number.
            paced: Whether they come in real time.
        """
        self.count = -1
        self._counted, self._paced = counted, paced
        self._lead = 0.0
        self._arrived: float | None = None
        self._number: int | None = None

    def note(self, arrived: float, number: float, passed: int = 1) -> int:
        """Number a frame.

        Args:
            arrived: When it came, in [s].
            number: Where simulated robots count their frames.
            passed: Frames that came since the last one, this included.

        Returns:
            Its number, from 0 for the first.

        Raises:
            FrameOrderError: If frames run ahead of the clock or their
                numbers do not follow each other.
        """
        passed = self._check_number(number, passed)
        if self._paced:
            self._check_lead(arrived, passed)
        self.count += passed
        return self.count

    def _check_number(self, number: float, passed: int) -> int:
        """Frames that have passed by their own count, if they have one."""
        if not self._counted:
            return passed
        if not 0 <= number < COUNTER_RANGE or number != int(number):
            raise FrameOrderError(f"frame number {number} is none")
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
            gone = arrived - self._arrived
            lead = self._lead + passed * TICK - (1.0 + DRIFT) * gone
            self._lead = max(0.0, lead)
        self._arrived = arrived
        if self._lead > LEAD:
            raise FrameOrderError(
                f"frames are {self._lead:.3f} s ahead of the clock"
            )
