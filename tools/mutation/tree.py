"""Scratch copies of a working tree, so that no checkout is ever touched."""

import os
import shutil
from hashlib import sha256
from pathlib import Path

# Changes the code and nothing that it does: a test that turns red by this
# guards the text of a file and says nothing about behaviour.
NEUTRAL = "\n...\n"
SKIPPED = {"__pycache__", "runs", "build", "dist", "artefacts", "node_modules"}


def files_of(root: Path) -> list[Path]:
    """Files of a tree that its copies need, relative to it."""
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
    """Fingerprint of some files of a tree."""
    total = sha256()
    for file in files:
        total.update(f"{file.as_posix()}\n".encode())
        total.update((root / file).read_bytes())
    return total.hexdigest()[:12]


class Tree:
    """Scratch copy of a tree in which one file at a time is changed.

    Args:
        root: Tree to copy.
        path: Folder of the copy, brought up to date with the tree.
        changeable: Python files that will be changed, relative to the tree.
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
        """Put another text in a file."""
        path = self.path / file
        self._changed = path, path.read_bytes(), path.stat()
        path.write_text(text + NEUTRAL, encoding="utf-8")

    def restore(self) -> None:
        """Put back what was changed, times and all, so that caches hold."""
        if self._changed is not None:
            path, data, stat = self._changed
            path.write_bytes(data)
            os.utime(path, ns=(stat.st_atime_ns, stat.st_mtime_ns))
            self._changed = None
