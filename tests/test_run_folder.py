"""Run folders: whole or not at all, and what is read back from them."""

import json
import os
from dataclasses import replace
from math import degrees
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from stepaside.errors import ConfigurationError
from stepaside.games.duel import DuelResult, run_duel
from stepaside.games.settings import (
    DuelSettings,
    StartSettings,
    StrategySettings,
)
from stepaside.games.summary import summarise, theory_of
from stepaside.poses import Array
from stepaside.report import run_folder, sight_figure
from stepaside.report.replay import Run, Stage, load_run
from stepaside.report.run_folder import check_output, free_folder, write_run

SETTINGS = DuelSettings(
    seed=3, duration=0.4, start=StartSettings(1.3, 0.4, -0.2)
)


@pytest.fixture(scope="module")
def result() -> DuelResult:
    return run_duel(SETTINGS)


def draw_nothing(*arguments: Any) -> None:
    arguments[-1].write_bytes(b"picture")


@pytest.fixture(autouse=True)
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(run_folder, "draw_duel", draw_nothing)


def test_a_run_comes_back_as_it_was(
    tmp_path: Path, result: DuelResult
) -> None:
    folder = tmp_path / "runs" / "first"
    summary = summarise(result)
    figure = write_run(folder, result, summary)
    assert figure == folder / "duel.png" and figure.is_file()
    assert sorted(p.name for p in folder.iterdir()) == [
        *("configuration.toml", "duel.png"),
        *("summary.json", "trajectories.npz"),
    ]
    assert folder.stat().st_mode & 0o777 == 0o755
    assert list(folder.parent.iterdir()) == [folder]
    run = load_run(folder)
    assert run.name == "first"
    assert run.settings == result.settings
    assert run.summary == json.loads(json.dumps(summary))
    assert run.arrays.keys() == result.arrays.keys()
    for name, values in result.arrays.items():
        np.testing.assert_array_equal(run.arrays[name], values)


def test_an_empty_folder_is_taken(tmp_path: Path, result: DuelResult) -> None:
    folder = tmp_path / "empty"
    folder.mkdir()
    write_run(folder, result, {})
    assert (folder / "summary.json").read_text(encoding="utf-8") == "{}\n"


@pytest.mark.parametrize("error", [RuntimeError("ink"), KeyboardInterrupt()])
def test_an_error_leaves_nothing_behind(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    result: DuelResult,
    error: BaseException,
) -> None:
    def fail(*arguments: Any) -> None:
        assert len(list(tmp_path.iterdir())) == 1  # the draft
        raise error

    monkeypatch.setattr(run_folder, "draw_duel", fail)
    with pytest.raises(type(error)):
        write_run(tmp_path / "run", result, {})
    assert list(tmp_path.iterdir()) == []


def test_a_film_strip_is_there_if_they_saw(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, result: DuelResult
) -> None:
    monkeypatch.setattr(sight_figure, "draw_sight", draw_nothing)
    seen = replace(result, stills={"pursuer": {}})
    write_run(tmp_path / "run", seen, {})
    assert (tmp_path / "run" / "sight.png").read_bytes() == b"picture"


def test_output_goes_where_nothing_is_lost(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    check_output(tmp_path / "new")
    check_output(tmp_path / "a" / "b" / "c")
    empty = tmp_path / "empty"
    empty.mkdir()
    check_output(empty)
    full = tmp_path / "full"
    full.mkdir()
    file = full / "thesis.txt"
    file.write_text("x", encoding="utf-8")
    for taken in (full, file):
        with pytest.raises(ConfigurationError, match="new or an empty"):
            check_output(taken)
    with pytest.raises(ConfigurationError, match="can be written"):
        check_output(file / "below")
    monkeypatch.setattr(os, "access", lambda *_: False)
    with pytest.raises(ConfigurationError, match="can be written"):
        check_output(tmp_path / "new")


def test_the_next_free_name_is_counted_from_two(tmp_path: Path) -> None:
    for expected in ("run", "run-2", "run-3", "run-4"):
        folder = free_folder(tmp_path, "run")
        assert folder == tmp_path / expected
        folder.mkdir()


@pytest.mark.parametrize(
    "name", ["configuration.toml", "summary.json", "trajectories.npz"]
)
def test_a_folder_that_lacks_a_file_is_no_run(
    tmp_path: Path, result: DuelResult, name: str
) -> None:
    folder = tmp_path / "run"
    write_run(folder, result, {})
    (folder / name).unlink()
    with pytest.raises(ConfigurationError, match=f"has no {name}"):
        load_run(folder)


@pytest.mark.parametrize("name", ["summary.json", "trajectories.npz"])
def test_a_broken_file_is_refused(
    tmp_path: Path, result: DuelResult, name: str
) -> None:
    folder = tmp_path / "run"
    write_run(folder, result, {})
    (folder / name).write_bytes(b"{ broken")
    with pytest.raises(ConfigurationError, match="cannot be read"):
        load_run(folder)


TIMES = np.linspace(0.0, 40.0, 401)


def invented(**summary: Any) -> Run:
    """Robots that wander, and then go round (3, -2) by halves."""
    angle = 0.5 * TIMES
    away = np.where(TIMES < 20.0, 5.0, 0.0)[:, None]
    ring = np.column_stack([np.cos(angle), np.sin(angle), angle])
    middle = np.array([3.0, -2.0, 0.0]) + away
    pursuer, evader = middle + 0.6 * ring, middle - 0.6 * ring
    pursuer[:, 2], evader[:, 2] = angle, angle + 1.2
    told = {"outcome": "completed", "message": "played 40 s", **summary}
    arrays: dict[str, Array] = {
        "times_s": TIMES,
        "pursuer_torso": pursuer,
        "evader_torso": evader,
    }
    return Run("invented", DuelSettings(), told, arrays)


def test_a_run_tells_its_distance_and_angle_in_degrees() -> None:
    run = invented()
    np.testing.assert_array_equal(run.times, TIMES)
    np.testing.assert_allclose(run.distance, 1.2)
    np.testing.assert_allclose(run.orientation, degrees(1.2))


def test_theory_is_radius_distance_and_degrees() -> None:
    circle = theory_of(DuelSettings())
    assert invented().theory == pytest.approx(
        (circle.radius_evader_m, circle.distance_m, 90.0)
    )
    back = DuelSettings(strategy=StrategySettings(angle=0.0))
    assert replace(invented(), settings=back).theory is None


def test_the_circle_lies_round_the_way_after_they_converged() -> None:
    """A whole turn takes 12.6 s; what was before has another middle."""
    run = invented(converged_at_s=40.0 - 4.0 * np.pi)
    assert run.circle is not None and run.theory is not None
    assert run.circle[:2] == pytest.approx((3.0, -2.0), abs=0.02)
    assert run.circle[2] == run.theory[0]
    late = invented(converged_at_s=20.0).circle
    assert late is not None and late[0] == pytest.approx(3.0, abs=0.05)
    early = invented(converged_at_s=0.0).circle
    assert early is not None and early[0] == pytest.approx(5.5, abs=0.05)
    assert early[1] == pytest.approx(0.5, abs=0.05)
    assert invented(converged_at_s=None).circle is None
    assert invented().circle is None


COMING = "the pursuer comes; the evader stands"
TRIGGERED = "the evader is triggered"
EVADING = "the evader is evading"
ROUND = "both robots are on the circle"


@pytest.mark.parametrize(
    ("time", "words"),
    [
        (0.0, COMING),
        (4.9, COMING),
        (5.0, TRIGGERED),
        (5.9, TRIGGERED),
        (6.0, EVADING),
        (29.9, EVADING),
        (30.0, ROUND),
        (40.0, ROUND),
    ],
)
def test_words_change_with_the_time(time: float, words: str) -> None:
    run = invented(triggered_at_s=5.0, converged_at_s=30.0)
    assert run.words(round(10.0 * time)) == words


@pytest.mark.parametrize(
    ("summary", "words"),
    [
        ({}, COMING),
        ({"triggered_at_s": 5.0}, EVADING),
        ({"triggered_at_s": 39.5}, TRIGGERED),
        ({"outcome": "fall", "message": "evader fell"}, "evader fell"),
        ({"outcome": "contact", "message": "touched"}, "touched"),
        ({"outcome": "interrupted", "message": "stopped"}, COMING),
    ],
)
def test_the_last_words_are_how_it_ended(
    summary: dict[str, Any], words: str
) -> None:
    run = invented(**summary)
    assert run.words(400) == words
    before = EVADING if summary.get("triggered_at_s") == 5.0 else COMING
    assert run.words(394) == before


def test_the_stage_puts_the_bodies_where_they_were(
    result: DuelResult,
) -> None:
    """At every sample: torsos, CoMs and the cameras of the bodies."""
    arrays = dict(result.arrays)
    for name in ("pursuer", "evader"):
        moved = arrays[f"{name}_qpos"].copy()
        moved[:, 0] += np.linspace(0.0, 1.0, len(moved))
        moved[:, 9] += np.linspace(0.0, 0.3, len(moved))
        arrays[f"{name}_qpos"] = moved
    stage = Stage(Run("run", result.settings, {}, arrays))
    torsos = [stage.model.body(f"{n}/torso").id for n in ("pursuer", "evader")]
    for index in (0, 7, len(arrays["times_s"]) - 1, 3):
        stage.put(index)
        postures = [arrays[f"{n}_qpos"][index] for n in ("pursuer", "evader")]
        np.testing.assert_allclose(stage.data.qpos, np.concatenate(postures))
        for torso, posture in zip(torsos, postures, strict=True):
            np.testing.assert_allclose(
                stage.data.xpos[torso], posture[:3], atol=1e-6
            )


def test_a_person_is_put_where_it_walked() -> None:
    settings = DuelSettings(
        duration=0.4, pursuer="person", start=StartSettings(2.5, 0.0, 0.0)
    )
    result = run_duel(settings)
    arrays = dict(result.arrays)
    walked = arrays["pursuer_torso"].copy()
    count = len(walked)
    walked[:, 0] = np.linspace(0.0, 0.5, count)
    walked[:, 1] = np.linspace(0.0, -0.3, count)
    walked[:, 2] = np.linspace(0.0, 1.0, count)
    arrays["pursuer_torso"] = walked
    stage = Stage(Run("run", result.settings, {}, arrays))
    trunk = stage.model.body("pursuer/trunk").id
    legs = []
    for index in (0, count // 2, count - 1):
        stage.put(index)
        place = stage.data.xpos[trunk]
        np.testing.assert_allclose(place[:2], walked[index, :2], atol=0.05)
        frame = stage.data.xmat[trunk]
        heading = np.arctan2(frame[3], frame[0])
        assert heading == pytest.approx(walked[index, 2], abs=0.1)
        legs.append(_legs(stage, float(heading)))
    assert np.abs(legs[1] - legs[0]).max() > 0.02
    assert np.abs(legs[2] - legs[1]).max() > 0.02


def _legs(stage: Stage, heading: float) -> Array:
    """Axes of the person's parts, seen from its trunk. Shape (n, 3, 3)."""
    names = [stage.model.body(i).name for i in range(stage.model.nbody)]
    own = [i for i, name in enumerate(names) if name.startswith("pursuer/")]
    c, s = np.cos(heading), np.sin(heading)
    turn = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    seen: Array = turn @ stage.data.xmat[own].reshape(-1, 3, 3)
    return seen
