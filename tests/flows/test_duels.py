"""Duels of two humanoids, as users play and keep them."""

import shutil
from math import degrees, pi, radians
from pathlib import Path

import numpy as np
import pytest

import stepaside as sa
from flows.calls import (
    configuration,
    kept_summary,
    stepaside,
    summary,
    trajectories,
)
from flows.circles import PACE, apart, arc, circle, start_on


def options_of(start: tuple[float, float, float]) -> list[str]:
    """Options that give distance [m] and both offsets [rad]."""
    names = ("distance", "pursuer_offset", "evader_offset")
    pairs = zip(names, start, strict=True)
    return [w for name, v in pairs for w in ("--set", f"start.{name}={v}")]


def test_a_duel_ends_on_the_circle_of_theory(tmp_path: Path) -> None:
    seen = kept_summary(
        "duel", tmp_path / "run", "--seed", 7, "--duration", 90
    )
    goal = circle()
    assert seen["outcome"] == "completed"
    assert seen["triggered_at_distance_m"] == pytest.approx(0.8, abs=0.02)
    for player in ("pursuer", "evader"):
        radius = seen["players"][player]["radius_m"]
        assert radius == pytest.approx(goal.radius, rel=0.03)
    assert seen["distance_m"] == pytest.approx(goal.distance, rel=0.03)
    assert seen["relative_orientation_deg"] == pytest.approx(90.0, abs=3.0)
    assert seen["converged_at_s"] < 60.0
    assert seen["captured_at_s"] is None and seen["touched"] == []
    # The summary is of the arrays beside it.
    kept = trajectories(tmp_path / "run")
    near = apart(kept["pursuer_place"], kept["evader_place"])
    later = kept["times_s"] >= 60.0
    assert seen["distance_m"] == pytest.approx(near[later].mean(), abs=2e-3)
    path = kept["pursuer_landings"]
    assert len(path) == pytest.approx((90.0 - 0.8) * PACE / 0.04, abs=2)


@pytest.mark.parametrize("angle", [45, 70])
@pytest.mark.parametrize("saturated", [False, True])
def test_each_law_and_angle_has_its_own_circle(
    angle: int, saturated: bool, tmp_path: Path
) -> None:
    """Begun on the circle, both stay on it.

    Steps sample eq. (6), so that an evader that slides is off by up to a
    turn of a step.
    """
    goal = circle(radians(angle), saturated=saturated)
    seen = kept_summary(
        "duel",
        tmp_path / "run",
        *options_of(start_on(goal)),
        *("--set", f"evasion.angle={angle}deg", "--duration", 22),
        *("--set", "evasion.safety_radius=1.2"),
        *("--set", f"evasion.saturated={str(saturated).lower()}"),
    )
    slides = saturated and radians(angle) < 1.0
    rel, around = (0.06, 9.0) if slides else (0.03, 3.0)
    assert seen["outcome"] == "completed"
    assert seen["distance_m"] == pytest.approx(goal.distance, rel=rel)
    assert seen["relative_orientation_deg"] == pytest.approx(
        degrees(goal.headings), abs=around
    )
    kept = trajectories(tmp_path / "run")
    radius, _ = arc(kept["times_s"], kept["evader_place"], 4.0, 21.0)
    assert radius == pytest.approx(goal.radius, rel=2 * rel)


def test_a_hardware_body_walks_the_circle_by_feedback(tmp_path: Path) -> None:
    """Without feedback it walks 0.78 of the pace, on a wider circle."""
    goal = circle()
    seen = kept_summary(
        "duel",
        tmp_path / "run",
        *options_of(start_on(goal)),
        *(
            "--body",
            "hardware",
            "--set",
            "evasion.safety_radius=1.2",
            "--duration",
            24,
        ),
    )
    assert seen["outcome"] == "completed"
    assert seen["distance_m"] == pytest.approx(goal.distance, rel=0.06)
    assert seen["relative_orientation_deg"] == pytest.approx(90.0, abs=5.0)
    kept = trajectories(tmp_path / "run")
    for player in ("pursuer", "evader"):
        place = kept[f"{player}_place"]
        radius, pace = arc(kept["times_s"], place, 5.0, 23.0)
        assert radius == pytest.approx(goal.radius, rel=0.08)
        assert pace == pytest.approx(PACE, rel=0.06)
    evader = configuration(tmp_path / "run")["players"][1]
    assert evader["control"]["feedback"] is True


def test_cameras_see_where_the_other_is(tmp_path: Path) -> None:
    """On the circle both turn the head by 45 degrees to see each other."""
    seen = kept_summary(
        "duel",
        tmp_path / "run",
        *options_of(start_on(circle())),
        *(
            "--sensing",
            "cameras",
            "--duration",
            3,
            "--set",
            "evasion.safety_radius=1.2",
        ),
    )
    assert seen["sight"]["detection_rate"] > 0.95
    assert seen["sight"]["false_detections"] == 0
    kept = trajectories(tmp_path / "run")
    for own, other in (("pursuer", "evader"), ("evader", "pursuer")):
        sight = kept[f"{own}_sight"]
        known = sight[np.isfinite(sight[:, 1]) & (sight[:, 0] > 1.5)]
        assert len(known) > 30
        at = np.searchsorted(kept["times_s"], known[:, 0]).clip(max=150)
        mine, its = kept[f"{own}_torso"][at], kept[f"{other}_torso"][at]
        line = (its - mine)[:, :2]
        bearing = np.arctan2(line[:, 1], line[:, 0]) - mine[:, 2]
        error = (known[:, 1] - bearing + pi) % (2 * pi) - pi
        assert abs(np.median(bearing)) > radians(35.0)
        assert np.median(abs(error)) < radians(4.0)
        assert np.median(abs(known[:, 2] - np.hypot(*line.T))) < 0.06


ROOM = """
width = 3.0
depth = 3.0
obstacles = [{ x = 1.0, y = 0.0, radius = 0.2 }]
starts = [[-0.2, 0.0, 0.0], [0.5, 0.0, 3.14159]]
"""


def test_an_evader_that_looks_ahead_touches_nobody(tmp_path: Path) -> None:
    """It begins with its back to a disc, into which the paper's walks.

    With a map the paper's halts before the disc, whatever it wants.
    """
    room = tmp_path / "room.toml"
    room.write_text(ROOM)
    back = ("--room", room, "--set", "evasion.angle=0", "--duration", 6)
    blind = summary("duel", *back, "--set", "map.source=none")
    assert blind["outcome"] == "contact"
    assert blind["touched"] == ["disc 1", "evader"]
    assert "disc 1" not in summary("duel", *back)["touched"]
    seen = kept_summary(
        "duel",
        tmp_path / "run",
        *("--room", room, "--duration", 10, "--strategy", "look-ahead"),
    )
    assert seen["outcome"] == "completed" and seen["touched"] == []
    kept = trajectories(tmp_path / "run")
    evader, pursuer = kept["evader_place"], kept["pursuer_place"]
    assert apart(pursuer, evader).min() > 0.35
    # It went, and not into the disc: half a body wider than the disc.
    assert np.ptp(evader[:, :2], axis=0).max() > 0.2
    assert np.hypot(evader[:, 0] - 1.0, evader[:, 1]).min() > 0.2 + 0.11
    assert abs(evader[:, :2]).max() < 1.5 - 0.11


@pytest.fixture(scope="module")
def kept_duel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run of a body with noise, in which everything that is drawn counts."""
    folder = tmp_path_factory.mktemp("kept") / "run"
    stepaside(
        *(
            "duel",
            "--seed",
            5,
            "--duration",
            2,
            "--set",
            "evasion.angle=70deg",
        ),
        *("--body", "hardware", "--output", folder),
    )
    return folder


def test_settings_of_a_run_play_the_same_run_again(
    kept_duel: Path, tmp_path: Path
) -> None:
    again = tmp_path / "again"
    seen = kept_summary(
        "duel", again, "--config", kept_duel / "configuration.toml"
    )
    first, second = trajectories(kept_duel), trajectories(again)
    assert first.keys() == second.keys()
    for name, array in first.items():
        np.testing.assert_array_equal(array, second[name], err_msg=name)
    # Another seed is another run: equality says something.
    assert seen["seed"] == 5
    evader = configuration(again)["players"][1]
    assert evader["evasion"]["angle"] == radians(70.0)


def test_settings_of_a_run_play_it_again_from_python(kept_duel: Path) -> None:
    kept = sa.load_run(kept_duel, "duel")
    again = sa.run_game(kept.settings)
    for player in ("pursuer", "evader"):
        first, second = kept.tracks[player], again.tracks[player]
        np.testing.assert_array_equal(first.place, second.place)
        np.testing.assert_array_equal(first.qpos, second.qpos)
    assert kept.summary.min_distance_m == again.summary.min_distance_m


def test_a_run_opens_from_another_folder(
    kept_duel: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    moved = tmp_path / "elsewhere" / "renamed"
    shutil.copytree(kept_duel, moved)
    (tmp_path / "work").mkdir()
    monkeypatch.chdir(tmp_path / "work")
    run = sa.load_run("../elsewhere/renamed")
    assert run.name == "renamed"
    np.testing.assert_array_equal(
        run.tracks["evader"].place, trajectories(kept_duel)["evader_place"]
    )
    stepaside("show", moved, kept_duel, "-o", "both.svg")
    drawn = Path("both.svg").read_text()
    assert drawn.lstrip().startswith("<?xml") and "renamed" in drawn
    assert "dc:date" not in drawn  # the same run gives the same file
    summed = (moved / "summary.json").read_text()
    (moved / "summary.json").write_text(
        summed.replace('"min_distance_m": ', '"min_distance_m": 1')
    )
    refused = stepaside("show", moved, "-o", "moved.svg", status=2)
    assert len(refused.err.splitlines()) == 1 and "renamed" in refused.err


@pytest.mark.parametrize("model", ["model.xml", "../published/model.xml"])
def test_a_run_of_an_own_humanoid_opens_from_another_folder(
    model: str, tmp_path: Path
) -> None:
    own, described = tmp_path / "own", Path(sa.__file__).parent / "robots/nao"
    shutil.copytree(described, own)
    (tmp_path / "published").mkdir()
    (own / "model.xml").rename(own / model)
    text = (own / "robot.toml").read_text()
    changed = text.replace('"model.xml"', f'"{model}"')
    (own / "robot.toml").write_text(changed)
    stepaside(
        *(
            "run",
            "walk",
            "--robot",
            "own",
            "--duration",
            0.5,
            "--output",
            "run",
        ),
        cwd=tmp_path,
    )
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    stepaside("show", "../run", "-o", "run.html", cwd=elsewhere)
    assert "own" in (elsewhere / "run.html").read_text()
