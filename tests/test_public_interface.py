"""Public functions accept any kind of path, and only finite angles."""

import os
from collections.abc import Callable, Iterator
from functools import cache
from importlib import import_module
from inspect import getdoc, getmembers, isclass, signature
from math import inf, nan, pi, tau
from pathlib import Path
from pkgutil import walk_packages
from re import split
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pytest

import stepaside
from stepaside import Direction, Foot, GaitSettings, RelativeStart, Run, duel
from stepaside.arena import Box, MovingBox, Room, load_room
from stepaside.core.errors import StepAsideError
from stepaside.core.poses import Pose
from stepaside.envs import ParallelGame
from stepaside.strategies.learned import (
    LearnedStrategy,
    StrategyContract,
    dense_network,
)
from stepaside.studies import (
    Study,
    StudyRun,
    load_study,
    merge_results,
    run_study,
)
from stepaside.theory.value import CarGame, load_table, solve_cars


@cache
def a_run() -> Run:
    return stepaside.run_game(duel(seed=3, duration=0.4))


@cache
def a_bound() -> Any:
    game = CarGame(1.0, 1.0, pursuer_gain=1.0)
    return solve_cars(game, 4.0, 8, horizon=0.1)


@cache
def a_plan() -> Any:
    return plan(0.3)


def plan(bearing: Any) -> Any:
    return stepaside.ManeuverPlanner(GaitSettings()).plan(
        bearing, Direction.BACKWARD, first_foot=Foot.LEFT, standing=True
    )


DOORS = [
    "stepaside",
    *(m.name for m in walk_packages(stepaside.__path__, "stepaside.")),
]


PATH_NAMES = ("path", "file", "folder")


def callables() -> Iterator[tuple[str, Any]]:
    """Every function, class and method at a door, by its name there."""
    for door in DOORS:
        # The latter is of a library that the project does not install.
        if "__main__" in door or door.endswith(".stable_baselines"):
            continue
        package = import_module(door)
        if not hasattr(package, "__path__"):
            continue
        for name in getattr(package, "__all__", ()):
            found = getattr(package, name)
            if callable(found):
                yield name, found
            if isclass(found):
                for key, method in getmembers(found, callable):
                    if not key.startswith("_"):
                        yield f"{name}.{key}", method


def paths_at_the_doors() -> set[str]:
    """Functions at the doors with an argument that is a path."""
    found = set()
    for name, called in callables():
        try:
            arguments = signature(called).parameters.values()
        except ValueError:
            continue
        for one in arguments:
            kind = str(one.annotation)
            is_path = "Path" in kind or one.name in PATH_NAMES
            if is_path and "RobotDescription" not in name:
                found.add(name)
    return found


def a_network() -> LearnedStrategy:
    """Return an evader whose network does nothing yet."""
    contract = StrategyContract(Direction.BACKWARD, ("bearing",), (0.0, None))
    layer = np.zeros((2, 2)), np.zeros(2)
    return LearnedStrategy(dense_network([layer]), contract)


class Place:
    """A path that is neither text nor a ``pathlib.Path``."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def __fspath__(self) -> str:
        return str(self.path)


@pytest.fixture(scope="module")
def kept(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with one of everything that is read."""
    folder = tmp_path_factory.mktemp("kept")
    stepaside.write_run(folder / "run", a_run(), drawn=False)
    (folder / "duel.toml").write_text("game = 'duel'\nseed = 3\n")
    (folder / "study.toml").write_text("game = 'duel'\ngrid.seed = '0:7'\n")
    (folder / "room.toml").write_text("width = 3.0\ndepth = 2.0\n")
    a_bound().save(folder / "bound.npz")
    nao = stepaside.load_robot("nao").folder
    (folder / "robot").symlink_to(nao, target_is_directory=True)
    return folder


# What is read, and what of it must be the same whatever the path was.
READERS: dict[str, tuple[str, Callable[[Any], Any]]] = {
    "load_run": ("run", lambda p: stepaside.load_run(p).summary),
    "load_game": ("duel.toml", stepaside.load_game),
    "ParallelGame": ("duel.toml", lambda p: ParallelGame(p).settings),
    "load_robot": ("robot", lambda p: stepaside.load_robot(p).torso),
    "load_table": ("bound.npz", lambda p: load_table(p).grid),
    "load_room": ("room.toml", load_room),
    "load_study": ("study.toml", lambda p: len(load_study(p).cases)),
}


def a_study() -> Study[Any]:
    """Return a study of one case."""
    return Study("one", [1], lambda case: {"case": case}, str)


def merge_one(file: Any) -> None:
    """Merge a file of one record."""
    with TemporaryDirectory() as folder:
        run_study(a_study(), f"{folder}/part.sqlite")
        merge_results([f"{folder}/part.sqlite"], file)


# What is written: the name of the file or folder, and how.
WRITERS: dict[str, tuple[str, Callable[[Any], Any]]] = {
    "write_run": (
        "run",
        lambda p: stepaside.write_run(p, a_run(), drawn=False),
    ),
    "StudyRun": ("study.sqlite", lambda p: StudyRun(a_study(), p)),
    "StudyRun.draw": (
        "study.svg",
        lambda p: run_study(a_study()).draw(p, "case"),
    ),
    "run_study": ("study.sqlite", lambda p: run_study(a_study(), p)),
    "merge_results": ("study.sqlite", merge_one),
    "write_page": ("page.html", lambda p: stepaside.write_page(a_run(), p)),
    "draw_run": ("duel.svg", lambda p: stepaside.draw_run(a_run(), p)),
    "draw_runs": ("both.svg", lambda p: stepaside.draw_runs([a_run()], p)),
    "draw_plan": (
        "plan.svg",
        lambda p: stepaside.draw_plan(a_plan(), "evader", p),
    ),
    "ValueTable.save": ("bound.npz", lambda p: a_bound().save(p)),
    "LearnedStrategy.save": ("one.onnx", lambda p: a_network().save(p)),
}


def test_every_path_at_a_door_is_tried() -> None:
    assert paths_at_the_doors() == {*READERS, *WRITERS}


@pytest.mark.parametrize("name", READERS)
def test_any_kind_of_path_is_read(name: str, kept: Path) -> None:
    file, read = READERS[name]
    expected = read(kept / file)
    assert read(str(kept / file)) == expected
    assert read(Place(kept / file)) == expected


@pytest.mark.parametrize("name", WRITERS)
@pytest.mark.parametrize("kind", [str, Place])
def test_any_kind_of_path_is_written(
    name: str, kind: Callable[[Path], Any], tmp_path: Path
) -> None:
    file, write = WRITERS[name]
    write(kind(tmp_path / file))
    assert os.listdir(tmp_path) == [file]


@pytest.mark.parametrize("name", [*READERS, *WRITERS])
@pytest.mark.parametrize("bad", [None, 5, b"bytes", ["list"], "null\0"])
def test_what_is_no_path_is_refused_by_name(name: str, bad: Any) -> None:
    if bad is None and name in ("StudyRun", "run_study"):
        return  # without a file nothing is stored
    _, call = {**READERS, **WRITERS}[name]
    with pytest.raises(StepAsideError, match="(path|file|folder|robot) must"):
        call(bad)


# A bearing or direction at a door, by function and argument.
ANGLES: dict[str, Callable[[Any], Any]] = {
    "ManeuverPlanner.plan bearing": plan,
    "Intent heading": stepaside.Intent,
    "Walk bearing": stepaside.strategies.Walk,
    "Knowledge bearing": lambda a: stepaside.Knowledge(
        0.0, a, 1.0, stepaside.strategies.Limits(0.1, 0.2, 0.04, 0.4)
    ),
    "StrategyContract headings": lambda a: StrategyContract(
        Direction.BACKWARD, ("bearing",), (a,)
    ),
    "Evasion angle": stepaside.Evasion,
    "Evasion side_hysteresis": lambda a: stepaside.Evasion(side_hysteresis=a),
    "RelativeStart pursuer_error": lambda a: RelativeStart(1.0, a),
    "RelativeStart bearing": lambda a: RelativeStart(1.0, 0.0, a),
    "StartSettings pursuer_offset": lambda a: stepaside.StartSettings(1.0, a),
    "StartSettings evader_offset": lambda a: stepaside.StartSettings(
        1.0, 0.0, a
    ),
    "walk bearing": stepaside.walk,
    "Push direction": lambda a: stepaside.Push(1.0, 1.0, a),
    "Unicycles angle": lambda a: stepaside.Unicycles(1.0, 1.0, 1.0, 1.0, a),
    "Unicycles hysteresis": lambda a: stepaside.Unicycles(
        1.0, 1.0, 1.0, 1.0, hysteresis=a
    ),
    "play_games starts": lambda a: stepaside.play_games(
        stepaside.Unicycles(1.0, 1.0, 1.0, 1.0), [[1.0, a, 0.0]], 0.1
    ),
    "Box heading": lambda a: Box(0.0, 0.0, 1.0, 1.0, a),
    "MovingBox heading": lambda a: MovingBox(
        0.0, 0.0, 1.0, 1.0, (1.0, 0.0), heading=a
    ),
    "Room starts": lambda a: Room(
        starts=(Pose(0.0, 0.0, a), Pose(1.0, 0.0, 0.0))
    ),
}


@pytest.mark.parametrize("name", ANGLES)
@pytest.mark.parametrize("angle", [-50.0, 7.0, 180.0, nan, inf, True, "1"])
def test_what_cannot_be_a_bearing_is_refused_with_its_unit(
    name: str, angle: Any
) -> None:
    """Degrees passed as radians, NaN and infinities."""
    in_rows = name.startswith(("play_games", "Bound"))
    if in_rows and (angle is True or angle == "1"):
        return  # an array turns them into numbers
    with pytest.raises(StepAsideError, match=r"\[rad\]|finite"):
        ANGLES[name](angle)


@pytest.mark.parametrize("name", ANGLES)
def test_a_bearing_is_taken(name: str) -> None:
    ANGLES[name](0.4)


@pytest.mark.parametrize("angle", [pi, -pi, 1.5 * pi, tau, -tau])
def test_a_whole_turn_either_way_is_a_bearing(angle: float) -> None:
    assert plan(angle).bearing == angle
    assert stepaside.Intent(angle).heading == angle
    assert RelativeStart(1.0, angle, -angle).bearing == -angle


def is_asked_for(name: str, key: str, text: str) -> bool:
    """Whether an argument is an angle that a caller decides."""
    words = ("bearing", "heading", "direction", "angle", "offset", "error")
    return "[rad]" in text and any(word in f"{name} {key}" for word in words)


def test_every_angle_at_a_door_is_tried() -> None:
    """Values of results and reports of robots are not checked."""
    left_out = (  # results, readings, and arrays of the compiled search
        *("Circle", "Outcomes", "Run", "Track", "ManeuverPlan "),
        *("Sighting", "RobotState", "BodySettings"),
        *("Maneuvers ", "JointTargets ", "ShieldGame "),
    )
    found = set()
    for name, called in callables():
        try:
            arguments = signature(called).parameters
        except ValueError:
            continue
        for entry in split("\n    (?=\\w+:)", getdoc(called) or "")[1:]:
            key, _, text = entry.partition(":")
            if key in arguments and is_asked_for(name, key, text):
                found.add(f"{name} {key}")
    left = {
        one
        for one in found - set(ANGLES)
        if not any(word in one for word in left_out)
    }
    assert found and not left
