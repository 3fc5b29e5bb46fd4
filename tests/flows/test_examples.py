"""Run the examples as their documentation says."""

import re
import runpy
import sys
from concurrent.futures import ThreadPoolExecutor
from math import pi, sqrt
from pathlib import Path
from subprocess import check_output

import pytest

from flows.calls import EXAMPLES

VALUES = (
    "own_strategy",
    "study_own_strategy",
    "unicycle_games",
)  # with tests of their own
SHORT = {  # seconds of simulation, where an example takes them
    "change_gait": "2",
    "keep_runs": "2",
    "many_duels": "1",
    "own_strategy": "8",
    "play_duel": "2",
    "self_play": "2 2",
    "train_evader": "open 2",
}
SHORTER = {  # what else takes long
    "study_own_strategy.py": {"range(5)": "range(1, 2)", "=4)": "=1)"}
}


class Runner:
    """Runs examples in this process."""

    def __init__(
        self,
        capsys: pytest.CaptureFixture[str],
        monkeypatch: pytest.MonkeyPatch,
    ) -> None:
        self.capsys, self.monkeypatch = capsys, monkeypatch

    def __call__(self, name: str, *arguments: str) -> str:
        """Return the output of an example."""
        file = str(EXAMPLES / name)
        if name in SHORTER:
            text = Path(file).read_text(encoding="utf-8")
            for long, short in SHORTER[name].items():
                assert long in text
                text = text.replace(long, short)
            file = name
            Path(file).write_text(text, encoding="utf-8")
        # One hides MuJoCo from itself, one plays in processes.
        if name in ("control_alone.py", "study_own_strategy.py"):
            return check_output([sys.executable, file], text=True)
        self.monkeypatch.setattr(sys, "argv", [file, *arguments])
        self.monkeypatch.setattr(
            "concurrent.futures.ProcessPoolExecutor", ThreadPoolExecutor
        )
        runpy.run_path(file, run_name="__main__")
        return self.capsys.readouterr().out


@pytest.fixture
def run(
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> Runner:
    monkeypatch.chdir(tmp_path)
    return Runner(capsys, monkeypatch)


@pytest.mark.parametrize("file", sorted(EXAMPLES.glob("*.py")), ids=str)
def test_an_example_names_what_it_needs(file: Path) -> None:
    """It runs alone: a line lists its dependencies (PEP 723)."""
    lines = file.read_text(encoding="utf-8").splitlines()
    assert lines[0] == "# /// script"
    assert lines[1].startswith('# dependencies = ["stepaside')
    assert lines[2] == "# ///"


@pytest.mark.parametrize(
    "name",
    [f.stem for f in sorted(EXAMPLES.glob("*.py")) if f.stem not in VALUES],
)
def test_an_example_runs_alone_and_says_something(
    name: str, run: Runner
) -> None:
    given = SHORT.get(name, "").split()
    lines = run(f"{name}.py", *given).splitlines()
    assert len(lines) >= 3
    assert any(re.search(r"\d (m|ms|s|mm|deg|rad|MB)\b|\[", x) for x in lines)


def test_an_own_strategy_plays_as_unicycle_and_as_humanoid(
    run: Runner,
) -> None:
    """It comes off better than moving aside, on both levels."""
    line = r"(\w+) +(\w+): closest approach (.*) m, floor used (.*) m"
    found = {
        (name, bodies): (float(closest), float(floor))
        for name, bodies, closest, floor in re.findall(
            line, run("own_strategy.py", "8")
        )
    }
    assert len(found) == 4
    for bodies in ("unicycles", "humanoids"):
        aside, own = found["aside", bodies], found["own", bodies]
        assert 0.4 < aside[0] < own[0] < 0.9
        assert 0.2 < own[1] < 1.0


def test_a_study_of_an_own_strategy_draws_its_parameter(
    run: Runner, tmp_path: Path
) -> None:
    """The farther off it backs, the farther the pursuer stays."""
    text = run("study_own_strategy.py")
    closest = [float(x) for x in re.findall(r"approach (.*) m", text)]
    assert len(closest) == 4
    assert closest == sorted(closest)
    assert 0.4 < closest[0] < closest[-1] - 0.005
    assert (tmp_path / "back_off.png").exists()


def test_an_example_of_unicycles_finds_the_circle(run: Runner) -> None:
    """At v and k of NAO: psi is 45 deg, so R = v / (k psi), 90 deg apart."""
    text = run("unicycle_games.py")
    radius = 0.1 / (0.2 * pi / 4)
    apart = radius * sqrt(2.0)
    assert f"radius {radius:.3f} m, players {apart:.3f} m and 90 deg" in text
    words = r"(?:certified|played)\D+([0-9.]+) m"
    certified, played = map(float, re.findall(words, text))
    assert 0.0 < certified <= played < apart
