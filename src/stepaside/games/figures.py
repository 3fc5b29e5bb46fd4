"""The figures of a duel: what is said of it in numbers."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

import dacite

from ..errors import ConfigurationError
from .configuration import HOOKS


@dataclass(frozen=True, slots=True)
class StartFigures:
    """Where the players stood at first; see ``StartSettings``."""

    distance_m: float | None
    pursuer_offset_rad: float | None
    evader_offset_rad: float | None


@dataclass(frozen=True, slots=True)
class TheoryFigures:
    """What theory says of the same game.

    Attributes:
        closest_approach_m: Of a person to the evader's template, in [m];
            None if two robots play.
        exists: Whether there is a circle.
        radius_m: Its radius, in [m].
        distance_m: Between the players on it, in [m].
        relative_orientation_deg: Between their headings, in [deg].
    """

    closest_approach_m: float | None
    exists: bool
    radius_m: float | None
    distance_m: float | None
    relative_orientation_deg: float | None


@dataclass(frozen=True, slots=True)
class PlanTimes:
    """Processor time of a maneuver, in [us]; None if none was planned."""

    median: float | None
    p99: float | None


@dataclass(frozen=True, slots=True)
class PlayerFigures:
    """Figures of one player.

    Attributes:
        radius_m: Of the circle that its place went in the end, in [m].
        sight: How well it saw, if with cameras.
    """

    radius_m: float | None
    sight: Mapping[str, Any] = field(default_factory=dict)


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
        run_folder: Where the run lies, if it was written.
    """

    outcome: str
    message: str
    seed: int
    duration_s: float
    start: StartFigures
    triggered_at_s: float | None
    triggered_at_distance_m: float | None
    distance_m: float
    relative_orientation_deg: float
    min_distance_m: float
    converged_at_s: float | None
    replans: int
    max_com_velocity_jump_m_s: float
    min_zmp_margin_m: float | None
    theory: TheoryFigures
    plan_time_us: PlanTimes
    real_time_factor: float
    pursuer: PlayerFigures
    evader: PlayerFigures
    sight: Mapping[str, Any] = field(default_factory=dict)
    run_folder: str | None = None

    def to_json(self) -> dict[str, Any]:
        """Plain values by name, as ``--json`` prints them."""
        plain = asdict(self)
        for name in ("pursuer", "evader"):
            plain[name] |= plain[name].pop("sight")
        plain |= plain.pop("sight")
        if self.run_folder is None:
            del plain["run_folder"]
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
        if not isinstance(plain, dict):
            raise ConfigurationError(
                f"{source} must hold one JSON object, got "
                f"{type(plain).__name__}"
            )
        known = set(cls.__dataclass_fields__)
        plain = {k: v for k, v in plain.items() if k != "format"}
        entries = {k: v for k, v in plain.items() if k in known}
        entries["sight"] = {k: v for k, v in plain.items() if k not in known}
        for name in ("pursuer", "evader"):
            each = entries.get(name)
            if isinstance(each, dict):
                seen = {k: v for k, v in each.items() if k != "radius_m"}
                entries[name] = {
                    "radius_m": each.get("radius_m"),
                    "sight": seen,
                }
        config = dacite.Config(type_hooks=HOOKS)
        try:
            return dacite.from_dict(cls, entries, config)
        except (dacite.DaciteError, TypeError, AttributeError) as error:
            raise ConfigurationError(f"{source}: {error}") from error
