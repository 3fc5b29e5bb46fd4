"""Encounters with approaching people."""

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from hashlib import sha256
from math import atan2, cos, radians, sin

import numpy as np

from ..core.poses import wrap_angle
from ..games.configuration_file import settings_entries
from ..games.duel import run_duel, run_duels
from ..games.duel_settings import DuelSettings, StartSettings
from ..games.outcome import Outcome
from ..games.robot_settings import with_legs
from ..games.run import DuelRun
from ..games.walk_settings import WalkSettings
from ..locomotion.policy.legs_settings import LegsSettings
from ..sim.camera_settings import CameraSettings
from ..sim.crowd_motion import REACTIONS
from ..sim.person_settings import PersonSettings
from ..strategies import DashEvasion, Evasion
from ..strategies.shield_settings import ShieldSettings
from .tabulation import Record

SPEEDS = (0.3, 0.6, 1.0, 1.4)  # of people, in [m/s]
BEARINGS = (0, 45, -90, 135, 180)  # from which they approach, in [deg]
SPEEDS_ON_LEGS = (0.5, 1.0, 1.4, 1.8)  # likewise, of robots on learned legs
OFFSETS_ON_LEGS = (0.0, 1.2)
BEARINGS_ON_LEGS = tuple(range(0, 360, 30))
OFFSETS = (0.0, 0.3, -0.3, 1.2)  # lateral, of their path, in [m]
LADDER = (  # of what people do near the robot
    "straight",
    "halting",
    "turning",
    "backing",
    *(name for name in REACTIONS if name not in ("none", "avoid-people")),
)
HALTS_AT = 1.2  # distance from the robot at which people halt, in [m]
TURNS_AT = 1.6  # likewise at which they turn towards it
TURNING_OFFSET = 1.2  # of the path of people before they turn, in [m]
NO_LEGS = LegsSettings()
NO_SHIELD = ShieldSettings()
CAMERAS = CameraSettings()
PASSING = 1.0  # least offset of people who only pass, in [m]
STANDING = 1.5  # time before a person can trigger evasion, in [s]
WALL_CLEARANCE = 4.0  # from the person to the walls with cameras, in [m]
PAST = 2.5  # distance that they walk on behind the robot, in [m]
LINGERING = 3.0  # time for what people do near the robot, in [s]
LATE = 1.5  # before contact, during which a change of course is late, in [s]
CHANGE = 0.5  # least change of velocity relative to the speed
RESTING = 0.1  # speed below which a person is at rest, in [m/s]
SAME = 0.05  # by which closest approaches may differ, in [m]


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
        reaction: What the person does near the robot, one of ``LADDER``.
        change_at: Distance from the robot at which a person halts or turns
            towards it, in [m].
    """

    speed: float
    bearing: float
    offset: float
    sensing: str
    seed: int
    base: DuelSettings
    reaction: str = "straight"
    change_at: float = 0.0

    @property
    def key(self) -> str:
        """Key among records."""
        text = json.dumps(settings_entries(self.base), sort_keys=True)
        digest = sha256(text.encode()).hexdigest()[:12]
        path = (self.speed, self.bearing, self.offset, self.sensing)
        reaction = self.reaction, self.change_at
        return json.dumps([*path, self.seed, digest, *reaction])

    @property
    def passes(self) -> bool:
        """Whether the person would pass a robot that does not move."""
        return self.reaction == "straight" and abs(self.offset) >= PASSING

    @property
    def settings(self) -> DuelSettings:
        """Settings of the game, with the person far enough away at first."""
        strategy = self.base.strategy
        ahead = strategy.contact_time + STANDING
        distance = strategy.clearance + self.speed * ahead
        room, lingers = self.base.room, self.reaction != "straight"
        if self.sensing == "cameras":
            # A near wall would be detected before the person.
            room = replace(room, walls=distance + WALL_CLEARANCE)
        return replace(
            self.base,
            seed=self.seed,
            duration=(distance + PAST) / self.speed + lingers * LINGERING,
            sensing=self.sensing,
            room=room,
            person=self._person(distance),
            start=StartSettings(
                distance, 0.0, wrap_angle(-radians(self.bearing))
            ),
        )

    def _person(self, distance: float) -> PersonSettings:
        """Return the walk of the person from an initial distance, in [m]."""
        walk = PersonSettings("straight", self.speed, miss=self.offset)
        if self.reaction in REACTIONS:
            return replace(walk, reaction=self.reaction)
        if self.reaction == "backing":
            return replace(walk, backward=True)
        if self.reaction == "straight":
            return walk
        # The robot stands at (distance, 0), the person starts at the origin.
        course = atan2(self.offset, distance)
        aside, along = distance * sin(course), distance * cos(course)
        change = max(self.change_at, abs(aside))
        walked = max(0.0, along - (change**2 - aside**2) ** 0.5)
        if self.reaction == "halting":
            return replace(walk, halt_after=walked)
        x, y = walked * cos(course), walked * sin(course)
        turn = wrap_angle(atan2(-y, distance - x) - course)
        return replace(walk, turn_after=walked, turn=turn)


def base_settings(
    walk: WalkSettings,
    legs: LegsSettings = NO_LEGS,
    strategy: str = "",
    shield: ShieldSettings = NO_SHIELD,
    cameras: CameraSettings = CAMERAS,
) -> DuelSettings:
    """Return the game settings of a campaign.

    Args:
        walk: Robot, gait, physics, body and control.
        legs: Walking policy.
        strategy: Strategy of the robot; by default that for its legs.
        shield: Shield of the robot.
        cameras: Its cameras, with the sensing of cameras.
    """
    base = DuelSettings(
        robot=walk.robot,
        gait=walk.gait,
        physics=walk.physics,
        body=walk.body,
        control=walk.control,
        pursuer="person",
        strategy=Evasion(trigger="time"),
        shield=shield,
        cameras=cameras,
    )
    if legs.walks:
        base = replace(
            with_legs(base, legs.network),
            legs=legs,
            strategy=replace(base.strategy, clearance=DashEvasion().clearance),
        )
    return replace(base, evader_strategy=strategy)


def encounters(
    base: DuelSettings,
    sensings: Sequence[str],
    seeds: Sequence[int],
    *,
    speeds: Sequence[float] | None = None,
    bearings: Sequence[int] | None = None,
    offsets: Sequence[float] | None = None,
    reactions: Sequence[str] = ("straight",),
) -> Iterator[Encounter]:
    """Yield the encounters of a grid.

    People who react are aimed at the robot, and those who turn beside it.

    Args:
        base: Settings of the robot; see :func:`base_settings`.
        sensings: Kinds of sensing, as in :class:`DuelSettings`.
        seeds: Seeds of each combination.
        speeds: Speeds of people, in [m/s]; by default those for the legs.
        bearings: Initial bearings of people, in [deg]; likewise.
        offsets: Lateral offsets of straight paths, in [m]; likewise.
        reactions: What they do near the robot, of ``LADDER``.

    Raises:
        ConfigurationError: If the robot cannot sense like that.
    """
    walks = base.legs.walks
    speeds = speeds or (SPEEDS_ON_LEGS if walks else SPEEDS)
    bearings = bearings or (BEARINGS_ON_LEGS if walks else BEARINGS)
    offsets = offsets or (OFFSETS_ON_LEGS if walks else OFFSETS)
    kinds: list[tuple[str, float, float]] = []
    for reaction in reactions:
        if reaction == "straight":
            kinds += [(reaction, offset, 0.0) for offset in offsets]
        elif reaction == "turning":
            kinds.append((reaction, TURNING_OFFSET, TURNS_AT))
        else:
            kinds.append((reaction, 0.0, HALTS_AT))
    for sensing in sensings:
        replace(base, sensing=sensing)
        for speed in speeds:
            for bearing in bearings:
                for reaction, offset, change in kinds:
                    for seed in seeds:
                        yield Encounter(
                            *(speed, bearing, offset, sensing, seed, base),
                            reaction=reaction,
                            change_at=change,
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
        "cause": cause_of(run),
    }


def cause_of(run: DuelRun) -> str | None:
    """Explain how a game with a person ended.

    Returns:
        None without contact and fall. "fall"; "did not start" if the robot
        never moved; "walked into" a person at rest; "point too" if the
        template, which knows the person exactly, is touched as well; "late
        change" of the person's velocity; else "legs", which fell short of
        the template.
    """
    if run.outcome is Outcome.FALL:
        return "fall"
    if run.outcome is not Outcome.CONTACT:
        return None
    if run.summary.triggered_at_s is None:
        return "did not start"
    moved = np.gradient(run.pursuer.torso[:, :2], run.times, axis=0)
    recent = run.times >= run.times[-1] - LATE
    speed = float(np.hypot(*moved[-1]))
    if speed < RESTING:
        return "walked into"
    theory = run.summary.theory.closest_approach_m
    if theory is not None and theory <= run.summary.min_distance_m + SAME:
        return "point too"
    change = np.hypot(*(moved[recent] - moved[-1]).T).max()
    return "late change" if change > CHANGE * speed else "legs"
