"""The figures of a player at a robot: what it did, as far as it knows."""

from dataclasses import asdict, dataclass
from typing import Any

from .summary_parsing import read_figures


@dataclass(frozen=True, slots=True)
class Change:
    """A change of what a robot does.

    Attributes:
        time_s: When, in [s] since the record began.
        state: What it does from then on.
        reason: Why, in words.
    """

    time_s: float
    state: str
    reason: str


@dataclass(frozen=True, slots=True)
class PlaySummary:
    """Figures of one player, by its own odometry and its own sight.

    Attributes:
        outcome: How it ended.
        message: What ended it, in words.
        role: Who it was.
        language: How the robot was spoken to.
        duration_s: Of the record, in [s].
        walking_s: How long it might walk, in [s].
        steps: Footsteps begun; None where the robot walked by itself.
        way_m: How far it went, in [m], without the sway of a gait cycle.
        radius_m: Of the circle on which it went in the last third of its
            walk, in [m]; None if it hardly turned then.
        distance_m: Mean distance to the other then, in [m]; None if it saw
            nobody.
        closest_m: Least distance at which it saw the other, in [m].
        seen_share: Share of its walk with a sighting to act upon.
        plan_time_us: Median processor time of a plan, in [us].
        changes: What it did when, and why.
        run_folder: Where the run lies, if it was written.
    """

    outcome: str
    message: str
    role: str
    language: str
    duration_s: float
    walking_s: float
    steps: int | None
    way_m: float
    radius_m: float | None
    distance_m: float | None
    closest_m: float | None
    seen_share: float | None
    plan_time_us: float | None
    changes: tuple[Change, ...]
    run_folder: str | None = None

    def to_json(self) -> dict[str, Any]:
        """Plain values by name."""
        plain = asdict(self)
        plain["changes"] = list(plain["changes"])
        if self.run_folder is None:
            del plain["run_folder"]
        return plain

    @classmethod
    def from_json(cls, plain: Any, source: str) -> "PlaySummary":
        """Read what :meth:`to_json` gave.

        Args:
            plain: Plain values by name.
            source: Where they come from, for messages.

        Raises:
            ConfigurationError: If it is no such thing; names what is off.
        """
        return read_figures(cls, plain, source)
