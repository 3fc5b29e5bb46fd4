"""Encounters with people drawn at random, every second one a hard one."""

import json
from dataclasses import dataclass, replace
from hashlib import sha256
from math import inf

import numpy as np

from ..core.random_streams import named_generator
from ..games.configuration_file import settings_entries
from ..games.duel_evaluation import template_closest_approach
from ..games.duel_settings import DuelSettings
from .person_encounters import LADDER, Encounter, play_encounter
from .study import Study
from .tabulation import Record

LEAST = np.array([0.5, -180.0, -0.6, 0.8])  # speed [m/s], bearing [deg],
MOST = np.array([1.4, 180.0, 0.6, 3.0])  # offset [m], change at [m]
TURNING = 0.6, 1.4  # offset of people who turn, to either side, in [m]
CANDIDATES = 3  # that a search for a hard person begins with
REFINED = 3  # variations of the hardest so far, each smaller
SPREAD = 0.15  # of the first variation, relative to the ranges


@dataclass(frozen=True, slots=True)
class DrawnEncounter:
    """Encounter with a person drawn at random.

    It depends on seed and number only, so that a longer campaign begins with
    the people of a shorter one.

    Attributes:
        number: Number of the person, from 0.
        seed: Seed of the campaign.
        sensing: Sensing of the robot, as in :class:`DuelSettings`.
        base: All other settings of the game.
        digest: Fingerprint of these.
    """

    number: int
    seed: int
    sensing: str
    base: DuelSettings
    digest: str

    @property
    def key(self) -> str:
        """Key among records."""
        return json.dumps([self.number, self.seed, self.sensing, self.digest])

    @property
    def is_hard(self) -> bool:
        """Whether a search in the template chooses the person."""
        return self.number % 2 == 1

    @property
    def reaction(self) -> str:
        """What the person does near the robot."""
        return LADDER[self.number // 2 % len(LADDER)]

    def encounter(self) -> Encounter:
        """Draw the person, or search one who approaches the template most."""
        generator = named_generator(self.seed, f"person {self.number}")
        if not self.is_hard:
            return self._person(generator.random(4))
        hardest, least = generator.random(4), inf
        for i in range(CANDIDATES + REFINED):
            drawn = generator.random(4)
            if i >= CANDIDATES:
                spread = SPREAD / (1 + i - CANDIDATES)
                drawn = hardest + spread * generator.standard_normal(4)
                drawn[1] %= 1.0  # of all directions
                drawn = np.clip(drawn, 0.0, 1.0)
            settings = self._person(drawn).settings
            closest = template_closest_approach(settings)
            if closest is not None and closest < least:
                hardest, least = drawn, closest
        return self._person(hardest)

    def _person(self, shares: np.ndarray) -> Encounter:
        """Return the person at some shares of the ranges. Shape (4,)."""
        values = LEAST + shares * (MOST - LEAST)
        speed, bearing, offset, change = np.round(values, 6).tolist()
        if self.reaction == "turning":
            low, high = TURNING
            size = low + abs(2.0 * float(shares[2]) - 1.0) * (high - low)
            offset = size if offset >= 0.0 else -size
        return Encounter(
            *(speed, bearing, offset, self.sensing, self.seed, self.base),
            reaction=self.reaction,
            change_at=change,
        )


def drawn_study(
    base: DuelSettings, sensing: str, number: int
) -> Study[DrawnEncounter]:
    """Return the study of people drawn at random.

    Args:
        base: Settings of every game; the seed is that of the campaign.
        sensing: Sensing of the robot, as in :class:`DuelSettings`.
        number: Number of people.
    """
    base = replace(base, sensing=sensing)
    text = json.dumps(settings_entries(base), sort_keys=True)
    digest = sha256(text.encode()).hexdigest()[:12]
    return Study(
        "people",
        [
            DrawnEncounter(i, base.seed, sensing, base, digest)
            for i in range(number)
        ],
        play_drawn,
        lambda drawn: drawn.key,
    )


def play_drawn(drawn: DrawnEncounter) -> Record:
    """Play an encounter and return its record."""
    encounter = drawn.encounter()
    return {
        "reaction": encounter.reaction,
        "is_hard": drawn.is_hard,
        "speed_m_s": encounter.speed,
        "bearing_deg": encounter.bearing,
        "offset_m": encounter.offset,
        "change_at_m": encounter.change_at,
        **play_encounter(encounter),
    }
