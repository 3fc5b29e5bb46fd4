"""Summaries of the perception of robots with cameras."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple


@dataclass(frozen=True, slots=True)
class ErrorSpread:
    """Quantiles of absolute errors; None without any.

    Attributes:
        median: Median.
        p95: 95 % quantile.
    """

    median: float | None
    p95: float | None


@dataclass(frozen=True, slots=True)
class SightSummary:
    """Errors and detection rates of one robot.

    Attributes:
        bearing_error_deg: Error of the estimated bearing, in [deg].
        distance_error_m: Error of the estimated distance, in [m].
        detection_rate: Fraction of colour images with the opponent in view
            in which it was detected; None if it never was in view.
        false_detections: Detections that match no object.
        misled_s: Time with a bearing error above 20 deg, in [s].
        lost_s: Time without a sighting of the opponent, in [s].
        depth_detection_rate: As ``detection_rate``, of the depth camera.
    """

    bearing_error_deg: ErrorSpread
    distance_error_m: ErrorSpread
    detection_rate: float | None
    false_detections: int
    misled_s: float
    lost_s: float
    depth_detection_rate: float | None = None


@dataclass(frozen=True, slots=True)
class PerceptionSummary:
    """Detection rates of all robots of a game together.

    Attributes:
        camera: Name of the renderer of the colour images.
        detection_rate: Rate over all cameras; see :class:`SightSummary`.
        false_detections: Sum over all cameras.
        lost_s: Sum over all robots, in [s].
    """

    camera: str
    detection_rate: float | None
    false_detections: int
    lost_s: float


class SightReport(NamedTuple):
    """Evaluation of perception in a game.

    Attributes:
        together: Summary of all robots together.
        by_robot: Summary of each robot with cameras, by name.
    """

    together: PerceptionSummary
    by_robot: Mapping[str, SightSummary]
