"""Scratch copies of a working tree, which itself is never changed."""

import os
import shutil
from hashlib import sha256
from pathlib import Path

# An edit without effect: a test that it turns red checks the text of a
# file, not its behaviour.
NEUTRAL = "\n...\n"
SKIPPED = {"__pycache__", "runs", "build", "dist", "artefacts", "node_modules"}


def files_of(root: Path) -> list[Path]:
    """Return the files that copies of a tree need, relative to it."""
    found = []
    for folder, folders, files in os.walk(root):
        folders[:] = sorted(
            name
            for name in folders
            if name not in SKIPPED and not name.startswith(".")
        )
        found += [Path(folder, name).relative_to(root) for name in files]
    return sorted(found)


def digest(root: Path, files: list[Path]) -> str:
    """Return a hash of some files of a tree."""
    total = sha256()
    for file in files:
        total.update(f"{file.as_posix()}\n".encode())
        total.update((root / file).read_bytes())
    return total.hexdigest()[:12]


class Tree:
    """Scratch copy of a tree in which one file at a time is changed.

    Args:
        root: Tree to copy.
        path: Folder of the copy, synchronised with the tree.
        changeable: Python files that may be changed, relative to the tree.
    """

    def __init__(self, root: Path, path: Path, changeable: set[str]) -> None:
        self.path = path
        self._changed: tuple[Path, bytes, os.stat_result] | None = None
        wanted = files_of(root)
        if path.exists():
            for file in set(files_of(path)) - set(wanted):
                (path / file).unlink()
        for file in wanted:
            text = (root / file).read_bytes()
            if file.as_posix() in changeable:
                text += NEUTRAL.encode()
            copy = path / file
            if not copy.exists() or copy.read_bytes() != text:
                copy.parent.mkdir(parents=True, exist_ok=True)
                copy.write_bytes(text)
                shutil.copymode(root / file, copy)

    def change(self, file: str, text: str) -> None:
        """Replace the text of a file."""
        path = self.path / file
        self._changed = path, path.read_bytes(), path.stat()
        path.write_text(text + NEUTRAL, encoding="utf-8")

    def restore(self) -> None:
        """Restore changed files and their times, so caches stay valid."""
        if self._changed is not None:
            path, data, stat = self._changed
            path.write_bytes(data)
            os.utime(path, ns=(stat.st_atime_ns, stat.st_mtime_ns))
            self._changed = None
