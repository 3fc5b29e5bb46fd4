"""Encounters with approaching people."""

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from hashlib import sha256
from math import radians

from ..core.poses import wrap_angle
from ..games.configuration_file import settings_entries
from ..games.duel import run_duel, run_duels
from ..games.duel_settings import DuelSettings, StartSettings
from ..games.outcome import Outcome
from ..games.robot_settings import with_legs
from ..games.run import DuelRun
from ..games.walk_settings import WalkSettings
from ..locomotion.policy.legs_settings import LegsSettings
from ..sim.person_settings import PersonSettings
from ..strategies import DashEvasion, Evasion
from .records import Record

SPEEDS = (0.3, 0.6, 1.0, 1.4)  # of people, in [m/s]
BEARINGS = (0, 45, -90, 135, 180)  # from which they approach, in [deg]
SPEEDS_ON_LEGS = (0.5, 1.0, 1.4, 1.8)  # likewise, of robots on learned legs
OFFSETS_ON_LEGS = (0.0, 1.2)
BEARINGS_ON_LEGS = tuple(range(0, 360, 30))
OFFSETS = (0.0, 0.3, -0.3, 1.2)  # lateral, of their path, in [m]
NO_LEGS = LegsSettings()
PASSING = 1.0  # least offset of people who only pass, in [m]
STANDING = 1.5  # time before a person can trigger evasion, in [s]
WALL_CLEARANCE = 4.0  # from the person to the walls with cameras, in [m]
PAST = 2.5  # distance that they walk on behind the robot, in [m]
FIELDS = (  # of every record
    "outcome",
    "duration_s",
    "triggered_at_s",
    "triggered_at_distance_m",
    "closest_m",
    "theory_closest_m",
)


@dataclass(frozen=True, slots=True)
class Encounter:
    """Encounter with one approaching person.

    Attributes:
        speed: Speed of the person, in [m/s].
        bearing: Bearing of the person at first in the frame of the robot,
            in [deg].
        offset: Lateral offset of the path from the robot, to its left, in
            [m].
        sensing: Sensing of the robot, as in :class:`DuelSettings`.
        seed: Seed of the game.
        base: All other settings of the game.
    """

    speed: float
    bearing: int
    offset: float
    sensing: str
    seed: int
    base: DuelSettings

    @property
    def key(self) -> str:
        """Key among records."""
        text = json.dumps(settings_entries(self.base), sort_keys=True)
        digest = sha256(text.encode()).hexdigest()[:12]
        path = (self.speed, self.bearing, self.offset, self.sensing)
        return json.dumps([*path, self.seed, digest])

    @property
    def passes(self) -> bool:
        """Whether the person would pass a robot that does not move."""
        return abs(self.offset) >= PASSING

    @property
    def settings(self) -> DuelSettings:
        """Settings of the game, with the person far enough away at first."""
        strategy = self.base.strategy
        ahead = strategy.contact_time + STANDING
        distance = strategy.clearance + self.speed * ahead
        room = self.base.room
        if self.sensing == "cameras":
            # A near wall would be detected before the person.
            room = replace(room, walls=distance + WALL_CLEARANCE)
        return replace(
            self.base,
            seed=self.seed,
            duration=(distance + PAST) / self.speed,
            sensing=self.sensing,
            room=room,
            person=PersonSettings("straight", self.speed, miss=self.offset),
            start=StartSettings(
                distance, 0.0, wrap_angle(-radians(self.bearing))
            ),
        )


def base_settings(
    walk: WalkSettings, legs: LegsSettings = NO_LEGS
) -> DuelSettings:
    """Return the game settings of a campaign.

    Args:
        walk: Robot, gait, physics, body and control.
        legs: Walking policy; with one the robot steps aside.
    """
    base = DuelSettings(
        robot=walk.robot,
        gait=walk.gait,
        physics=walk.physics,
        body=walk.body,
        control=walk.control,
        pursuer="person",
        strategy=Evasion(trigger="time"),
    )
    if not legs.walks:
        return base
    return replace(
        with_legs(base, legs.network),
        legs=legs,
        evader_strategy="step-aside",
        strategy=replace(base.strategy, clearance=DashEvasion().clearance),
    )


def encounters(
    walk: WalkSettings,
    sensings: Sequence[str],
    *,
    seeds: int,
    legs: LegsSettings = NO_LEGS,
    speeds: Sequence[float] | None = None,
    bearings: Sequence[int] | None = None,
    offsets: Sequence[float] | None = None,
) -> Iterator[Encounter]:
    """Yield the encounters of a grid.

    Args:
        walk: Settings of the robot; its seed is the first one.
        sensings: Kinds of sensing, as in :class:`DuelSettings`.
        seeds: Number of seeds for each combination.
        legs: Walking policy of the robot; none by default.
        speeds: Speeds of people, in [m/s]; by default those for the legs.
        bearings: Initial bearings of people, in [deg]; likewise.
        offsets: Lateral offsets of their paths, in [m]; likewise.

    Raises:
        ConfigurationError: If the robot cannot sense like that.
    """
    base = base_settings(walk, legs)
    speeds = speeds or (SPEEDS_ON_LEGS if legs.walks else SPEEDS)
    bearings = bearings or (BEARINGS_ON_LEGS if legs.walks else BEARINGS)
    offsets = offsets or (OFFSETS_ON_LEGS if legs.walks else OFFSETS)
    for sensing in sensings:
        replace(base, sensing=sensing)
        for speed in speeds:
            for bearing in bearings:
                for offset in offsets:
                    for seed in range(walk.seed, walk.seed + seeds):
                        yield Encounter(
                            speed, bearing, offset, sensing, seed, base
                        )


def play_encounter(encounter: Encounter) -> Record:
    """Play an encounter and return its record."""
    run = run_duel(encounter.settings)
    if run.outcome is Outcome.INTERRUPTED:
        raise KeyboardInterrupt
    return _record_of(run)


def play_encounters(encounters: list[Encounter]) -> list[Record]:
    """Play encounters side by side and return their records."""
    return [_record_of(r) for r in run_duels([e.settings for e in encounters])]


def _record_of(run: DuelRun) -> Record:
    summary = run.summary
    return {
        "outcome": run.outcome.value,
        "duration_s": run.duration,
        "triggered_at_s": summary.triggered_at_s,
        "triggered_at_distance_m": summary.triggered_at_distance_m,
        "closest_m": summary.min_distance_m,
        "theory_closest_m": summary.theory.closest_approach_m,
    }
