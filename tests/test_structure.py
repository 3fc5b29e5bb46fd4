"""Test that the house stands: imports point down, doors open."""

import ast
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest

import stepaside

ROOT = Path(stepaside.__file__).parent
# From the ground up; a room imports from rooms below it and from itself.
FLOORS = {
    "errors": 0,
    "poses": 1,
    "randomness": 1,
    "unicycle": 2,
    "robots": 2,
    "sensing": 2,
    "planning": 2,
    "perception": 3,
    "strategies": 3,
    "control": 4,
    "world": 5,
    "games": 6,
    "report": 7,
    "studies": 7,
    "commands": 8,
    "cli": 9,
}
MODULES = sorted(ROOT.rglob("*.py"))


def room_of(parts: tuple[str, ...]) -> str:
    return parts[0] if parts else ""


def imported_rooms(file: Path) -> set[str]:
    """Rooms that a module imports from, wherever in it."""
    here = file.relative_to(ROOT).with_suffix("").parts
    rooms = set()
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if not isinstance(node, ast.ImportFrom) or not node.level:
            continue
        base = here[: len(here) - node.level]
        names = (node.module or "").split(".") if node.module else []
        if base or names:
            rooms.add(room_of((*base, *names)))
        else:
            rooms.update(alias.name for alias in node.names)
    return rooms


@pytest.mark.parametrize("file", MODULES, ids=lambda f: f.stem)
def test_imports_point_down(file: Path) -> None:
    room = room_of(file.relative_to(ROOT).with_suffix("").parts)
    if room == "__init__":
        return
    for other in imported_rooms(file) - {room, "__version__"}:
        assert FLOORS[other] < FLOORS[room], f"{file} imports {other}"


@pytest.mark.parametrize("file", MODULES, ids=lambda f: f.stem)
def test_no_file_is_longer_than_300_lines(file: Path) -> None:
    assert len(file.read_text(encoding="utf-8").splitlines()) <= 300


@pytest.mark.parametrize("room", ["planning", "control", "games"])
def test_every_name_at_the_door_exists(room: str) -> None:
    module = import_module(f"stepaside.{room}")
    assert list(module.__all__) == sorted(
        module.__all__, key=lambda name: (not name.isupper(), name)
    )
    for name in module.__all__:
        assert getattr(module, name) is not None


@pytest.mark.parametrize(
    "room", ["sensing", "perception", "strategies", "control"]
)
def test_who_perceives_knows_nothing_of_the_simulator(room: str) -> None:
    """No truth can leak in: neither the world nor MuJoCo is imported."""
    files = sorted((ROOT / room).rglob("*.py"))
    assert files
    for file in files:
        assert not {"world", "games"} & imported_rooms(file), file
        tree = ast.parse(file.read_text(encoding="utf-8"))
        for node in ast.walk(tree):
            names = [a.name for a in getattr(node, "names", [])]
            if isinstance(node, ast.ImportFrom):
                names = [node.module or ""]
            elif not isinstance(node, ast.Import):
                continue
            assert not any(n.startswith("mujoco") for n in names), file


def test_an_ideal_duel_loads_neither_cameras_nor_vision() -> None:
    code = (
        "import sys; from stepaside.games import DuelSettings, run_duel;"
        "run_duel(DuelSettings(duration=0.01));"
        "assert 'cv2' not in sys.modules;"
        "assert 'stepaside.world.eyes' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
