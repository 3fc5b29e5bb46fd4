"""A claim of the paper beside what was measured."""

from dataclasses import asdict, dataclass
from math import isfinite
from typing import Any, Literal


@dataclass(frozen=True, slots=True)
class Row:
    """One claim, figure or number of the paper.

    Attributes:
        claim: What the paper says, as it should read.
        section: Where it says so.
        level: At which level it was measured: closed form, unicycles,
            sampled, planner or physics.
        expected: Value that it stands for.
        measured: Value that was found.
        tolerance: Greatest difference at which the claim holds; for an
            inequality, zero.
        unit: Unit of the values.
        relation: Whether the measured value must equal, be below or be
            above the expected one.
        as_printed: The text where it reads otherwise.
    """

    claim: str
    section: str
    level: str
    expected: float
    measured: float
    tolerance: float
    unit: str
    relation: Literal["=", "<", ">"] = "="
    as_printed: str | None = None

    @property
    def holds(self) -> bool:
        """Whether the measurement bears the claim out."""
        if not isfinite(self.measured):
            return False
        difference = self.measured - self.expected
        if self.relation == "<":
            return difference < 0.0
        if self.relation == ">":
            return difference > 0.0
        return abs(difference) <= self.tolerance

    def to_json(self) -> dict[str, Any]:
        """Row as one JSON object, with its verdict."""
        row = asdict(self)
        if not isfinite(self.measured):
            row["measured"] = None
        return row | {"verdict": "holds" if self.holds else "fails"}
