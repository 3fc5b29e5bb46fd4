"""Run mutation tests: ``python -m tools.mutation --help``."""

import argparse
import os
from hashlib import sha256
from pathlib import Path
from typing import Any

from stepaside.studies.result_store import ResultStore

from .again import survivors_of, write_noticed
from .campaign import record_reach, try_faults
from .child import warm_up
from .faults import Fault, draw, faults_of, modules_of
from .mention import Index
from .places import optional_keywords
from .score import (
    CAP,
    PACKAGES,
    REASONS,
    RESULTS,
    SAMPLE,
    head,
    read_reasons,
    score_line,
    summary,
    write,
)
from .source import Source
from .tree import Tree, digest, files_of

FOLDERS = [f"src/stepaside/{package}" for package in PACKAGES]
WORK = Path("runs/mutation")
OWN = "test_mutation*.py"  # tests in these files do not concern faults


def main() -> None:
    """Run the command line."""
    options = _options()
    root: Path = options.root
    files = files_of(root)
    texts = {
        file: (root / file).read_text(encoding="utf-8")
        for file in modules_of(root, options.only or FOLDERS)
    }
    count = None if options.all else options.sample
    faults = _drawn(root, texts, count, options.seed)
    if options.again:
        faults = survivors_of(root / RESULTS, faults)
    version = digest(
        root, [f for f in files if f.parts[0] in ("src", "tests")]
    )
    chosen = options.tests or [
        file.as_posix()
        for file in files
        if file.match("tests/test_*.py") and not file.match(OWN)
    ]
    name = "-".join(["trials", version, f"{options.cap:g}"])
    if options.tests:
        own = sha256(" ".join(chosen).encode()).hexdigest()[:12]
        name += f"-{own}"
    records = ResultStore(root / WORK / name)
    # Computed first: the code may change before the run ends.
    where_from = head(
        sample=options.sample, seed=options.seed, cap=options.cap
    )
    if not options.list_survivors:
        _try(root, records, faults, texts, chosen, options)
    rows, reasons = records.read(), read_reasons(root / REASONS)
    found = summary(
        [rows[fault.key] for fault in faults if fault.key in rows], reasons
    )
    for row in found["survivors"]:
        print(f"{row['file']}:{row['line']} {row['before']} => {row['after']}")
    print(score_line(found))
    if options.write and options.again:
        noticed = write_noticed(root / RESULTS, rows, reasons)
        print(f"{noticed} survivors of the run are noticed now")
    elif options.write:
        write(root / RESULTS, where_from, found)


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m tools.mutation")
    add = parser.add_argument
    add("--only", nargs="+", metavar="PATH", help="folders or files to change")
    add("--tests", nargs="+", metavar="FILE", help="files of tests to run")
    add("--sample", type=int, default=SAMPLE, metavar="N")
    add("--all", action="store_true", help="every fault, not a sample")
    add("--seed", type=int, default=1, metavar="S")
    add("--jobs", type=int, default=os.cpu_count(), metavar="N")
    add(
        "--cap",
        type=float,
        default=CAP,
        metavar="SECONDS",
        help="processor time of the tests that one fault may take",
    )
    add("--list-survivors", action="store_true", help="of earlier runs")
    add(
        "--again",
        action="store_true",
        help="only survivors of what is written",
    )
    add("--write", action="store_true", help="write the file of results")
    add("--root", type=Path, default=Path(__file__).parents[2])
    options = parser.parse_args()
    given = [
        f"--{name}"
        for name in ("only", "tests", "all", "seed", "root")
        if getattr(options, name) != parser.get_default(name)
    ]
    if options.write and given:
        parser.error(
            f"--write is for the run of make mutate, not for {given[0]}"
        )
    return options


def _drawn(
    root: Path, texts: dict[str, str], count: int | None, seed: int
) -> list[Fault]:
    optional = optional_keywords(
        Source(path.read_text(encoding="utf-8")).tree
        for path in (root / "src").rglob("*.py")
    )
    faults = (
        fault
        for file, text in texts.items()
        for fault in faults_of(file, text, optional, seed)
    )
    return draw(faults, texts, count, seed)


def _try(
    root: Path,
    records: ResultStore,
    faults: list[Fault],
    texts: dict[str, str],
    tests: list[str],
    options: argparse.Namespace,
) -> None:
    """Try all faults without a record."""
    warm_up(root)
    work = records.folder.parent
    work.mkdir(parents=True, exist_ok=True)
    known = records.read()
    todo = [fault for fault in faults if fault.key not in known]
    if not todo:
        return
    trees = [
        Tree(root, work / f"tree-{number}", set(texts))
        for number in range(options.jobs)
    ]
    index = Index(root, record_reach(root, trees, tests, work))
    trials = try_faults(todo, texts, index, trees, options.cap)
    with records.writer() as writer:
        for number, row in enumerate(trials, 1):
            writer.append([(row["key"], row)])
            print(f"{number}/{len(todo)} {_told(row)}", flush=True)


def _told(row: dict[str, Any]) -> str:
    where = f"{row['file']}:{row['line']}"
    change = f"{row['before']} => {row['after']}"
    return f"{row['outcome']}: {where} {change} {row['test']}".strip()


if __name__ == "__main__":
    main()
