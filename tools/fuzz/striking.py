"""Faults injected at a file operation of a command."""

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

# One hook for all, since a process that has one keeps it.
_watching: list["Strike"] = []
_hooked: list[bool] = []


class Strike:
    """Counter of file operations below a folder, which acts at one of them.

    Attributes:
        touched: Audit events so far.
        done: Files moved into place before the action.
    """

    def __init__(
        self, place: Path, number: int | None, act: Callable[[], None]
    ) -> None:
        """Arm the action.

        Args:
            place: Folder to watch.
            number: Index of the operation before which to act; None for none.
            act: Action.
        """
        self._place, self._number, self._act = str(place), number, act
        self.touched: list[str] = []
        self.done: set[str] = set()

    def hear(self, event: str, arguments: tuple[Any, ...]) -> None:
        """Count a file operation that is about to happen."""
        if not any(self._is_below(value) for value in arguments):
            return
        self.touched.append(event)
        number = len(self.touched) - 1
        if event == "os.rename" and (self._number or number + 1) > number:
            self.done.add(os.fspath(arguments[1]))
        if number == self._number:
            self._act()

    def has_done(self, path: Path) -> bool:
        """Return whether a file or folder was in place before the action."""
        return any(Path(file).is_relative_to(path) for file in self.done)

    def _is_below(self, value: Any) -> bool:
        if isinstance(value, os.PathLike):
            value = os.fspath(value)
        if isinstance(value, bytes):
            value = os.fsdecode(value)
        return isinstance(value, str) and value.startswith(self._place)


@contextmanager
def struck(strike: Strike) -> Iterator[Strike]:
    """Pass the audit events of this process to a strike."""
    if not _hooked:
        sys.addaudithook(_hear)
        _hooked.append(True)
    _watching.append(strike)
    try:
        yield strike
    finally:
        _watching.clear()


def _hear(event: str, arguments: tuple[Any, ...]) -> None:
    if not _watching or event.startswith("object."):
        return
    strike = _watching.pop()  # it does not hear what it does itself
    try:
        strike.hear(event, arguments)
    finally:
        _watching.append(strike)
