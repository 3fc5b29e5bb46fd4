"""Fuzz for some minutes: ``python -m tools.fuzz --help``."""

import argparse
import tempfile
from pathlib import Path
from time import monotonic

from .case import complaint_of
from .counts import Counts, keep
from .groups import obey_ctrl_c
from .kinds import KINDS, all_cases


def main() -> int:
    """Fuzz as the command line says; return 1 if any case failed."""
    parser = argparse.ArgumentParser(
        prog="python -m tools.fuzz", description=__doc__
    )
    add = parser.add_argument
    add("--minutes", type=float, default=1.0, help="when to end")
    add("--seed", type=int, default=0, help="decides the order")
    add("--most", type=int, default=10**9, help="cases to try at most")
    add("--only", default="", help="classes that have this in their name")
    add("--match", default="", help="cases that have this in their name")
    add("--kinds", nargs="*", default=list(KINDS), choices=list(KINDS))
    add("--keep", type=Path, help="result to add the counts to, by seed")
    asked = parser.parse_args()
    obey_ctrl_c()
    counts = Counts()
    with tempfile.TemporaryDirectory(prefix="fuzzed-") as name:
        cases = all_cases(asked.seed, Path(name), asked.kinds)
        began = monotonic()
        end = began + 60.0 * asked.minutes
        for case in cases:
            if monotonic() > end or counts.total()["tried"] >= asked.most:
                break
            if asked.only in case.kind and asked.match in case.name:
                complaint = complaint_of(case)
                counts.add(case.kind, complaint)
                if complaint:
                    tell(case.kind, case.name, complaint)
    print(*counts.lines(), sep="\n")
    if asked.keep:
        minutes = (monotonic() - began) / 60.0
        keep(asked.keep, counts, asked.seed, asked.kinds, minutes)
    return 1 if counts.wrong else 0


def tell(kind: str, name: str, complaint: str) -> None:
    """Print a failed case."""
    print(f"{kind}: {visible(name)}\n    {complaint}", flush=True)


def visible(text: str) -> str:
    """Return a name with control characters escaped."""
    return text.encode("unicode_escape").decode("ascii")


if __name__ == "__main__":
    raise SystemExit(main())
