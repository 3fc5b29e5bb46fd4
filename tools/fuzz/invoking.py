"""Commands, run in this process."""

import json
import os
import shlex
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any
from unittest.mock import patch

from click.testing import CliRunner

from stepaside.cli.main import main

from .case import Case, Hang, Reached, told, watched

STATUSES = (0, 1, 2, 130)


class Pool:
    """Worker pool that raises ``Reached`` instead of working."""

    def __enter__(self) -> "Pool":
        """Return the pool."""
        return self

    def __exit__(self, *_: Any) -> None:
        """Do nothing."""

    def submit(self, *_: Any) -> None:
        """Raise: work would begin."""
        raise Reached

    map = submit


@contextmanager
def without_work() -> Iterator[None]:
    """Raise ``Reached`` where campaigns and servers would begin."""
    from stepaside.report.viewer import (
        live_page as page,
    )
    from stepaside.report.viewer import (
        replay_viewer as replaying,
    )
    from stepaside.report.viewer.page_address import listen

    def would_serve(host: str, port: int) -> None:
        listen(host, port).listening.close()
        raise Reached

    with ExitStack() as stack:
        for place, name, instead in (
            ("stepaside.core.worker_pool", "worker_pool", lambda *_: Pool()),
            (page.__name__, "open_server", would_serve),
            (replaying.__name__, "open_server", would_serve),
        ):
            stack.enter_context(patch(f"{place}.{name}", instead))
        yield


def spelled(words: list[str]) -> str:
    """Return a command line quoted for a shell; shorten long arguments."""
    return " ".join(
        shlex.quote(w) if len(w) < 90 else f"{w[:40]!r}...({len(w)})"
        for w in words
    )


def command_case(
    kind: str, words: list[str], *, refused: bool, deadline: float = 3.0
) -> Case:
    """Return a case of one command line.

    Args:
        kind: Class that the case is counted in.
        words: Arguments of the command line.
        refused: Whether an argument is out of range.
        deadline: Time after which the command is interrupted, in [s].
    """

    def run(folder: Path) -> str:
        return _judge(folder, words, refused, deadline)

    return Case(kind, f"stepaside {spelled(words)}", run)


def prepare(folder: Path) -> set[str]:
    """Create the files that bad paths lead to; return their names."""
    (folder / "file").write_text("kept")
    (folder / "folder").mkdir()
    (folder / "loop").symlink_to("loop")
    (folder / "dangling").symlink_to("nowhere/there")
    os.mkfifo(folder / "fifo")
    return {path.name for path in folder.iterdir()}


def _judge(
    folder: Path, words: list[str], refused: bool, deadline: float
) -> str:
    there = prepare(folder)
    try:
        with without_work(), watched(deadline) as clock:
            result = CliRunner().invoke(main, words)
    except Reached:
        return "accepted nonsense: work began" if refused else ""
    except Hang:
        return "hang"
    error = result.exception
    if error is not None and not isinstance(error, SystemExit):
        if isinstance(error, Reached):
            return "accepted nonsense: work began" if refused else ""
        return f"traceback: {told(error)}"
    now = {str(p.relative_to(folder)) for p in folder.rglob("*")}
    left = sorted(now - there)
    if there - now or (folder / "file").read_text() != "kept":
        return f"lost: {sorted(there - now) or 'file'}"
    if clock.interrupted and not result.output.strip():
        return f"hang: no word in {deadline:g} s (status {result.exit_code})"
    if result.exit_code not in STATUSES:
        return f"status {result.exit_code}: {result.output[-200:]!r}"
    if refused and result.exit_code == 0:
        return f"accepted nonsense: {result.output[:200]!r}"
    if result.exit_code == 2 and not clock.interrupted:
        said = result.stderr
        if not _is_refusal(said):
            return f"more than a line: {said[:300]!r}"
        if left:
            return f"leftovers: {left}"
    if any(".draft-" in name for name in left):
        return f"leftovers: {left}"
    if result.exit_code == 0 and "--json" in words and not clock.interrupted:
        return _bad_json(result.stdout)
    return ""


def _is_refusal(said: str) -> bool:
    """Return whether a text is one line, after at most a few log lines."""
    lines = said.splitlines()
    ours = all(line.startswith("stepaside: ") for line in lines[:-1])
    return 1 <= len(lines) <= 3 and ours and len(said) <= 2000


def _bad_json(text: str) -> str:
    def refuse(constant: str) -> None:
        raise ValueError(f"it holds {constant}")

    try:
        json.loads(text, parse_constant=refuse)
    except ValueError as error:
        return f"no JSON: {error}: {text[:120]!r}"
    return ""
