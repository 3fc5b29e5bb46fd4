"""What fuzzing came to, by class, and the result that is kept of it."""

from collections import Counter
from pathlib import Path
from typing import Any

from stepaside.core.errors import ConfigurationError
from stepaside.studies.code_version import ROOT
from stepaside.studies.result_files import header, read_result, write_result

# How complaints begin, and what each is counted as.
FAULTS = {
    "traceback": "tracebacks",
    "hang": "hangs",
    "accepted nonsense": "nonsense",
    "leftovers": "leftovers",
}
OTHER = "other"  # lost files, long words, statuses, results
COLUMNS = ("tried", *FAULTS.values(), OTHER)


class Counts:
    """How many cases were tried of each class, and what was wrong.

    Attributes:
        by_class: Of each class, how many cases count in each column.
    """

    def __init__(self) -> None:
        """Begin with nothing tried."""
        self.by_class: dict[str, Counter[str]] = {}

    def add(self, kind: str, complaint: str) -> None:
        """Count a case; the complaint is empty if nothing was wrong."""
        row = self.by_class.setdefault(kind, Counter())
        row["tried"] += 1
        if complaint:
            row[FAULTS.get(complaint.partition(":")[0], OTHER)] += 1

    def total(self) -> Counter[str]:
        """Of all classes together."""
        return sum(self.by_class.values(), Counter())

    @property
    def wrong(self) -> int:
        """Cases that were not as they should be."""
        return wrong_in(self.total())

    def lines(self) -> list[str]:
        """A line for each class and one for all."""
        rows = [*sorted(self.by_class.items()), ("all", self.total())]
        return [
            f"{kind:<28} {row['tried']:>7} tried {wrong_in(row):>5} wrong"
            for kind, row in rows
        ]


def wrong_in(row: Counter[str]) -> int:
    """What was wrong of some cases, of any sort."""
    return row.total() - row["tried"]


def keep(
    file: Path, counts: Counts, seed: int, kinds: list[str], minutes: float
) -> None:
    """Add what a seed came to, in the place of what it came to before.

    Args:
        file: Result that holds the runs of all seeds; made if none is there.
        counts: Of this run.
        seed: That decided its order.
        kinds: That were tried.
        minutes: That it took.
    """
    head = header(
        {"seeds": [], "kinds": sorted(kinds)},
        modules=all_modules(),
        libraries=("click", "mujoco", "numpy", "viser"),
        command=f"python -m tools.fuzz --seed SEED --kinds {' '.join(kinds)} "
        f"--minutes MINUTES --keep docs/results/{file.name}",
    )
    run = {
        "seed": seed,
        "minutes": minutes,
        "version": head["version"],
        "classes": {
            kind: {column: row[column] for column in COLUMNS}
            for kind, row in sorted(counts.by_class.items())
        },
    }
    runs = sorted([*_others(file, seed), run], key=lambda each: each["seed"])
    head["settings"]["seeds"] = [each["seed"] for each in runs]
    together: dict[str, Counter[str]] = {}
    for each in runs:
        for kind, row in each["classes"].items():
            together.setdefault(kind, Counter()).update(row)
    write_result(
        file,
        head,
        classes={k: dict(row) for k, row in sorted(together.items())},
        total={c: sum(row[c] for row in together.values()) for c in COLUMNS},
        runs=runs,
    )


def all_modules() -> tuple[str, ...]:
    """All that the package has."""
    names = (p.stem for p in ROOT.iterdir() if p.suffix in ("", ".py"))
    return tuple(sorted(name for name in names if name[0].isalpha()))


def _others(file: Path, seed: int) -> list[dict[str, Any]]:
    """Runs of other seeds that are kept already."""
    try:
        runs = read_result(file)["runs"]
    except ConfigurationError:
        return []
    return [each for each in runs if each["seed"] != seed]
