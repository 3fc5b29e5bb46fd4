"""Settings of a film, and the times at which it has images."""

from dataclasses import dataclass
from math import floor

from ..core.ranges import Range
from ..core.setting import CheckedSettings, setting

VIEWS = ("fixed", "follow", "top")
WHY = "from a frame of a fast film to a night"


@dataclass(frozen=True, slots=True)
class FilmSettings(CheckedSettings):
    """Settings of a film."""

    width: int = setting(
        1280,
        "Image width [pixels]",
        Range(16, 3840, "pixels", "of a screen", whole=True),
        default_text="1280, gif 480",
    )
    height: int = setting(
        720,
        "Image height [pixels]",
        Range(16, 2160, "pixels", "of a screen", whole=True),
        default_text="720, gif 270",
    )
    rate: float = setting(
        30.0,
        "Frame rate of the video",
        Range(1e-6, 1e6, "1/s", WHY),
        default_text="30, gif 10",
    )
    speed: float = setting(
        1.0,
        "Speed of the video {unit}; 2 is twice real time",
        Range(1e-6, 1e6, "1", WHY),
    )
    begin: float = setting(
        0.0,
        "Start of the video in the run",
        Range(0.0, 86400.0, "s", "the longest run"),
    )
    duration: float = setting(
        60.0,
        "Duration of the run in the video",
        Range(1e-6, 86400.0, "s", "the longest run"),
        default_text="60, gif 12",
    )
    camera: str = setting(
        "fixed",
        "View of the video: fixed view of the whole run, following the "
        "robots, or from above",
        names=VIEWS,
    )
    layers: bool = setting(True, "Draw trajectories and plans in the video")
    captions: bool = setting(
        True, "Show players, time and distance in the video"
    )

    def frame_times(self, last: float) -> list[float]:
        """Return the times at which a run of a duration in [s] is shown."""
        end = min(last, self.begin + self.duration)
        step = self.speed / self.rate
        number = floor((end - self.begin) / step + 1e-9) + 1
        return [self.begin + i * step for i in range(max(number, 0))]
