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
    "constants": 0,
    "ranges": 1,
    "workers": 1,
    "laws": 0,
    "poses": 0,
    "values": 0,
    "convex": 0,
    "randomness": 0,
    "rooms": 1,
    "doors": 1,
    "extras": 1,
    "outputs": 1,
    "interrupting": 0,
    "unicycle": 1,
    "bound": 2,
    "steps": 2,
    "robots": 2,
    "sensing": 2,
    "planning": 2,
    "perception": 3,
    "strategies": 3,
    "control": 4,
    "drivers": 5,
    "world": 5,
    "games": 6,
    "fitting": 8,
    "report": 7,
    "studies": 7,
    "commands": 9,
    "cli": 10,
    "__main__": 11,
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
    "room",
    [
        *("robots", "planning", "sensing", "perception", "strategies"),
        *("control", "drivers"),
    ],
)
def test_who_perceives_knows_nothing_of_the_simulator(room: str) -> None:
    """No truth can leak in: neither the world nor MuJoCo is imported."""
    files = set((ROOT / room).rglob("*.py"))
    assert files
    # Where a model is compiled, and handed to the world.
    compiling = ["compiling", "description", "facing", "inertias"]
    compiling += ["meshes", "overlaying", "reading"]
    files -= {ROOT / "robots" / f"{name}.py" for name in compiling}
    for file in files:
        assert not {"world", "games"} & imported_rooms(file), file
        tree = ast.parse(file.read_text(encoding="utf-8"))
        for node in ast.walk(tree):
            if not isinstance(node, ast.Import | ast.ImportFrom):
                continue
            names = [alias.name for alias in node.names]
            if isinstance(node, ast.ImportFrom):
                names = [node.module or ""]
            elif not isinstance(node, ast.Import):
                continue
            for heavy in ("mujoco", "scipy", "matplotlib"):
                assert not any(n.startswith(heavy) for n in names), file


def test_an_ideal_duel_loads_neither_cameras_nor_vision() -> None:
    code = (
        "import sys; from stepaside.games import DuelSettings, run_duel;"
        "run_duel(DuelSettings(duration=0.01));"
        "assert 'cv2' not in sys.modules;"
        "assert 'stepaside.sim.sensor_suite' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_settings_come_through_doors_that_load_nothing_else() -> None:
    """Whoever asks for help or for a configuration waits for no physics."""
    code = (
        "import sys; from stepaside.games.duel_settings import DuelSettings;"
        "DuelSettings();"
        "from stepaside import Push, WalkSettings;"
        "WalkSettings(pushes=(Push(1.0, 2.0, 0.0),));"
        "assert not {'mujoco', 'scipy', 'matplotlib'} & set(sys.modules);"
        "import stepaside.games as games;"
        "assert callable(games.run_duel) and 'mujoco' in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_a_door_has_no_other_names() -> None:
    with pytest.raises(AttributeError, match="stepaside.games.*'walk_home'"):
        getattr(import_module("stepaside.games"), "walk_home")  # noqa: B009
