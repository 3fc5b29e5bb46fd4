"""The figures of a duel: what is said of it in numbers."""

from dataclasses import asdict, dataclass, field
from typing import Any

from .sight_summary import SEEING, SIGHT, PerceptionSummary, SightSummary, lift
from .summary_parsing import check_object, read_figures


@dataclass(frozen=True, slots=True)
class StartSummary:
    """Where the players stood at first; see ``StartSettings``."""

    distance_m: float | None
    pursuer_offset_rad: float | None
    evader_offset_rad: float | None


@dataclass(frozen=True, slots=True)
class TheorySummary:
    """What theory says of the same game.

    Attributes:
        closest_approach_m: Of a person, or of the pursuer's template, to
            the evader's template, in [m]; None where theory knows none.
        exists: Whether there is a circle that the players can come to.
        radius_m: Radius of the evader's circle, in [m].
        distance_m: Between the players on it, in [m].
        relative_orientation_deg: Between their headings, in [deg].
        pursuer_radius_m: Radius of the pursuer's circle, in [m]; the same
            for equal players.
        expected: What the template says that two robots come to: "circle",
            "later" than the duel lasts, "contact" or "no circle".
        circle_since_s: Since when the template is on its circle, in [s].
        words: The same in words; of other games, why there is no circle.
    """

    closest_approach_m: float | None
    exists: bool
    radius_m: float | None
    distance_m: float | None
    relative_orientation_deg: float | None
    pursuer_radius_m: float | None = None
    expected: str | None = None
    circle_since_s: float | None = None
    words: str | None = None


@dataclass(frozen=True, slots=True)
class PlanTimes:
    """Processor time of a maneuver, in [us]; None if none was planned."""

    median: float | None
    p99: float | None


@dataclass(frozen=True, slots=True)
class PlayerSummary:
    """Figures of one player.

    Attributes:
        radius_m: Of the circle that its place went in the end, in [m].
        sight: How well it saw, if with cameras.
    """

    radius_m: float | None
    sight: SightSummary | None = None


@dataclass(frozen=True, slots=True)
class DuelSummary:
    """Figures of a duel; radii, distance and angle of its last third.

    The place of a player is the point that stands for it in the game: of a
    robot that midway between its feet, of a person the trunk's axis.

    Attributes:
        outcome: How it ended.
        message: What ended it, in words.
        seed: Of every random draw.
        duration_s: Simulated time, in [s].
        start: Where they stood at first.
        triggered_at_s: When the evader began to evade, in [s].
        triggered_at_distance_m: True distance between the places then, in
            [m].
        distance_m: Mean distance between the places, in [m].
        relative_orientation_deg: Mean angle between the headings, in [deg].
        min_distance_m: Least distance between the torsos, in [m].
        captured_at_s: When that distance first was at most the capture
            distance, in [s]; None if it never was. Contact is another
            event: it ends a duel, with ``outcome`` and ``touched``.
        converged_at_s: Since when they are on theory's circle, in [s].
        replans: Maneuvers planned by both.
        max_com_velocity_jump_m_s: Of a CoM reference at a replan, in [m/s].
        min_zmp_margin_m: Least distance of a ZMP reference from the edge of
            its support polygon, in [m]; None if nobody walked.
        theory: What theory says.
        plan_time_us: What planning took.
        real_time_factor: Simulated time over the time that it took.
        pursuer: Figures of the pursuer.
        evader: Figures of the evader.
        sight: Of both as to what they saw, if with cameras.
        touched: Names of who and what met, if that ended it.
        notes: What a reader must know, such as that the configuration does
            not repeat the run.
        run_folder: Where the run lies, if it was written.
    """

    outcome: str
    message: str
    seed: int
    duration_s: float
    start: StartSummary
    triggered_at_s: float | None
    triggered_at_distance_m: float | None
    distance_m: float
    relative_orientation_deg: float
    min_distance_m: float
    converged_at_s: float | None
    replans: int
    max_com_velocity_jump_m_s: float
    min_zmp_margin_m: float | None
    theory: TheorySummary
    plan_time_us: PlanTimes
    real_time_factor: float
    pursuer: PlayerSummary
    evader: PlayerSummary
    sight: PerceptionSummary | None = None
    touched: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    captured_at_s: float | None = None
    run_folder: str | None = None

    def to_json(self) -> dict[str, Any]:
        """Plain values by name, as ``--json`` prints them."""
        plain = asdict(self)
        both = {"pursuer": self.pursuer, "evader": self.evader}
        for name, player in both.items():
            del plain[name]["sight"]
            if player.sight is not None:
                plain[name] |= player.sight.to_json()
        plain |= plain.pop("sight") or {}
        if self.run_folder is None:
            del plain["run_folder"]
        for name in ("touched", "notes"):
            if not plain[name]:
                del plain[name]
        return plain

    @classmethod
    def from_json(cls, plain: Any, source: str) -> "DuelSummary":
        """Read what :meth:`to_json` gave.

        Args:
            plain: Plain values by name.
            source: Where they come from, for messages.

        Raises:
            ConfigurationError: If it is no such thing; names what is off.
        """
        entries = lift(check_object(plain, source), SEEING)
        for name in ("pursuer", "evader"):
            if isinstance(entries.get(name), dict):
                entries[name] = lift(entries[name], SIGHT)
        return read_figures(cls, entries, source)
