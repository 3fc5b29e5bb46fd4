"""Settings of a film, and the times at which it has images."""

from dataclasses import dataclass
from math import floor

from ..core.ranges import Range
from ..core.setting import check_settings, setting

SLOWEST = 0.25  # factor of the film's speed at the closest approach
AROUND = 2.0  # time before and after it that is slower, in [s]
VIEWS = ("fixed", "follow", "top")
WHY = "from a frame of a fast film to a night"


@dataclass(frozen=True, slots=True)
class FilmSettings:
    """Settings of a film."""

    width: int = setting(
        1280,
        "Image width [pixels]",
        Range(16, 3840, "pixels", "of a screen", whole=True),
        option="--width",
        default_text="1280, gif 480",
    )
    height: int = setting(
        720,
        "Image height [pixels]",
        Range(16, 2160, "pixels", "of a screen", whole=True),
        option="--height",
        default_text="720, gif 270",
    )
    rate: float = setting(
        30.0,
        "Frame rate of the video",
        Range(1e-6, 1e6, "1/s", WHY),
        option="--rate",
        default_text="30, gif 10",
    )
    speed: float = setting(
        1.0,
        "Speed of the video {unit}; 2 is twice real time",
        Range(1e-6, 1e6, "1", WHY),
        option="--speed",
    )
    begin: float = setting(
        0.0,
        "Start of the video in the run",
        Range(0.0, 86400.0, "s", "the longest run"),
        option="--begin",
    )
    duration: float = setting(
        60.0,
        "Duration of the run in the video",
        Range(1e-6, 86400.0, "s", "the longest run"),
        option="--duration",
        default_text="60, gif 12",
    )
    camera: str = setting(
        "fixed",
        "View of the video: fixed view of the whole run, following the "
        "robots, or from above",
        names=VIEWS,
        option="--camera",
    )
    layers: bool = setting(
        True,
        "Draw trajectories and plans in the video",
        option="--layers/--no-layers",
    )
    slow: bool = setting(
        False,
        "Slow the video down around the closest approach",
        option="--slow-motion/--no-slow-motion",
    )
    captions: bool = setting(
        True,
        "Show players, time and distance in the video",
        option="--captions/--no-captions",
    )
    title: str = setting(
        "", "Title in the upper left corner", option="--title"
    )

    def __post_init__(self) -> None:
        """Validate the settings."""
        check_settings(self)

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
