"""A claim of the paper beside what was measured."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import inf, isfinite, nan
from typing import Any, Literal

import numpy as np

Readings = dict[str, float]


def farthest(values: Sequence[float], expected: float) -> float:
    """Value that is farthest from an expected one; NaN if there is none."""
    if not len(values):
        return nan
    return float(max(values, key=lambda value: _off(value, expected)))


def _off(value: float, expected: float) -> float:
    """Distance from an expected value; a missing value is farthest off."""
    return abs(value - expected) if isfinite(value) else inf


Relation = Literal["=", "<", ">"]
WIDER = 2.0  # times the tolerance: where every single run must lie


@dataclass(frozen=True, slots=True)
class Claim:
    """One claim, figure or number of the paper.

    Attributes:
        key: Name of its reading in the job that measures it.
        text: What the paper says, as it should read.
        section: Where it says so.
        level: At which level it is measured: closed form, unicycles,
            sampled, planner or physics.
        expected: Value that it stands for.
        unit: Unit of the values.
        tolerance: Greatest difference at which the claim holds; for an
            inequality, zero.
        relation: Whether the measured value must equal, be below or be
            above the expected one.
        as_printed: The text where it reads otherwise.
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
        """Whether the runs bear the claim out.

        Every run must have a finite value. For an inequality every run must
        be on its side. For an equality the mean must be within the
        tolerance, and every single run within twice the tolerance.

        Args:
            values: Measured value of each run; at least one.
        """
        if not values or not all(isfinite(value) for value in values):
            return False
        off = [value - self.expected for value in values]
        if self.relation == "<":
            return max(off) < 0.0
        if self.relation == ">":
            return min(off) > 0.0
        mean = float(np.mean(values)) - self.expected
        farthest = max(abs(difference) for difference in off)
        return (
            abs(mean) <= self.tolerance and farthest <= WIDER * self.tolerance
        )


@dataclass(frozen=True, slots=True)
class ClaimRow:
    """A claim and what was measured of it.

    Attributes:
        name: Job and key of the claim, as in ``footsteps.stepsize``.
        claim: The claim.
        values: Measured value of each run.
        version: Fingerprint of the code that they depend on.
    """

    name: str
    claim: Claim
    values: tuple[float, ...]
    version: str

    @property
    def measured(self) -> float:
        """Mean of the runs; NaN if one of them has no value."""
        if not self.values or not all(isfinite(v) for v in self.values):
            return nan
        return float(np.mean(self.values))

    @property
    def spread(self) -> float:
        """Standard deviation of the runs; 0 of a single one."""
        if len(self.values) < 2 or not isfinite(self.measured):
            return 0.0 if len(self.values) == 1 else nan
        return float(np.std(self.values, ddof=1))

    @property
    def holds(self) -> bool:
        """Whether the runs bear the claim out; see :meth:`Claim.holds`."""
        return self.claim.holds(self.values)

    def to_json(self) -> dict[str, Any]:
        """Row as one JSON object, with its verdict; null where no value."""
        claim = self.claim
        found = [value for value in self.values if isfinite(value)]
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
            "least": min(found, default=None),
            "greatest": max(found, default=None),
            "runs": len(self.values),
            "version": self.version,
            "verdict": "holds" if self.holds else "fails",
            "as_printed": claim.as_printed,
        }


@dataclass(frozen=True, slots=True)
class ClaimJob:
    """What measures some claims in one go.

    Attributes:
        claims: The claims.
        measure: From a seed to a reading for each claim.
        rooms: Code that the readings depend on; see
            :func:`~stepaside.studies.code_version.code_version`.
        libraries: Libraries that they depend on.
        settings: From a seed to what else decides the readings, in words;
            nothing by default.
        seeded: Whether the seed matters; without, one run says it all.
    """

    claims: tuple[Claim, ...]
    measure: Callable[[int], Readings]
    rooms: tuple[str, ...]
    libraries: tuple[str, ...]
    settings: Callable[[int], str] = lambda _: ""
    seeded: bool = False

    def rows(
        self, name: str, runs: Sequence[Mapping[str, float]], version: str
    ) -> list[ClaimRow]:
        """Rows of the readings of some runs."""
        return [
            ClaimRow(
                f"{name}.{claim.key}",
                claim,
                tuple(run[claim.key] for run in runs),
                version,
            )
            for claim in self.claims
        ]


def _number(value: float) -> float | None:
    return value if isfinite(value) else None
