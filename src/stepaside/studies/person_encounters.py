"""Encounters with approaching people."""

from dataclasses import dataclass, replace
from math import atan2, cos, radians, sin

import numpy as np

from ..core.poses import wrap_angle
from ..core.random_streams import named_generator
from ..core.setting import CheckedSettings, setting
from ..games.game import Outcome
from ..games.game_settings import GameSettings, StartSettings
from ..games.recorded_game import run_game
from ..sim.person_settings import REACTIONS, PersonSettings
from ..strategies import DashEvasion
from .tabulation import Record

LADDER = (  # of what people do near the robot
    "straight",
    "halting",
    "turning",
    "backing",
    *(name for name in REACTIONS if name not in ("none", "avoid-people")),
)
LEAST = np.array([0.5, -180.0, -0.6, 0.8])  # speed [m/s], bearing [deg],
MOST = np.array([1.4, 180.0, 0.6, 3.0])  # offset [m], change at [m]
TURNING = 0.6, 1.4  # offset of drawn people who turn, to either side, in [m]
STANDING = 1.5  # time before a person can trigger evasion, in [s]
WALL_CLEARANCE = 4.0  # from the person to the walls with cameras, in [m]
PAST = 2.5  # distance that they walk on behind the robot, in [m]
LINGERING = 3.0  # time for what people do near the robot, in [s]


@dataclass(frozen=True, slots=True)
class Encounter(CheckedSettings):
    """Encounter with one approaching person, the pursuer of a duel."""

    game: GameSettings
    speed: float = 1.0  # speed of the person [m/s]
    bearing: float = 0.0  # at first in the frame of the robot [deg]
    offset: float = 0.0  # of the path, to the robot's left [m]
    reaction: str = setting("straight", "Reaction to the robot", names=LADDER)
    change_at: float = 1.2  # where it halts or turns to it [m]
    drawn: bool = False  # all but the reaction, by the seed of the game

    @property
    def person(self) -> "Encounter":
        """The encounter with what is drawn by the seed."""
        if not self.drawn:
            return self
        shares = named_generator(self.game.seed, "person").random(4)
        values = np.round(LEAST + shares * (MOST - LEAST), 6).tolist()
        speed, bearing, offset, change = values
        if self.reaction == "turning":
            low, high = TURNING
            size = low + abs(2.0 * float(shares[2]) - 1.0) * (high - low)
            offset = size if offset >= 0.0 else -size
        return replace(
            self,
            speed=speed,
            bearing=bearing,
            offset=offset,
            change_at=change,
            drawn=False,
        )

    @property
    def settings(self) -> GameSettings:
        """Settings of the game, with the person far enough away at first."""
        duel = self.game.resolved()
        evasion = replace(duel.evader.evasion, trigger="time")
        if duel.evader.legs.network:
            evasion = replace(evasion, clearance=DashEvasion().clearance)
        ahead = evasion.contact_time + STANDING
        distance = evasion.clearance + self.speed * ahead
        scene, lingers = duel.scene, self.reaction != "straight"
        if duel.evader.senses == "cameras":
            # A near wall would be detected before the person.
            scene = replace(scene, walls=distance + WALL_CLEARANCE)
        return duel.changed(
            duration=(distance + PAST) / self.speed + lingers * LINGERING,
            evader={"evasion": evasion},
            scene=scene,
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


def play_encounter(encounter: Encounter) -> Record:
    """Play an encounter and return its record."""
    person = encounter.person
    run = run_game(person.settings).uninterrupted()
    summary = run.summary
    triggered = summary.triggered_at_s is not None
    return {
        "speed": person.speed,
        "bearing": person.bearing,
        "offset": person.offset,
        "outcome": run.outcome.value,
        "contact": run.outcome is Outcome.CONTACT,
        "fell": run.outcome is Outcome.FALL,
        "duration_s": run.duration,
        "triggered": triggered,
        "triggered_at_s": summary.triggered_at_s,
        "triggered_at_distance_m": summary.triggered_at_distance_m,
        "closest_m": summary.min_distance_m,
        "theory_closest_m": summary.theory and summary.theory.min_distance_m,
    }
