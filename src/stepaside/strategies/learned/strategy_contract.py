"""Contract of a learned strategy, stored as metadata of its ONNX file."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from math import pi
from typing import Any

from ...core.errors import PolicyError, check_bearing
from ...planning import Direction
from .observation_terms import width_of

FORMAT = "1"
HEADINGS = 15  # of discrete actions


@dataclass(frozen=True, slots=True)
class StrategyContract:
    """Observation of a network, and meaning of its outputs.

    Attributes:
        direction: Whether the body drives forward, as a pursuer does, or
            backward, as an evader does.
        terms: Terms of the observation, in order; see
            :data:`.observation_terms.SENSED_TERMS`.
        headings: Desired heading of each discrete action, in [rad], None to
            stand: the action with the largest output is taken. Empty for
            continuous actions: the outputs are a heading, in [rad], limited
            to half a turn, and a speed factor, limited to [0, 1].
    """

    direction: Direction
    terms: tuple[str, ...]
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
    """Return the contract that the metadata of a network holds.

    Raises:
        PolicyError: If an entry is missing or malformed.
    """
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
