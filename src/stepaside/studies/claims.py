"""Claims of the paper and their measurements."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import inf, isfinite, nan
from typing import Any, Literal

import numpy as np

Readings = dict[str, float]


def most_deviating(values: Sequence[float], expected: float) -> float:
    """Return the value farthest from an expected one; NaN without values."""
    if not len(values):
        return nan
    return float(max(values, key=lambda value: _deviation(value, expected)))


def _deviation(value: float, expected: float) -> float:
    """Return the distance from an expected value; inf for NaN and inf."""
    return abs(value - expected) if isfinite(value) else inf


Relation = Literal["=", "<", ">"]
RUN_FACTOR = 2.0  # tolerance of a single run over that of the mean


@dataclass(frozen=True, slots=True)
class Claim:
    """One claim, figure or number of the paper.

    Attributes:
        key: Name of its reading in the job that measures it.
        text: Claim of the paper, corrected where necessary.
        section: Section or figure of the paper.
        level: Level at which it is measured: closed form, unicycles,
            sampled, planner or physics.
        expected: Expected value.
        unit: Unit of the values.
        tolerance: Largest difference at which the claim holds; zero for an
            inequality.
        relation: Whether the measured value must equal, be below or be
            above the expected one.
        as_printed: The printed text, where it differs.
    """

    key: str
    text: str
    section: str
    level: str
    expected: float
    unit: str
    tolerance: float = 0.0
    relation: Relation = "="
    as_printed: str | None = None

    def holds(self, values: Sequence[float]) -> bool:
        """Return whether the runs confirm the claim.

        Every run must have a finite value. An inequality must hold in every
        run. For an equality the mean must be within the tolerance, and every
        single run within twice the tolerance.

        Args:
            values: Measured value of each run; at least one.
        """
        if not values or not all(isfinite(value) for value in values):
            return False
        differences = [value - self.expected for value in values]
        if self.relation == "<":
            return max(differences) < 0.0
        if self.relation == ">":
            return min(differences) > 0.0
        mean = float(np.mean(values)) - self.expected
        largest = max(abs(difference) for difference in differences)
        return (
            abs(mean) <= self.tolerance
            and largest <= RUN_FACTOR * self.tolerance
        )


@dataclass(frozen=True, slots=True)
class ClaimRow:
    """Claim with its measured values.

    Attributes:
        name: Job and key of the claim, as in ``footsteps.stepsize``.
        claim: The claim.
        values: Measured value of each run.
    """

    name: str
    claim: Claim
    values: tuple[float, ...]

    @property
    def measured(self) -> float:
        """Mean of the runs; NaN if one of them has no finite value."""
        if not self.values or not all(isfinite(v) for v in self.values):
            return nan
        return float(np.mean(self.values))

    @property
    def spread(self) -> float:
        """Standard deviation of the runs; 0 for a single run."""
        if len(self.values) < 2 or not isfinite(self.measured):
            return 0.0 if len(self.values) == 1 else nan
        return float(np.std(self.values, ddof=1))

    @property
    def holds(self) -> bool:
        """Whether the runs confirm the claim; see :meth:`Claim.holds`."""
        return self.claim.holds(self.values)

    def to_json(self) -> dict[str, Any]:
        """Return the row as a JSON object; null for missing values."""
        claim = self.claim
        finite = [value for value in self.values if isfinite(value)]
        return {
            "name": self.name,
            "claim": claim.text,
            "section": claim.section,
            "level": claim.level,
            "expected": claim.expected,
            "relation": claim.relation,
            "tolerance": claim.tolerance,
            "unit": claim.unit,
            "measured": _number(self.measured),
            "spread": _number(self.spread),
            "least": min(finite, default=None),
            "greatest": max(finite, default=None),
            "runs": len(self.values),
            "verdict": "holds" if self.holds else "fails",
            "as_printed": claim.as_printed,
        }


@dataclass(frozen=True, slots=True)
class ClaimJob:
    """Measurement of several claims in one run.

    Attributes:
        claims: The claims.
        measure: Function from a seed to a reading for each claim.
        settings: Function from a seed to the settings, as text; empty by
            default.
        seeded: Whether the readings depend on the seed; if not, one run is
            enough.
    """

    claims: tuple[Claim, ...]
    measure: Callable[[int], Readings]
    settings: Callable[[int], str] = lambda _: ""
    seeded: bool = False

    def rows(
        self, name: str, runs: Sequence[Mapping[str, float]]
    ) -> list[ClaimRow]:
        """Return one row per claim from the readings of runs."""
        return [
            ClaimRow(
                f"{name}.{claim.key}",
                claim,
                tuple(run[claim.key] for run in runs),
            )
            for claim in self.claims
        ]


def _number(value: float) -> float | None:
    return value if isfinite(value) else None
