"""Damaged run folders."""

import json
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
from click.testing import CliRunner

from stepaside.cli.main import main
from stepaside.core.errors import StepAsideError
from stepaside.games.run_archive import (
    CHECKSUMS,
    CONFIGURATION,
    SUMMARY,
    TRAJECTORIES,
)
from stepaside.games.run_archive import load_run as load

from .case import Case
from .invoking import command_case
from .values import any_value

FILES = (CONFIGURATION, SUMMARY, TRAJECTORIES)
Damage = Callable[[Path, Random], None]


def folder_cases(random: Random, run: Path) -> Iterator[Case]:
    """Yield damaged run folders without end, reproducible by seed.

    Args:
        random: Draws the damage.
        run: Intact run folder.
    """
    while True:
        seed = random.getrandbits(32)
        name = random.choice(list(DAMAGES))
        yield _case(run, name, seed)


def _case(run: Path, name: str, seed: int) -> Case:
    def try_it(folder: Path) -> str:
        damaged = folder / "run"
        shutil.copytree(run, damaged)
        draw = Random(seed)
        if draw.random() < 0.8:  # what comes behind the checksums counts
            (damaged / CHECKSUMS).unlink()
        DAMAGES[name](damaged, draw)
        before = {path.name for path in damaged.iterdir()}
        try:
            load(damaged)
        except StepAsideError as error:
            said = str(error)
            if len(said) > 2000:
                return f"more than a line: {said[:200]!r}"
        else:
            return "" if draw.random() > 0.1 else _pages(folder)
        result = CliRunner().invoke(main, ["compare", "run"])
        if result.exit_code != 2 or result.output.count("\n") != 1:
            return f"status {result.exit_code}: {result.output[:200]!r}"
        left = {path.name for path in folder.iterdir()} - {"run"}
        left |= {path.name for path in damaged.iterdir()} - before
        return f"leftovers: {left}" if left else ""

    return Case("damaged folders", f"{name}, seed {seed}", try_it)


def _pages(folder: Path) -> str:
    """Replay a run that is read in spite of the damage, in all ways."""
    words = ["replay", "run", "--html=page.html", "--json"]
    case = command_case("", words, refused=False)
    (folder / "case").mkdir()
    shutil.move(folder / "run", folder / "case" / "run")
    import os

    os.chdir(folder / "case")
    return case.run(folder / "case")


def _file(folder: Path, draw: Random) -> Path:
    return folder / draw.choice(FILES)


def cut(folder: Path, draw: Random) -> None:
    """Truncate a file."""
    file = _file(folder, draw)
    raw = file.read_bytes()
    file.write_bytes(raw[: draw.randrange(len(raw))])


def flip(folder: Path, draw: Random) -> None:
    """Flip some bits."""
    file = _file(folder, draw)
    raw = bytearray(file.read_bytes())
    for _ in range(draw.choice([1, 1, 2, 50])):
        raw[draw.randrange(len(raw))] ^= 1 << draw.randrange(8)
    file.write_bytes(bytes(raw))


def blank(folder: Path, draw: Random) -> None:
    """Zero a block, like a file system that lost one."""
    file = _file(folder, draw)
    raw = bytearray(file.read_bytes())
    begin = draw.randrange(len(raw))
    end = min(len(raw), begin + draw.choice([1, 16, 512, 4096]))
    raw[begin:end] = bytes(end - begin)
    file.write_bytes(bytes(raw))


def swap(folder: Path, draw: Random) -> None:
    """Swap the contents of two files."""
    one, other = draw.sample(FILES, 2)
    (folder / one).rename(folder / "x")
    (folder / other).rename(folder / one)
    (folder / "x").rename(folder / other)


def lose(folder: Path, draw: Random) -> None:
    """Remove a file, or replace it by a folder."""
    file = _file(folder, draw)
    file.unlink()
    if draw.random() < 0.5:
        file.mkdir()


def array(folder: Path, draw: Random) -> None:
    """Replace an array by one of another shape, type or content."""
    with np.load(folder / TRAJECTORIES) as stored:
        arrays: dict[str, Any] = {n: stored[n] for n in stored.files}
    name = draw.choice(sorted(arrays))
    old = arrays[name]
    made: list[Callable[[], Any]] = [
        *(lambda: old[:-1], lambda: old.ravel(), lambda: old[None]),
        *(lambda: old.astype(complex), lambda: old.astype("<U5")),
        *(lambda: old.astype(int), lambda: old > 0, lambda: np.zeros(0)),
        *(lambda: np.zeros((0, 3)), lambda: old * np.nan, lambda: old * 1e300),
        *(lambda: np.array(None), lambda: -old, lambda: old * 0.0),
        *(lambda: old.astype(">f8"), lambda: old.astype("f4")),
        *(lambda: np.asfortranarray(old), lambda: _spoilt(old, draw)),
    ]
    arrays[name] = draw.choice(made)()
    if draw.random() < 0.2:
        arrays[draw.choice(["strange", name + "x", "a/b", "../x"])] = old
    np.savez(folder / TRAJECTORIES, allow_pickle=True, **arrays)


def _spoilt(old: Any, draw: Random) -> Any:
    new = old.copy()
    if new.size:
        value = draw.choice([np.nan, np.inf, 1e300, -1e18, 5e-324])
        new.flat[draw.randrange(new.size)] = value
    return new


def entry(folder: Path, draw: Random) -> None:
    """Replace or remove an entry of the summary."""
    plain = json.loads((folder / SUMMARY).read_text(encoding="utf-8"))
    place = plain
    while True:
        key = draw.choice(sorted(place))
        if not isinstance(place[key], dict) or draw.random() < 0.3:
            break
        place = place[key]
    value = any_value(draw)
    if isinstance(value, int) and abs(value) > 2**64:
        value = 10**300
    try:
        json.dumps(value)
    except (TypeError, ValueError):
        value = ["x" * draw.choice([1, 999])]
    if draw.random() < 0.2:
        del place[key]
    else:
        place[key] = value
    (folder / SUMMARY).write_text(json.dumps(plain), encoding="utf-8")


def nested(folder: Path, draw: Random) -> None:
    """Write deeply nested brackets."""
    count = draw.choice([10, 900, 100_000])
    text = {0: "[" * count, 1: '{"a":' * count, 2: "a = " + "[" * count}
    _file(folder, draw).write_text(text[draw.randrange(3)])


DAMAGES: dict[str, Damage] = {
    each.__name__: each
    for each in (cut, flip, blank, swap, lose, array, entry, nested)
}
