"""Test the commands circle, unicycles and map."""

import json
from math import pi
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner, Result

from stepaside.cli.main import main
from stepaside.cli.run import unicycles
from stepaside.cli.theory import circle
from stepaside.cli.theory import map as map_command
from stepaside.theory.unicycle import start_maps
from stepaside.theory.unicycle.start_maps import random_starts

COMPARED = (
    "radius_pursuer_m",
    "radius_evader_m",
    "distance_m",
    "turning_rate_rad_s",
    "headings_apart_rad",
    "motions_apart_rad",
)
MAP = "--speed 0.1 --gain 0.2 --nearest 0.8 --farthest 1.5 --set aim=30deg "
MAP += "--set facing=30deg --grid 5 --set distances=2 "
MAP += "--set duration=60"


def run(command: Any, words: str) -> Result:
    group = "run" if command is unicycles else "theory"
    return CliRunner().invoke(main, [group, command.name, *words.split()])


def loads(command: Any, words: str) -> dict[str, Any]:
    result = run(command, words + " --json")
    assert result.exit_code == 0, result.output
    found: dict[str, Any] = json.loads(result.stdout)
    return found


def test_circle_prints_the_values_of_figure_2() -> None:
    found = loads(circle, "--speed 1 --gain 0.5 --angle 90deg")
    assert found["radius_pursuer_m"] == pytest.approx(8 / pi)
    assert found["distance_m"] == pytest.approx(3.6012652646)
    assert found["eigenvalues_per_s"][-1] == pytest.approx([-0.5, 0.0])
    assert found["stable"] and found["time_constant_s"] == pytest.approx(4)
    assert 0 < found["largest_stable_delay_s"] < 10


def test_missing_circle_is_a_valid_result() -> None:
    found = loads(circle, "--angle 0")
    assert found["exists"] is False and found["distance_m"] is None
    table = run(circle, "--angle 0")
    assert table.exit_code == 0 and "no circle" in table.output


def test_stability_under_sampling_and_delay_is_computed() -> None:
    words = "--speed 0.1 --gain 0.2 --set sample_time=0.4 --set delay=0.2"
    found = loads(circle, words)
    assert found["stable"]
    limit = found["largest_stable_sample_time_s"]
    for off, stable in ((-0.1, True), (0.1, False)):
        words = "--speed 0.1 --gain 0.2 --set delay=0.2 --set sample_time="
        held = loads(circle, f"{words}{limit + off}")
        assert held["stable"] is stable
        assert (held["time_constant_s"] is not None) is stable
    assert not loads(circle, "--set delay=5")["stable"]


@pytest.mark.parametrize(
    "words",
    [
        "--speed 1 --gain 0.5",
        "--law saturated --angle 0.3",
        "--set pursuer_speed=1.2 --set evader_gain=0.8 --angle 70deg",
    ],
)
def test_simulation_reaches_the_closed_form(words: str) -> None:
    played = loads(unicycles, words)
    assert played["circle"]["direction"] == 1
    theory = loads(circle, words)
    for name in COMPARED:
        assert played[name] == pytest.approx(theory[name], abs=1e-3), name


def test_map_names_the_worst_start() -> None:
    found = loads(map_command, MAP)
    assert found["games"] == 50
    assert found["captured_share"] == 0.0
    low = found["min_distance_m"]
    assert 0.4 < low <= found["mean_closest_distance_m"]
    start = found["worst_start"]
    words = (
        f"--speed 0.1 --gain 0.2 --duration 60 --distance "
        f"{start['distance_m']} --aim {start['pursuer_error_rad']} "
        f"--bearing {start['bearing_rad']}"
    )
    again = loads(unicycles, words)
    assert again["closest_distance_m"] == pytest.approx(low, abs=1e-6)


def test_figure_that_cannot_be_written_is_refused_first(
    tmp_path: Path,
) -> None:
    for name in ("game.txt", "game.png/x.txt"):
        result = run(unicycles, f"--figure {tmp_path / name}")
        assert result.exit_code == 2 and "--figure" in result.stderr
    assert not list(tmp_path.iterdir())


FAST = "--set pursuer_speed=2 --set evader_speed=1 "
FAST += "--set pursuer_gain=1 --set evader_gain=4"


@pytest.mark.slow
def test_circle_lists_main_and_reversed_with_their_basins() -> None:
    found = loads(circle, f"{FAST} --angle 90deg")
    main, other = found["circles"]
    assert main["distance_m"] == found["distance_m"]
    assert other["distance_m"] == pytest.approx(0.588, abs=1e-3)
    assert (main["direction"], other["direction"]) == (1, -1)
    assert main["side_rule"] == other["side_rule"] == "behind"
    assert main["share"] + other["share"] == pytest.approx(1.0)
    assert other["share"] == pytest.approx(0.25, abs=0.08)
    assert found["starts"]["unsettled_share"] == pytest.approx(0.0)
    table = run(circle, FAST).output
    assert "reversed" in table and "0.58758" in table
    kept = loads(circle, "--set side_rule=latched --starts 0")["circles"]
    assert [c["side_rule"] for c in kept] == ["behind", "latched"]
    assert [c["share"] for c in kept] == [None, None]


def test_map_of_a_faster_pursuer_has_both_circles(tmp_path: Path) -> None:
    words = f"{FAST} --grid 7 --set distances=2 --figure {tmp_path / 'm.png'}"
    found = loads(map_command, words)
    shares = [c["share"] for c in found["circles"]]
    assert [c["direction"] for c in found["circles"]] == [1, -1]
    assert min(shares) > 0.0
    assert sum(shares) == pytest.approx(found["settled_share"])
    ended = found["settled_share"] + found["captured_share"]
    assert ended == pytest.approx(1.0)  # none is on its way
    table = run(map_command, f"{FAST} --grid 3 --set distances=1").output
    assert "reversed" in table


def test_certified_distance_is_shown_only_where_it_holds() -> None:
    words = "--speed 1 --gain 1 --distance 1.57 --aim 0.31 --bearing"
    held = loads(unicycles, f"{words} -1.05")
    assert 0 < held["certified_m"] <= held["closest_distance_m"]
    assert "certified distance" in run(unicycles, f"{words} -1.05").output
    other = loads(unicycles, f"{words} 2.5")
    assert other["certified_m"] is None
    assert "certified distance" not in run(unicycles, f"{words} 2.5").output
    assert loads(unicycles, FAST)["certified_m"] is None


def test_starts_are_drawn_by_the_seed(monkeypatch: pytest.MonkeyPatch) -> None:
    seeds: list[int] = []

    def noted(game: Any, count: int, *, seed: int) -> Any:
        seeds.append(seed)
        return random_starts(game, count, seed=seed)

    monkeypatch.setattr(start_maps, "random_starts", noted)
    loads(circle, "--speed 0.1 --gain 0.2 --starts 2 --set seed=7")
    assert seeds == [7]
