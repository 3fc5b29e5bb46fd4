"""Test the loading of strategies by name and from files."""

import os
import pickle
import subprocess
import sys
from dataclasses import replace
from math import pi
from pathlib import Path
from typing import Any

import pytest

from stepaside.core.errors import ConfigurationError
from stepaside.games import duel
from stepaside.games.recorded_game import RecordedGame
from stepaside.planning import Direction
from stepaside.strategies import (
    Evasion,
    GoalWalk,
    LookAhead,
    Pursuit,
    Walk,
    load_strategy,
)
from stepaside.strategies.registry import check_strategy_name, file_of

OWN = '''
from dataclasses import dataclass
from math import pi

from stepaside.planning import Direction
from stepaside.strategies import Intent


@dataclass(frozen=True, slots=True)
class Timid:
    """Backs off at half the speed."""

    factor: float | None = 0.5
    direction: Direction = Direction.BACKWARD
    saturated: bool = False

    def begin(self):
        return 0

    def decide(self, knowledge, memory):
        return Intent(knowledge.bearing, self.factor), memory + 1


class Mute(Timid):
    def decide(self, knowledge, memory):
        return 0.3


class Moody(Timid):
    asked = []

    def decide(self, knowledge, memory):
        self.asked.append(1)
        return Intent(0.1 * len(self.asked)), memory


class Broken(Timid):
    def decide(self, knowledge, memory):
        return Intent(1.0 / memory), memory


class Wild(Timid):
    def decide(self, knowledge, memory):
        return Intent(speed_factor=2.0), memory


def sideways():
    return Timid(direction=-1)


class Forgetful:
    direction = Direction.BACKWARD
    saturated = False

    def decide(self, knowledge, memory):
        return Intent(), memory


def vague():
    return Timid(saturated=1)


class Lost(Timid):
    def begin(self):
        raise RuntimeError("no memory")


class Stray(Forgetful):
    @property
    def direction(self):
        raise RuntimeError("where")

    def begin(self):
        return None


timid = Timid(0.25)


def quick():
    return Timid(1.0)


def picky(factor):
    return Timid(factor)


NUMBER = 3
'''


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "own.py"
    path.write_text(OWN, encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("name", "factor"), [("Timid", 0.5), ("timid", 0.25), ("quick", 1.0)]
)
def test_a_file_may_define_a_class_a_value_or_a_factory(
    file: Path, name: str, factor: float
) -> None:
    strategy: Any = load_strategy(f"{file}:{name}")
    assert strategy.factor == factor
    assert strategy.direction is Direction.BACKWARD


@pytest.mark.parametrize(
    ("name", "factor"),
    [
        ("Timid(factor=0.3)", 0.3),
        ("timid(factor=1)", 1),
        ("picky(factor=.7)", 0.7),
    ],
)
def test_a_strategy_of_a_file_takes_arguments(
    file: Path, name: str, factor: float
) -> None:
    strategy: Any = load_strategy(f"{file}:{name}")
    assert strategy.factor == factor


def test_a_strategy_of_a_file_can_be_sent_to_another_process(
    file: Path,
) -> None:
    code = "import pickle, sys; print(pickle.load(sys.stdin.buffer))"
    sent = pickle.dumps(load_strategy(f"{file}:Timid(factor=0.3)"))
    got = subprocess.run(
        [sys.executable, "-c", code], input=sent, capture_output=True
    )
    assert got.stdout.startswith(b"Timid(factor=0.3"), got.stderr


def test_names_take_arguments() -> None:
    assert load_strategy("pursuit(gain=2, pull=1)") == Pursuit(gain=2, pull=1)
    assert load_strategy("evasion(angle=45deg)") == Evasion(pi / 4)
    assert load_strategy("pursuit(gain=inf)") == load_strategy("sharp")
    assert load_strategy("noisy( seed = 3 )") == Pursuit(
        gain=2.0, noise=0.5, seed=3
    )
    own = Evasion(safety_radius=1.5)
    assert load_strategy("evasion(angle=1)", own) == replace(own, angle=1)
    assert load_strategy("look-ahead(enough=1, cells=16)") == LookAhead(
        1, cells=16
    )
    assert load_strategy("goal(goal=(1, -2.5))") == GoalWalk(goal=(1, -2.5))


@pytest.mark.parametrize(
    ("name", "file"),
    [
        ("", None),
        ("pursuit(gain=2)", None),
        ("a (1)/n.onnx", "a (1)/n.onnx"),
        ("a (1)/own.py:B", "a (1)/own.py"),
        ("a (1)/own.py:B(x=(1, 2), y=3)", "a (1)/own.py"),
    ],
)
def test_the_file_of_a_name_is_told(name: str, file: str | None) -> None:
    assert file_of(name) == (None if file is None else Path(file))


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("pursut", "must be one of .*got 'pursut'; did you mean pursuit?"),
        ("pursuit(gian=2)", "got 'gian'; did you mean gain?"),
        (
            "pursuit(gain=-1)",
            r"gain must lie in \(0, 1000\] or inf \[1\], got",
        ),
        ("pursuit(gain=yes)", r"gain must lie in .*got 'yes'"),
        ("pursuit(gain=true)", r"gain must lie in .*got True"),
        ("pursuit(2)", "must have arguments like gain=2, got '2'"),
        ("evasion(angle=200deg)", r"angle must lie in \[0, 3.14159\] \[rad\]"),
        ("net.onnx(gain=2)", "net.onnx must have no arguments, got gain"),
    ],
)
def test_names_and_arguments_are_refused_by_rule(
    name: str, message: str
) -> None:
    for check in (load_strategy, check_strategy_name):
        with pytest.raises(ConfigurationError, match=message):
            check(name)


@pytest.mark.parametrize(
    ("name", "message"),
    [
        (
            "Timid(factr=1)",
            r"Timid must have arguments of factor, direction, "
            "saturated, got 'factr'; did you mean factor",
        ),
        (
            "Timid(factor=no)",
            "Timid: factor must be a finite number, got 'no'",
        ),
        ("Mute", r"must return \(Intent, memory\), got TypeError"),
        ("Moody", "the same knowledge and memory must give the same intent"),
        ("Broken", "must return .*, got ZeroDivisionError"),
        ("Wild", "must return .*, got PlanError: speed_factor must lie in"),
        ("sideways", "direction must be a Direction, got -1"),
        ("Forgetful", "must have a method begin, got a Forgetful without"),
        ("vague", "saturated must be a bool, got 1"),
        ("Lost", r"begin\(\) must return a memory, got RuntimeError: no mem"),
        ("Stray", "direction must be a Direction, got RuntimeError: where"),
        ("picky", r"picky\(\) must make a strategy, got TypeError"),
        ("NUMBER", "must be a strategy, or a class or function.*got 3"),
        ("Nobody", "the file has no Nobody, but .*Timid"),
        ("Path", "the file has no Path"),
        (
            "None_",
            "but Broken, Forgetful, Lost, Moody, Mute, Stray, Timid, Wild, "
            "picky, quick, sideways, timid, vague$",
        ),
    ],
)
def test_an_invalid_strategy_is_refused_in_one_line(
    file: Path, name: str, message: str
) -> None:
    with pytest.raises(ConfigurationError, match=message) as caught:
        load_strategy(f"{file}:{name}")
    assert str(caught.value).startswith(
        f"strategy {file}:{name.partition('(')[0]}: "
    )
    assert "\n" not in str(caught.value)


def test_settings_can_be_read_where_the_file_is_not() -> None:
    """Figures of an old run need no strategy; a duel does."""
    settings = duel(evader={"strategy": "gone.py:Timid"})
    with pytest.raises(ConfigurationError, match=r"no file .*gone\.py"):
        RecordedGame(settings)


def test_a_file_is_read_as_it_is_now(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also one that was written anew in the same second, and is as long."""
    monkeypatch.setattr(sys, "dont_write_bytecode", False)
    path = tmp_path / "own.py"
    for text in ("1 / 0", "def ("):
        path.write_text(text, encoding="utf-8")
        os.utime(path, (1e9, 1e9))
        wrong = "ZeroDivisionError" if "/" in text else "SyntaxError"
        with pytest.raises(ConfigurationError, match=wrong):
            load_strategy(f"{path}:Timid")
    assert list(tmp_path.iterdir()) == [path]


def test_a_file_does_not_play_with_the_helper_of_another_folder(
    tmp_path: Path,
) -> None:
    names = []
    for turned in ("0.3", "0.9"):
        folder = tmp_path / turned
        folder.mkdir()
        (folder / "angle_of_both.py").write_text(f"ANGLE = {turned}")
        (folder / "own.py").write_text(
            "import angle_of_both\nfrom stepaside.strategies import Walk\n"
            "def own():\n    return Walk(angle_of_both.ANGLE)"
        )
        names.append(f"{folder / 'own.py'}:own")
    assert load_strategy(names[0]) == Walk(0.3) == load_strategy(names[0])
    with pytest.raises(ConfigurationError, match="imports angle_of_both from"):
        load_strategy(names[1])
