"""Contract of a learned strategy: what its network observes and decides.

Observations are free of units: lengths in units of v/k, speeds in units of v,
rates in units of k, with speed v and gain k of the own gait, in its path time.
So one network serves gaits of any size, in unicycles, in steps and in physics.
"""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import cos, pi, sin
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.errors import PolicyError, check_bearing
from ...core.poses import Array
from ...planning import Direction
from ..knowledge import Knowledge, Limits

FORMAT = "1"
HEADINGS = 15  # of discrete actions
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
    """Return the number of values of an observation."""
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


@dataclass(frozen=True, slots=True)
class StrategyContract:
    """Observation of a network, and meaning of its outputs."""

    direction: Direction  # of driving: forward, or backward
    terms: tuple[str, ...]  # in order; see :data:`SENSED_TERMS`
    # desired heading of each discrete action [rad], None to stand: the action
    # with the largest output is taken. Empty for continuous actions: the
    # outputs are a heading [rad], limited to half a turn, and a speed factor,
    # limited to [0, 1]
    headings: tuple[float | None, ...] = ()

    def __post_init__(self) -> None:
        """Check terms and headings."""
        width_of(self.terms)
        for heading in self.headings:
            if heading is not None:
                check_bearing(heading, "heading", PolicyError)

    @property
    def observation_width(self) -> int:
        """Number of values of an observation."""
        return width_of(self.terms)

    @property
    def action_width(self) -> int:
        """Number of outputs."""
        return len(self.headings) or 2

    def metadata(self) -> dict[str, str]:
        """Return the contract as text entries."""
        return {
            "stepaside_strategy": FORMAT,
            "direction": self.direction.name.lower(),
            "observation_names": json.dumps(self.terms),
            "action_headings": json.dumps(self.headings),
        }


def contract_of(metadata: Mapping[str, str]) -> StrategyContract:
    """Return the contract that the metadata of a network holds."""
    given = _entry(metadata, "stepaside_strategy")
    if given != FORMAT:
        raise PolicyError(
            f"metadata stepaside_strategy must be {FORMAT}, got {given:.20}"
        )
    name = _entry(metadata, "direction").upper()
    if name not in Direction.__members__:
        raise PolicyError(
            "metadata direction must be forward or backward, "
            f"got {name.lower():.20}"
        )
    terms = _list(metadata, "observation_names")
    headings = _list(metadata, "action_headings")
    for value in headings:
        if value is not None and type(value) not in (int, float):
            raise PolicyError(
                "metadata action_headings must be numbers [rad] or null, "
                f"got {value!r:.40}"
            )
    return StrategyContract(Direction[name], tuple(terms), tuple(headings))


def discrete_headings(number: int = HEADINGS) -> tuple[float | None, ...]:
    """Return evenly spaced headings, in [rad], and standing."""
    spaced = (pi * (2 * n + 1 - number) / number for n in range(number))
    return (*spaced, None)


def _entry(metadata: Mapping[str, str], key: str) -> str:
    if key not in metadata:
        raise PolicyError(
            f"metadata {key} is missing: not a strategy of stepaside"
        )
    return metadata[key]


def _list(metadata: Mapping[str, str], key: str) -> list[Any]:
    text = _entry(metadata, key)
    try:
        value = json.loads(text)
    except ValueError:
        value = None
    if not isinstance(value, list):
        raise PolicyError(f"metadata {key} must be a list, got {text!r:.40}")
    return value
