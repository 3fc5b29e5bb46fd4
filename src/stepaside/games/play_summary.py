"""Summary of a player at a robot, by its own odometry and sightings."""

from dataclasses import asdict, dataclass
from typing import Any

from .summary_parsing import parse_summary


@dataclass(frozen=True, slots=True)
class Change:
    """Change of the state of a robot.

    Attributes:
        time_s: Time since the record began, in [s].
        state: New state.
        reason: Reason, as text.
    """

    time_s: float
    state: str
    reason: str


@dataclass(frozen=True, slots=True)
class PlaySummary:
    """Summary of one player, by its own odometry and its own sightings.

    Attributes:
        outcome: How the play ended.
        message: Reason for the end, as text.
        role: "pursuer" or "evader".
        language: Protocol of the robot: "lola", "naoqi" or "ros2".
        duration_s: Duration of the record, in [s].
        walking_s: Time in the walking state, in [s].
        steps: Footsteps begun; None where the robot has its own walk.
        way_m: Length of the path, in [m], without the sway of a gait cycle.
        radius_m: Radius of the circle fitted to the last third of the walk,
            in [m]; None if the path hardly turns there.
        distance_m: Mean distance to the opponent there, in [m]; None
            without a sighting.
        closest_m: Smallest distance of a sighting, in [m].
        seen_share: Fraction of the walking time with a valid sighting.
        plan_time_us: Median processor time of a plan, in [us].
        changes: Changes of state, with time and reason.
        run_folder: Path of the run folder, if one was written.
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
        """Return plain values by name."""
        plain = asdict(self)
        plain["changes"] = list(plain["changes"])
        if self.run_folder is None:
            del plain["run_folder"]
        return plain

    @classmethod
    def from_json(cls, plain: Any, source: str) -> "PlaySummary":
        """Parse the output of :meth:`to_json`.

        Args:
            plain: Plain values by name.
            source: Origin of the values, for messages.

        Raises:
            ConfigurationError: If an entry is missing or of the wrong type;
                names the entry.
        """
        return parse_summary(cls, plain, source)
