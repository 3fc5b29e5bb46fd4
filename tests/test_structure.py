"""Test the layout: imports point down, names are unique and public."""

import ast
import re
import subprocess
import sys
from collections import Counter
from functools import cache
from graphlib import TopologicalSorter
from importlib import import_module
from pathlib import Path

import pytest

import stepaside

ROOT = Path(stepaside.__file__).parent
# From the bottom up; a package imports from those below it and from itself.
LAYERS = (
    "core",
    "theory",
    "arena",
    "robots",
    "planning",
    "perception",
    "strategies",
    "locomotion",
    "control",
    "drivers",
    "sim",
    "games",
    "report",
    "envs",
    "studies",
    "fitting",
    "cli",
    "__main__",
)
MODULES = sorted(ROOT.rglob("*.py"))


@cache
def parsed(file: Path) -> ast.Module:
    return ast.parse(file.read_text(encoding="utf-8"))


def package_of(file: Path) -> str:
    return file.relative_to(ROOT).with_suffix("").parts[0]


def imported_packages(file: Path) -> set[str]:
    """Packages that a module imports from, anywhere in it."""
    here = file.relative_to(ROOT).with_suffix("").parts
    packages = set()
    for node in ast.walk(parsed(file)):
        if not isinstance(node, ast.ImportFrom) or not node.level:
            continue
        base = here[: len(here) - node.level]
        names = (node.module or "").split(".") if node.module else []
        if base or names:
            packages.add((*base, *names)[0])
        else:
            packages.update(alias.name for alias in node.names)
    return packages


def test_imports_point_down() -> None:
    for file in MODULES:
        package = package_of(file)
        if package == "__init__":
            continue
        for other in imported_packages(file) - {package, "__version__"}:
            assert LAYERS.index(other) < LAYERS.index(package), (
                f"{file} imports {other}"
            )


def imported_modules(file: Path) -> set[Path]:
    """Modules that a module imports, also for type checking or lazily."""
    found = set()
    for node in ast.walk(parsed(file)):
        if isinstance(node, ast.ImportFrom) and node.level:
            names = (node.module or "").split(".") if node.module else []
            target = file.parents[node.level - 1].joinpath(*names)
            found.add(target.with_suffix(".py"))
            found.update(target / f"{alias.name}.py" for alias in node.names)
    return found


def test_modules_import_each_other_without_circles() -> None:
    modules = {file for file in MODULES if file.stem != "__init__"}
    graph = {file: imported_modules(file) & modules for file in modules}
    assert len(list(TopologicalSorter(graph).static_order())) == len(modules)


def test_a_class_name_is_defined_once() -> None:
    defined = Counter(
        node.name
        for file in MODULES
        for node in ast.walk(parsed(file))
        if isinstance(node, ast.ClassDef)
    )
    assert not [name for name, times in defined.items() if times > 1]


def test_a_file_name_recurs_only_for_a_command() -> None:
    """Files of ``cli`` are named after their command."""
    names = Counter(
        file.stem
        for file in MODULES
        if file.stem != "__init__" and file.parent != ROOT / "cli"
    )
    assert not [name for name, times in names.items() if times > 1]


@pytest.mark.parametrize(
    "package", ["planning", "strategies", "control", "games"]
)
def test_every_public_name_exists(package: str) -> None:
    module = import_module(f"stepaside.{package}")
    assert list(module.__all__) == sorted(set(module.__all__))
    for name in module.__all__:
        assert getattr(module, name) is not None


@pytest.mark.parametrize(
    "package",
    [
        *("robots", "planning", "perception", "strategies"),
        *("locomotion", "control", "drivers"),
    ],
)
def test_code_on_board_imports_no_simulator(package: str) -> None:
    """No ground truth can leak in, and MuJoCo need not be installed."""
    files = set((ROOT / package).rglob("*.py"))
    assert files
    # Where a model is compiled and given to the simulator.
    compiling = [
        "geom_points",
        "tree_compiler",
        "description",
        "model_overlay",
        "model_reader",
        "outdated_model",
        "urdf_writer",
    ]
    files -= {ROOT / "robots" / f"{name}.py" for name in compiling}
    for file in files:
        assert not {"sim", "games"} & imported_packages(file), file
        tree = parsed(file)
        for node in ast.walk(tree):
            if not isinstance(node, ast.Import | ast.ImportFrom):
                continue
            names = [alias.name for alias in node.names]
            if isinstance(node, ast.ImportFrom):
                names = [node.module or ""]
            elif not isinstance(node, ast.Import):
                continue
            for heavy in ("mujoco", "matplotlib"):
                assert not any(n.startswith(heavy) for n in names), file


def test_an_ideal_duel_loads_neither_cameras_nor_vision() -> None:
    code = (
        "import sys; from stepaside.games import duel, run_game;"
        "run_game(duel(duration=0.01));"
        "assert 'cv2' not in sys.modules;"
        "assert 'stepaside.sim.sensor_suite' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_the_live_page_loads_no_vision() -> None:
    pytest.importorskip("viser")
    code = (
        "import sys; import stepaside.report.viewer.live_page;"
        "assert 'cv2' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_settings_load_no_heavy_library() -> None:
    """Help and configurations need no physics."""
    code = (
        "import sys; from stepaside import Push, duel, walk;"
        "duel(); walk(pushes=(Push(1.0, 2.0, 0.0),));"
        "assert not {'mujoco', 'scipy', 'matplotlib'} & set(sys.modules);"
        "import stepaside.games as games;"
        "assert callable(games.run_game) and 'mujoco' in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_an_unknown_public_name_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="stepaside.games.*'walk_home'"):
        getattr(import_module("stepaside.games"), "walk_home")  # noqa: B009


def test_games_have_one_loop_one_judge_and_one_arc() -> None:
    """Few files tick a game, read its rules, or compute an arc.

    An environment and a live page tick the game of others, up to a time; the
    compiled batch judges as the game does, and a test compares both.
    """
    doors = {
        r"\bsinc\(": {"core/poses.py"},
        r"game\.tick\(|while .*\.ended": {
            "games/game.py",
            "envs/parallel_games.py",
            "report/viewer/live_session.py",
        },
        r"rules\.(duration|capture|goals)\b": {
            "games/game.py",
            "games/floor_world.py",
            "envs/parallel_games.py",
            "envs/step_batch.py",
        },
    }
    for pattern, wanted in doors.items():
        found = {
            file.relative_to(ROOT).as_posix()
            for file in MODULES
            if re.search(pattern, file.read_text(encoding="utf-8"))
        }
        assert found == wanted, pattern


def test_make_test_leaves_out_no_flow() -> None:
    flows = Path(__file__).parent / "flows"
    for file in flows.glob("*.py"):
        assert "mark.slow" not in file.read_text(encoding="utf-8"), file
