"""Test checks of a stranger, and the search for a better way to walk."""

import re
import shutil
from dataclasses import replace
from pathlib import Path

import pytest
from click.testing import CliRunner

import stepaside.fitting.gait_search as tuning
import stepaside.fitting.robot_verification as verification
import vendor_humanoid as stranger
from stepaside.cli.main import main
from stepaside.fitting.derivation import derive
from stepaside.fitting.description_writer import (
    rewrite_description,
    write_description,
)
from stepaside.fitting.gait_search import Candidate, search_gait
from stepaside.fitting.robot_verification import (
    PATHS,
    TrialPath,
    WalkTrialResult,
)
from stepaside.games.player_settings import settings_from_description
from stepaside.robots.description import FILE, RobotDescription, load_robot
from stepaside.strategies.body_departure import BodyDeparture
from stored_values import compare_stored, words_of


@pytest.fixture(scope="module")
def own(tmp_path_factory: pytest.TempPathFactory) -> RobotDescription:
    """A stranger's humanoid, to be walked in open loop."""
    folder = tmp_path_factory.mktemp("stranger")
    found = derive(stranger.mjcf(folder), folder, [])
    text = write_description(found)
    text = text.replace("feedback = true", "feedback = false")
    text = text.replace('method = "measured"', 'method = "closed-form"')
    (folder / FILE).write_text(text, encoding="utf-8")
    return load_robot(folder)


def walked(
    path: TrialPath, off: float, *, falls: bool = False
) -> WalkTrialResult:
    """A walk that strays by a part of what a steady one may."""
    return WalkTrialResult(
        path.name,
        False,
        "fell" if falls else "walked",
        not falls,
        0.3 if falls else 1.0,
        8.0 * off,
        0.0,
        1.0,
        1.0 if path.bearing else None,
    )


@pytest.mark.parametrize(
    "limit",
    [
        *({"tilt": 10.0, "lean": 2.0}, {"strays": 0.06}, {"speed": 0.85}),
        *({"speed": 1.15}, {"turning": 0.85}, {"turning": 1.15}),
    ],
)
def test_a_steady_walk_meets_each_criterion(limit: dict[str, float]) -> None:
    exact = walked(PATHS[2], 0.0)
    assert exact.unsteadiness == 0.0
    assert exact._replace(**limit).unsteadiness == pytest.approx(1.0)  # type: ignore[arg-type]


def search(
    own: RobotDescription,
    monkeypatch: pytest.MonkeyPatch,
    kept: Path | None = None,
) -> tuple[tuning.SearchResult, int]:
    """Search where smaller steps and stiffer joints are steadier."""
    walks = []

    def walk(
        robot: RobotDescription, path: TrialPath, feedback: bool
    ) -> WalkTrialResult:
        walks.append(path)
        stiff = robot.overlay.servos["near_bend"].stiffness
        off = 0.9
        if float(robot.gait["stride"]) < 0.9 * float(own.gait["stride"]):
            off -= 0.4
        if stiff > 1.5 * own.overlay.servos["near_bend"].stiffness:
            off -= 0.4
        return walked(path, off, falls=feedback)

    monkeypatch.setattr(tuning, "walk_trial", walk)
    return search_gait(own, None, kept), len(walks)


def test_a_search_combines_helpful_changes(
    own: RobotDescription, monkeypatch: pytest.MonkeyPatch
) -> None:
    found, _ = search(own, monkeypatch)
    best = found.best.candidate
    assert found.before.unsteadiness == pytest.approx(0.9)
    assert found.best.unsteadiness == pytest.approx(0.1)
    assert best == Candidate(0.0, stiffness=1.6, stride=0.75)


def test_a_search_escapes_from_falls(
    own: RobotDescription, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A later fall is a better gait; two changes are needed here."""
    gait = settings_from_description(own).gait
    walks = []

    def walk(
        robot: RobotDescription, path: TrialPath, feedback: bool
    ) -> WalkTrialResult:
        walks.append(path)
        found = settings_from_description(robot).gait
        quick = found.single_support < 0.9 * gait.single_support
        ahead = found.zmp_forward < gait.zmp_forward
        falls = not quick or (not ahead and path in PATHS[:2])
        return walked(path, 0.1, falls=falls)

    monkeypatch.setattr(tuning, "walk_trial", walk)
    found = search_gait(own, None, None)
    assert found.before.unsteadiness > found.best.unsteadiness
    assert found.best.unsteadiness == pytest.approx(0.1)
    best = found.best.candidate
    assert best.times < 1.0 and best.zmp < 0.0
    assert len(walks) < 45  # most fall in their first walk


@pytest.mark.usefixtures("inline_workers")
@pytest.mark.parametrize("off", [0.1, 0.9])
def test_a_gait_that_is_steady_or_best_is_not_changed(
    off: float,
    own: RobotDescription,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    folder = shutil.copytree(own.folder, tmp_path / "own")
    before = (folder / FILE).read_bytes()
    monkeypatch.setattr(
        tuning, "walk_trial", lambda _, path, __: walked(path, off)
    )
    result = CliRunner().invoke(main, ["robot", "tune", str(folder)])
    assert result.exit_code == 0, result.output
    assert "description is unchanged" in result.stdout
    compare_stored("odd_models.json", f"tune {off}", words_of(result.output))
    assert (folder / FILE).read_bytes() == before


@pytest.mark.usefixtures("inline_workers")
def test_a_better_gait_is_written_with_what_it_was(
    own: RobotDescription, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Again by the next search, which begins from there."""
    folder = shutil.copytree(own.folder, tmp_path / "own")
    stride = float(own.gait["stride"])

    def walk(
        robot: RobotDescription, path: TrialPath, feedback: bool
    ) -> WalkTrialResult:
        off = 0.8 if float(robot.gait["stride"]) > 0.9 * stride else 0.3
        found = walked(path, off - 0.2 * (robot.lean > 0.05))
        return found if feedback else found._replace(completed=False)

    monkeypatch.setattr(tuning, "walk_trial", walk)
    for options in ([], ["--json"]):
        result = CliRunner().invoke(
            main, ["robot", "tune", str(folder), *options]
        )
        assert result.exit_code == 0, result.output
        key = "tune " + " ".join(["better", *options])
        compare_stored("odd_models.json", key, words_of(result.output))
        text = (folder / FILE).read_text(encoding="utf-8")
        assert text.count("# Tuned by") == 1
        assert f"# tuned, was {stride}" in text
        rewrite_description(text, load_robot(folder), ["anew"])
    assert load_robot(folder).control["feedback"] is True
    assert load_robot(folder).lean > 0.05


DEPARTURE = BodyDeparture(0.4, 0.02, 0.03, 0.004)


@pytest.mark.usefixtures("inline_workers")
@pytest.mark.parametrize("options", [[], ["--json"]])
@pytest.mark.parametrize("kind", ["accurate", "steady", "fed", "falls", "not"])
def test_a_check_prints_what_it_finds(
    kind: str,
    options: list[str],
    own: RobotDescription,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    folder = shutil.copytree(own.folder, tmp_path / "own")
    if kind == "not":
        text = (folder / FILE).read_text(encoding="utf-8")
        tall = re.sub(r"com_height = \S+", "com_height = 0.9", text)
        (folder / FILE).write_text(tall, encoding="utf-8")
    off = {"accurate": 0.2, "steady": 0.6}.get(kind, 1.3)

    def walk(
        _: RobotDescription, path: TrialPath, feedback: bool
    ) -> WalkTrialResult:
        falls = kind == "falls" and path.backward
        steady = kind == "fed" and feedback
        found = walked(path, 0.1 if steady else off, falls=falls)
        return found._replace(feedback=feedback)

    monkeypatch.setattr(verification, "walk_trial", walk)
    monkeypatch.setattr(verification, "walk_departure", lambda *_: DEPARTURE)
    result = CliRunner().invoke(
        main, ["robot", "check", str(folder), *options]
    )
    passes = kind in ("accurate", "steady")
    assert result.exit_code == (0 if passes else 1), result.output
    key = " ".join(["check", kind, *options])
    compare_stored("odd_models.json", key, words_of(result.output))


def test_a_missing_force_sensor_is_told() -> None:
    nao = load_robot("nao")
    feet = ("none", *nao.sensors.feet[1:])
    poor = replace(nao, sensors=replace(nao.sensors, feet=feet))
    found = {f.name: f for f in verification.check_requirements(poor)}
    assert found["sensors"][1:3] == ("fail", "no none")
