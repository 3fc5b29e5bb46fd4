"""History of benchmark figures, so that regressions show."""

import json
from collections.abc import Mapping
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, NamedTuple

REGRESSION = 1.15  # ratio from which a change is reported as slower


class Change(NamedTuple):
    """Change of a figure since an earlier run.

    Attributes:
        name: Name of the figure.
        before: Earlier value.
        now: Present value.
    """

    name: str
    before: float
    now: float

    @property
    def slowdown(self) -> float:
        """Ratio above 1 if it became slower."""
        faster_is_more = self.name.endswith(("factor", "_per_s"))
        return (
            self.before / self.now
            if faster_is_more
            else self.now / self.before
        )

    @property
    def is_regression(self) -> bool:
        """Whether it became slower by more than the noise of a machine."""
        return self.slowdown > REGRESSION


def changes_since_last(
    file: Path, figures: Mapping[str, float], machine: Mapping[str, Any]
) -> list[Change]:
    """Return how ratios and times changed since the last run on a machine.

    Args:
        file: History, one JSON object per line; it may be missing.
        figures: Present figures.
        machine: Description of this machine; runs on others are skipped.

    Returns:
        Changes of all figures that both runs have.
    """
    same = ("python", "processor", "cores")
    for line in reversed(
        file.read_text().splitlines() if file.exists() else []
    ):
        entry = json.loads(line)
        if all(entry["machine"][key] == machine[key] for key in same):
            return [
                Change(name, entry["figures"][name], value)
                for name, value in figures.items()
                if name in entry["figures"]
            ]
    return []


def append_run(
    file: Path,
    version: str,
    figures: Mapping[str, float],
    machine: Mapping[str, Any],
) -> None:
    """Append a run to the history."""
    entry = {
        "date": datetime.now(UTC).date().isoformat(),
        "version": version,
        "machine": dict(machine),
        "figures": {name: float(f"{x:.4g}") for name, x in figures.items()},
    }
    with file.open("a") as lines:
        lines.write(json.dumps(entry) + "\n")
