"""Test the fingerprints that results are kept under."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from stepaside.studies import version
from stepaside.studies.version import PHYSICS, code_version, library_versions


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Small package in place of this one."""
    (tmp_path / "room").mkdir()
    (tmp_path / "room" / "a.py").write_text('"""Doc."""\nX = 1\n')
    (tmp_path / "room" / "b.toml").write_text("y = 1\n")
    (tmp_path / "other.py").write_text("Z = 1\n")
    monkeypatch.setattr(version, "ROOT", tmp_path)
    code_version.cache_clear()
    yield tmp_path
    code_version.cache_clear()


def fingerprint(*rooms: str) -> str:
    code_version.cache_clear()
    return code_version(rooms)


@pytest.mark.parametrize(
    ("file", "text", "moves"),
    [
        ("room/a.py", '"""Other doc."""\n# why\nX  =  1\n', False),
        ("room/a.py", '"""Doc."""\nX = 2\n', True),
        ("room/b.toml", "y = 2\n", True),
        ("room/c.py", "", True),
        ("other.py", "Z = 2\n", False),
    ],
)
def test_only_what_the_room_does_moves_its_version(
    package: Path, file: str, text: str, moves: bool
) -> None:
    before = fingerprint("room")
    (package / file).write_text(text)
    assert (fingerprint("room") != before) is moves


def test_a_room_that_is_not_there_is_named(package: Path) -> None:
    with pytest.raises(FileNotFoundError, match="'attic'"):
        fingerprint("attic")


def test_every_room_of_physics_has_a_version() -> None:
    assert len(code_version(PHYSICS)) == 12


def test_a_library_that_is_not_there_has_no_version() -> None:
    found = library_versions(["numpy", "no-such-library"])
    assert found["numpy"] and found["no-such-library"] is None
