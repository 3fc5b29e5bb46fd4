"""The figures of what robots with cameras saw."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from typing import Any, NamedTuple


@dataclass(frozen=True, slots=True)
class ErrorSpread:
    """Sizes of errors; None where there are none.

    Attributes:
        median: Half of them are smaller.
        p95: So are 95 % of them.
    """

    median: float | None
    p95: float | None


@dataclass(frozen=True, slots=True)
class SightSummary:
    """How well one robot saw.

    Attributes:
        bearing_error_deg: Of the believed bearing, in [deg].
        distance_error_m: Of the believed distance, in [m].
        detection_rate: Share of its colour images with the other in view
            that found it; None if there were none.
        false_detections: Detections of what is not there.
        misled_s: How long its bearing was off by more than 20 deg, in [s].
        lost_s: How long it did not know where the other is, in [s].
        depth_detection_rate: As ``detection_rate``, of the depth camera;
            None if the other was never in its view.
    """

    bearing_error_deg: ErrorSpread
    distance_error_m: ErrorSpread
    detection_rate: float | None
    false_detections: int
    misled_s: float
    lost_s: float
    depth_detection_rate: float | None = None

    def to_json(self) -> dict[str, Any]:
        """Plain values by name; without what no camera could tell."""
        plain = asdict(self)
        if self.depth_detection_rate is None:
            del plain["depth_detection_rate"]
        return plain


@dataclass(frozen=True, slots=True)
class PerceptionSummary:
    """How well all robots of a game saw.

    Attributes:
        camera: What drew the colour images.
        detection_rate: Of all cameras; see :class:`SightSummary`.
        false_detections: Likewise.
        lost_s: Of all robots, added, in [s].
    """

    camera: str
    detection_rate: float | None
    false_detections: int
    lost_s: float


class SightReport(NamedTuple):
    """Figures of what was seen in a game.

    Attributes:
        all: Of all robots together.
        each: Of each that has cameras, by name.
    """

    all: PerceptionSummary
    each: Mapping[str, SightSummary]


SEEING = frozenset(field.name for field in fields(PerceptionSummary))
SIGHT = frozenset(field.name for field in fields(SightSummary))


def lift(plain: dict[str, Any], names: frozenset[str]) -> dict[str, Any]:
    """Put figures of sight that lie among others under ``sight``.

    Args:
        plain: Plain values by name.
        names: Of the figures of sight.
    """
    seen = {key: value for key, value in plain.items() if key in names}
    rest = {key: value for key, value in plain.items() if key not in names}
    return rest | {"sight": seen or None}
