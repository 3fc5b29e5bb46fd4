"""Summary of a finished game of any number of players."""

from collections.abc import Mapping
from itertools import combinations
from math import isfinite
from typing import NamedTuple

import numpy as np

from ..core.constants import CAPTURE_DISTANCE
from ..core.poses import Array
from ..sim.crowd_motion import RADIUS
from ..theory.unicycle.circle_fit import fit_circle
from .duel_circle import (
    angle_between,
    cycle_mean,
    distance_between,
    last_third,
)
from .duel_evaluation import planning_values
from .game import GameInPlay
from .game_settings import GameSettings, PlayerSettings
from .game_summary import CrowdResult, GameSummary, PairResult, PlayerResult
from .outcome import Outcome
from .trajectory import PlanningTimes, Trajectory

MOVED = 0.02  # distance from the start that counts as motion, in [m]
INTRUSIONS = (0.45, 1.2)  # of crowd navigation: intimate and personal, [m]


class GameRecord(NamedTuple):
    """Record of a finished game.

    Attributes:
        settings: Settings with the initial poses filled in.
        game: The game that was played.
        times: Times of the samples, in [s]. Shape (n,).
        tracks: Trajectory of each player, by name.
        planning: Planning times of each player, by name.
    """

    settings: GameSettings
    game: GameInPlay
    times: Array
    tracks: Mapping[str, Trajectory]
    planning: Mapping[str, PlanningTimes]


def summarise_game(record: GameRecord) -> GameSummary:
    """Compute the summary of a game."""
    settings = record.settings
    pairs = [
        _pair(record, one, other)
        for one, other in combinations(settings.names, 2)
    ]
    people = [p for p in settings.players if p.body == "person"]
    return GameSummary(
        seed=settings.seed,
        level=settings.level,
        results=[_player(record, p, pairs) for p in settings.players],
        pairs=pairs,
        crowd=[
            _crowd(record, p, people)
            for p in settings.players
            if p.decides and people
        ],
        **planning_values(record.planning.values()),
        real_time_factor=record.game.real_time_factor,
        touched=list(record.game.touched),
        fallen=list(record.game.fallen),
    )


def _pair(record: GameRecord, one: str, other: str) -> PairResult:
    """Summarise two players."""
    times, identities = record.times, record.settings.identities
    first, second = record.tracks[one], record.tracks[other]
    apart = distance_between(first.torso, second.torso)
    closest = int(apart.argmin())
    caught = np.flatnonzero(apart <= CAPTURE_DISTANCE)
    opposed = identities[one].opposes(identities[other])
    tail = last_third(times)
    last = first.unicycle[tail], second.unicycle[tail]
    return PairResult(
        players=[one, other],
        closest_m=float(apart[closest]),
        closest_at_s=float(times[closest]),
        captured_at_s=float(times[caught[0]])
        if opposed and caught.size
        else None,
        distance_m=float(distance_between(*last).mean()),
        angle_deg=float(np.degrees(angle_between(*last)).mean()),
    )


def _player(
    record: GameRecord, own: PlayerSettings, pairs: list[PairResult]
) -> PlayerResult:
    """Summarise one player."""
    poses, times = record.tracks[own.name].unicycle, record.times
    moved = np.hypot(*(poses[:, :2] - poses[0, :2]).T) > MOVED
    first = np.flatnonzero(moved)
    ways = [*poses[:, :2].T]
    if record.settings.level == "physics" and own.body == "robot":
        cycle = 2.0 * own.gait.step_duration
        ways = [cycle_mean(way, times, cycle) for way in ways]
    steps = np.diff(ways, axis=1)
    radius = (
        fit_circle(poses[last_third(times), :2])[1] if first.size else np.nan
    )
    return PlayerResult(
        name=own.name,
        role=own.role,
        team=own.identity.team,
        body=own.body,
        path_m=float(np.hypot(*steps).sum()),
        radius_m=float(radius) if isfinite(radius) else None,
        moved_at_s=float(times[first[0]]) if first.size else None,
        fell=own.name in record.game.fallen,
        touched=own.name in record.game.touched,
        goal_at_s=record.game.goals_at.get(own.name),
        closest_m=min(
            (pair.closest_m for pair in pairs if own.name in pair.players),
            default=None,
        ),
    )


def _crowd(
    record: GameRecord, own: PlayerSettings, people: list[PlayerSettings]
) -> CrowdResult:
    """Measure the encounter of a robot with people."""
    poses, times = record.tracks[own.name].unicycle, record.times
    apart = np.array(
        [
            distance_between(poses, record.tracks[person.name].unicycle)
            for person in people
        ]
    )
    if record.settings.level == "physics" and own.body == "robot":
        collisions = int(own.name in record.game.touched)
    else:
        touching = apart < own.radius + RADIUS
        begins = np.diff(touching.astype(int), axis=1, prepend=0) > 0
        collisions = int(np.count_nonzero(begins))
    nearest = apart.min(axis=0)
    period = float(times[1] - times[0]) if len(times) > 1 else 0.0
    intimate, personal = (
        period * int(np.count_nonzero(nearest < limit)) for limit in INTRUSIONS
    )
    arrived = record.game.goals_at.get(own.name)
    reached = (
        arrived is not None
        if own.goal
        else (record.game.outcome is Outcome.COMPLETED)
    )
    unharmed = own.name not in (*record.game.touched, *record.game.fallen)
    return CrowdResult(
        name=own.name,
        people=len(people),
        success=reached and unharmed and collisions == 0,
        collisions=collisions,
        time_s=arrived,
        below_0_45_m_s=intimate,
        below_1_2_m_s=personal,
    )
