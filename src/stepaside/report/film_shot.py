"""How a film is taken: its size, its pace and what it shows."""

from math import floor
from typing import NamedTuple

SLOWEST = 0.25  # pace about the closest approach, of the film's own
AROUND = 2.0  # time before and after it that is slower, in [s]


class FilmSettings(NamedTuple):
    """How a film is taken.

    Attributes:
        width: Of a picture, in [pixels].
        height: Likewise.
        rate: Pictures a second.
        speed: Time of the run per time of the film.
        begin: When it begins, in [s] of the run.
        duration: How much of the run it shows, in [s].
        camera: One of :data:`~stepaside.report.film_camera.VIEWS`.
        layers: Whether lines are drawn in.
        slow: Whether time passes slowly about the closest approach.
        words: Whether it says who is who and what goes on.
        title: Written into the upper left corner; empty for none.
    """

    width: int = 1280
    height: int = 720
    rate: float = 30.0
    speed: float = 1.0
    begin: float = 0.0
    duration: float = 60.0
    camera: str = "fixed"
    layers: bool = True
    slow: bool = False
    words: bool = True
    title: str = ""

    def pace(self, time: float, closest: float | None) -> float:
        """Time of the run per time of the film at a moment.

        Args:
            time: In the run, in [s].
            closest: When the players were closest, in [s].
        """
        if closest is None or not self.slow:
            return self.speed
        # From one to the slowest and back, without a jerk.
        away = min(1.0, max(0.0, abs(time - closest) / AROUND - 0.5) * 2.0)
        share = away * away * (3.0 - 2.0 * away)
        return self.speed * (SLOWEST + (1.0 - SLOWEST) * share)

    def instants(
        self, last: float, closest: float | None = None
    ) -> list[float]:
        """Times of the pictures in the run, in [s].

        Args:
            last: End of the run, in [s].
            closest: When the players were closest, in [s].
        """
        end = min(last, self.begin + self.duration)
        if closest is not None and self.slow:
            times, time = [], self.begin
            while time <= end + 1e-9:
                times.append(time)
                time += self.pace(time, closest) / self.rate
            return times
        step = self.speed / self.rate
        number = floor((end - self.begin) / step + 1e-9) + 1
        return [self.begin + i * step for i in range(max(number, 0))]
