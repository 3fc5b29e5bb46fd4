"""Quantities that a learned strategy observes, made from its knowledge.

All are free of units: lengths in units of v/k, speeds in units of v, rates in
units of k, with speed v and gain k of the own gait, in its path time. So one
network serves gaits of any size, in unicycles, in steps and in physics.
"""

from collections.abc import Sequence
from math import cos, sin
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.errors import PolicyError
from ...core.poses import Array
from ..knowledge import Knowledge, Limits

FARTHEST = 8.0  # v/k
FASTEST = 4.0  # in v, and in k
CLEAREST = 2.0  # v/k
RINGS = (0.6, 1.6)  # radii of the points whose clearance is observed, in v/k
DIRECTIONS = 8  # on each ring


class ObservedTerm(NamedTuple):
    """One quantity of an observation: number and range of its values."""

    width: int
    low: float
    high: float
    meaning: str


SENSED_TERMS = {
    "distance": ObservedTerm(1, 0.0, FARTHEST, "distance [v/k]"),
    "bearing": ObservedTerm(
        2, -1.0, 1.0, "cosine and sine of the bearing of the opponent"
    ),
    "bearing_rate": ObservedTerm(
        1,
        -FASTEST,
        FASTEST,
        "turning rate of the line of sight over the floor [k]; 0 until known",
    ),
    "closing_speed": ObservedTerm(
        1, -FASTEST, FASTEST, "decrease of the distance [v]; 0 until known"
    ),
    "moving": ObservedTerm(1, 0.0, 1.0, "1 while the body walks, else 0"),
    "clearances": ObservedTerm(
        1 + len(RINGS) * DIRECTIONS,
        -CLEAREST,
        CLEAREST,
        "clearance [v/k] of the own reference point, and of 8 points around "
        "it at 0.6 v/k and 8 at 1.6 v/k, from ahead to the left",
    ),
}
"""Terms that the senses of a robot give, by name."""

FULL_STATE_TERMS = {
    "opponent_bearing": ObservedTerm(
        2, -1.0, 1.0, "cosine and sine of the own bearing from the opponent"
    ),
    "closest": ObservedTerm(
        1, 0.0, FARTHEST, "closest approach so far [v/k]; 0 after contact"
    ),
    "remaining": ObservedTerm(1, 0.0, 1.0, "share of the game that is left"),
}
"""Further terms of learning environments, which no sense gives."""


def ring_points() -> Array:
    """Return the points of "clearances" in the own frame [v/k]. (17, 2)."""
    angles = np.arange(DIRECTIONS) * (2.0 * np.pi / DIRECTIONS)
    ring = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    return np.concatenate([np.zeros((1, 2)), *(r * ring for r in RINGS)])


_RING = ring_points()


def width_of(terms: Sequence[str]) -> int:
    """Return the number of values of an observation.

    Raises:
        PolicyError: If a term is unknown.
    """
    for name in terms:
        if name not in SENSED_TERMS:
            raise PolicyError(
                f"unknown observation term {name!r}; there are "
                f"{', '.join(SENSED_TERMS)}"
            )
    return sum(SENSED_TERMS[name].width for name in terms)


def observe(knowledge: Knowledge, terms: Sequence[str]) -> NDArray[np.float32]:
    """Return the values of terms, in order. Shape (width_of(terms),)."""
    values: list[float] = []
    for name in terms:
        values.extend(_values(knowledge, name))
    return np.array(values, dtype=np.float32)


def length_unit(limits: Limits) -> float:
    """Return the unit of length, speed over gain, in [m]."""
    return limits.speed / limits.gain


def _values(known: Knowledge, name: str) -> Sequence[float]:
    """Return the values of one term."""
    limits = known.limits
    # Rates are sensed in gait time; gain and speed are those of path time.
    pace = limits.step_duration * limits.speed / limits.stride
    if name == "distance":
        return (min(known.distance / length_unit(limits), FARTHEST),)
    if name == "bearing":
        return cos(known.bearing), sin(known.bearing)
    if name == "moving":
        return (float(known.moving),)
    if name == "clearances":
        return _clearances(known)
    rate = (known.closing_speed or 0.0) * pace / limits.speed
    if name == "bearing_rate":
        rate = (known.bearing_rate or 0.0) * pace / limits.gain
    return (min(max(rate, -FASTEST), FASTEST),)


def _clearances(known: Knowledge) -> list[float]:
    """Return the clearances around the own reference point, in [v/k]."""
    if not known.obstacles_in_map:
        return [CLEAREST] * len(_RING)
    unit = length_unit(known.limits)
    points = known.pose_in_map.transform_points(unit * _RING)
    found = known.obstacles_in_map.clearance(points) / unit
    values: list[float] = np.clip(found, -CLEAREST, CLEAREST).tolist()
    return values
