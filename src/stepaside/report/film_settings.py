"""Settings of a film, and the times at which it has images."""

from math import floor
from typing import NamedTuple

SLOWEST = 0.25  # factor of the film's speed at the closest approach
AROUND = 2.0  # time before and after it that is slower, in [s]


class FilmSettings(NamedTuple):
    """Settings of a film.

    Attributes:
        width: Width of an image, in [pixels].
        height: Height of an image, in [pixels].
        rate: Images per second of the film.
        speed: Time of the run per time of the film.
        begin: Time of the run at which the film begins, in [s].
        duration: Time of the run that the film shows, in [s].
        camera: One of :data:`~stepaside.report.film_camera.VIEWS`.
        layers: Whether traces, rings and other lines are drawn.
        slow: Whether the film is slower about the closest approach.
        captions: Whether names, time, distance and state are written.
        title: Title in the upper left corner; empty for none.
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
    captions: bool = True
    title: str = ""

    def speed_at(self, time: float, closest: float | None) -> float:
        """Return the time of the run per time of the film.

        Args:
            time: Time of the run, in [s].
            closest: Time of the closest approach, in [s]; None if there is
                none.
        """
        if closest is None or not self.slow:
            return self.speed
        # A cubic blend, so that the speed has no kinks.
        away = min(1.0, max(0.0, abs(time - closest) / AROUND - 0.5) * 2.0)
        blend = away * away * (3.0 - 2.0 * away)
        return self.speed * (SLOWEST + (1.0 - SLOWEST) * blend)

    def frame_times(
        self, last: float, closest: float | None = None
    ) -> list[float]:
        """Return the times of the run at which the film has images, in [s].

        Args:
            last: End of the run, in [s].
            closest: Time of the closest approach, in [s]; None if there is
                none.
        """
        end = min(last, self.begin + self.duration)
        if closest is not None and self.slow:
            times, time = [], self.begin
            while time <= end + 1e-9:
                times.append(time)
                time += self.speed_at(time, closest) / self.rate
            return times
        step = self.speed / self.rate
        number = floor((end - self.begin) / step + 1e-9) + 1
        return [self.begin + i * step for i in range(max(number, 0))]
