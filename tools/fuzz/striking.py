"""Strike at a command's place when it comes to touch a file there."""

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
    """Counts what is done to files below a folder, and acts at one of them.

    Attributes:
        touched: What was done so far, by the names that the system has.
        done: What was moved into place before it acted.
    """

    def __init__(
        self, place: Path, number: int | None, act: Callable[[], None]
    ) -> None:
        """Wait.

        Args:
            place: Folder that is watched.
            number: Of the touch before which to act, from 0; None never acts.
            act: What to do.
        """
        self._place, self._number, self._act = str(place), number, act
        self.touched: list[str] = []
        self.done: set[str] = set()

    def hear(self, event: str, arguments: tuple[Any, ...]) -> None:
        """Take note of something that the process is about to do."""
        if not any(self._is_below(value) for value in arguments):
            return
        self.touched.append(event)
        number = len(self.touched) - 1
        if event == "os.rename" and (self._number or number + 1) > number:
            self.done.add(os.fspath(arguments[1]))
        if number == self._number:
            self._act()

    def has_done(self, path: Path) -> bool:
        """Whether a file, or one in a folder, was in place before it acted."""
        return any(Path(file).is_relative_to(path) for file in self.done)

    def _is_below(self, value: Any) -> bool:
        if isinstance(value, os.PathLike):
            value = os.fspath(value)
        if isinstance(value, bytes):
            value = os.fsdecode(value)
        return isinstance(value, str) and value.startswith(self._place)


@contextmanager
def struck(strike: Strike) -> Iterator[Strike]:
    """Let a strike hear what this process does."""
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
