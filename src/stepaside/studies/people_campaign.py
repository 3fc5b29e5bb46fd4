"""Campaigns of people who come: from where, how fast, seen by what."""

import json
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor, as_completed
from dataclasses import dataclass, replace
from hashlib import sha256
from math import radians
from pathlib import Path
from typing import Any

from ..core.poses import wrap_angle
from ..core.worker_pool import give_up
from ..games.configuration_file import plain_settings
from ..games.duel import run_duel
from ..games.duel_settings import DuelSettings, StartSettings
from ..games.walk_settings import WalkSettings
from ..sim.person_settings import PersonSettings
from ..strategies import Evasion
from .record_store import RecordStore
from .robustness_campaign import stamp

SPEEDS = (0.3, 0.6, 1.0, 1.4)  # of people, in [m/s]
BEARINGS = (0, 45, -90, 135, 180)  # where they come from, in [deg]
OFFSETS = (0.0, 0.3, -0.3, 1.2)  # how far beside the robot they aim, in [m]
PASSING = 1.0  # offset from which on nobody means the robot, in [m]
STANDING = 1.5  # time that a robot has before anybody counts, in [s]
SPACE = 4.0  # from a robot that sees to the walls, in [m]
PAST = 2.5  # how far behind the robot they walk on, in [m]
Record = dict[str, Any]
FIELDS = (  # of every record
    *("outcome", "duration_s", "triggered_at_s", "triggered_at_distance_m"),
    *("closest_m", "theory_closest_m"),
)


@dataclass(frozen=True, slots=True)
class Encounter:
    """One person who comes.

    Attributes:
        speed: Of the person, in [m/s].
        bearing: Where the person comes from, in the robot's frame, in [deg].
        offset: How far to the left of the robot the person aims, in [m].
        sensing: How the robot sees, as of :class:`DuelSettings`.
        seed: Of every random draw.
        base: What else the game has.
    """

    speed: float
    bearing: int
    offset: float
    sensing: str
    seed: int
    base: DuelSettings

    @property
    def key(self) -> str:
        """Name in a file of results."""
        plain = json.dumps(plain_settings(self.base), sort_keys=True)
        mark = sha256(plain.encode()).hexdigest()[:12]
        where = (self.speed, self.bearing, self.offset, self.sensing)
        return json.dumps([*where, self.seed, mark])

    @property
    def passes(self) -> bool:
        """Whether the person would pass a robot that stays."""
        return abs(self.offset) >= PASSING

    @property
    def settings(self) -> DuelSettings:
        """Game: the person begins so far away that the robot has time."""
        strategy = self.base.strategy
        ahead = strategy.contact_time + STANDING
        distance = strategy.clearance + self.speed * ahead
        room = self.base.room
        if self.sensing == "cameras":
            # Whoever stands by a wall sees that first.
            room = replace(room, walls=distance + SPACE)
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


def base_of(walk: WalkSettings) -> DuelSettings:
    """Game of a campaign whose robot walks like one that walks alone.

    Args:
        walk: Gait, body, control and floor.
    """
    return DuelSettings(
        robot=walk.robot,
        gait=walk.gait,
        physics=walk.physics,
        body=walk.body,
        control=walk.control,
        pursuer="person",
        strategy=Evasion(trigger="time"),
    )


def encounters(
    walk: WalkSettings,
    sensings: Sequence[str],
    *,
    seeds: int,
    speeds: Sequence[float] = SPEEDS,
    bearings: Sequence[int] = BEARINGS,
    offsets: Sequence[float] = OFFSETS,
) -> Iterator[Encounter]:
    """Everybody who comes, one after the other.

    Args:
        walk: Of the robot; its seed is the first one.
        sensings: How the robot sees.
        seeds: Number of each.
        speeds: Of people, in [m/s].
        bearings: Where they come from, in [deg].
        offsets: How far beside the robot they aim, in [m].
    """
    base = base_of(walk)
    for sensing in sensings:
        for speed in speeds:
            for bearing in bearings:
                for offset in offsets:
                    for seed in range(walk.seed, walk.seed + seeds):
                        yield Encounter(
                            speed, bearing, offset, sensing, seed, base
                        )


def meet(encounter: Encounter) -> tuple[str, Record]:
    """Key of an encounter, and what happened."""
    settings = encounter.settings
    summary = run_duel(settings).summary
    return encounter.key, {
        "outcome": summary.outcome,
        "duration_s": summary.duration_s,
        "triggered_at_s": summary.triggered_at_s,
        "triggered_at_distance_m": summary.triggered_at_distance_m,
        "closest_m": summary.min_distance_m,
        "theory_closest_m": summary.theory.closest_approach_m,
    }


def run_encounters(
    grid: Sequence[Encounter],
    file: Path | None,
    executor: Executor,
    report: Callable[[int], None] | None = None,
    done: dict[str, Record] | None = None,
) -> dict[str, Record]:
    """Play what a file of results does not hold yet.

    Args:
        grid: Who comes.
        file: Results that are done, which grows, so that a campaign that
            was stopped goes on. None keeps nothing.
        executor: Any executor of ``concurrent.futures``.
        report: Called with the number of encounters that are done.
        done: Filled with the results as they come, for whoever stops it.

    Returns:
        What happened in each, by key.
    """
    results: dict[str, Record] = {} if done is None else done
    now, store = stamp(), None if file is None else RecordStore(file)
    wanted = {encounter.key for encounter in grid}
    known = {} if store is None else store.read(FIELDS)
    for key, record in known.items():
        if key in wanted and all(record.get(k) == v for k, v in now.items()):
            results[key] = {k: v for k, v in record.items() if k not in now}
    missing = [each for each in grid if each.key not in results]
    if report is not None:
        report(len(grid) - len(missing))
    futures = [executor.submit(meet, each) for each in missing]
    try:
        for future in as_completed(futures):
            key, record = future.result()
            results[key] = record
            if store is not None:
                store.append(key, record | now)
            if report is not None:
                report(len(results))
    except BaseException:
        give_up(executor, futures)
        raise
    return results
