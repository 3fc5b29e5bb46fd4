"""Try bad input for some minutes: ``python -m tests.fuzz --help``."""

import argparse
import sys
import tempfile
from collections import Counter
from pathlib import Path
from time import monotonic

from .case import Case, complaint_of
from .kinds import KINDS, all_cases


def main() -> int:
    """Read the command line, try, and count; 1 if anything was wrong."""
    parser = argparse.ArgumentParser(
        prog="python -m tests.fuzz", description=__doc__
    )
    add = parser.add_argument
    add("--minutes", type=float, default=1.0, help="when to end")
    add("--seed", type=int, default=0, help="decides the order")
    add("--most", type=int, default=10**9, help="cases to try at most")
    add("--only", default="", help="classes that have this in their name")
    add("--match", default="", help="cases that have this in their name")
    add("--kinds", nargs="*", default=KINDS, choices=list(KINDS))
    asked = parser.parse_args()
    tried: Counter[str] = Counter()
    wrong: Counter[str] = Counter()
    end = monotonic() + 60.0 * asked.minutes
    with tempfile.TemporaryDirectory(prefix="fuzzed-") as name:
        for case in all_cases(asked.seed, Path(name), asked.kinds):
            if monotonic() > end or sum(tried.values()) >= asked.most:
                break
            if asked.only in case.kind and asked.match in case.name:
                tried[case.kind] += 1
                wrong[case.kind] += try_and_tell(case)
    for kind in sorted(tried):
        print(f"{kind:<28} {tried[kind]:>7} tried {wrong[kind]:>5} wrong")
    print(f"{'all':<28} {tried.total():>7} tried {wrong.total():>5} wrong")
    return 1 if wrong.total() else 0


def try_and_tell(case: Case) -> bool:
    """Try a case; whether something is wrong, which is printed."""
    complaint = complaint_of(case)
    if complaint:
        print(f"{case.kind}: {visible(case.name)}\n    {complaint}")
        sys.stdout.flush()
    return bool(complaint)


def visible(text: str) -> str:
    """A name that a terminal shows and does not obey."""
    return text.encode("unicode_escape").decode("ascii")


if __name__ == "__main__":
    raise SystemExit(main())
