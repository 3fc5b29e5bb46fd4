"""Test checks of a stranger, and the search for a better way to walk."""

import shutil
from pathlib import Path

import pytest
from click.testing import CliRunner

import stepaside.fitting.gait_search as tuning
import vendor_humanoid as stranger
from stepaside.cli.main import main
from stepaside.fitting.derivation import derive
from stepaside.fitting.description_writer import (
    write_description,
)
from stepaside.fitting.gait_search import Candidate, search_gait
from stepaside.fitting.robot_verification import (
    PATHS,
    TrialPath,
    WalkTrialResult,
)
from stepaside.games.player_settings import settings_from_description
from stepaside.robots.description import (
    FILE,
    RobotDescription,
    load_robot,
)
from stepaside.studies.study import InlineExecutor


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


def test_the_command_does_not_change_a_steady_robot(
    own: RobotDescription, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = shutil.copytree(own.folder, tmp_path / "own")
    before = (folder / FILE).read_bytes()
    monkeypatch.setattr(
        "stepaside.core.worker_pool.worker_pool",
        lambda workers: InlineExecutor(),
    )
    monkeypatch.setattr(
        tuning, "walk_trial", lambda _, path, __: walked(path, 0.1)
    )
    result = CliRunner().invoke(main, ["robot", "tune", str(folder)])
    assert result.exit_code == 0, result.output
    assert "description is unchanged" in result.stdout
    assert (folder / FILE).read_bytes() == before
