"""Test the study of many duels on made records and on short duels."""

import json
import os
import signal
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

from stepaside.cli.duels import duels
from stepaside.games.duel_settings import DuelSettings, StartSettings
from stepaside.sim.push import Push
from stepaside.strategies import Evasion
from stepaside.studies.duel_record import play_record, settings_hash
from stepaside.studies.duel_statistics import (
    certificate_row,
    proportion,
    summarise_duels,
    value_row,
)
from stepaside.studies.study import count_records

SETTINGS = DuelSettings(duration=120.0)


def made(seed: int, **changes: Any) -> dict[str, Any]:
    """Record of a duel that was not played."""
    return {
        "seed": seed,
        "outcome": "completed",
        "message": "",
        "distance_m": 0.9 + 0.01 * seed,
        "relative_orientation_deg": 90.0,
        "pursuer_radius_m": 0.64,
        "evader_radius_m": 0.63,
        "converged_at_s": 10.0 * seed,
        "min_distance_m": 0.5,
        "evading_min_distance_m": 0.5,
        "certified_m": None,
        "digest": f"d{seed}",
        "wall_s": 1.0,
    } | changes


def test_a_record_holds_the_figures_of_its_duel() -> None:
    start = StartSettings(distance=0.7)
    settings = DuelSettings(seed=3, duration=2.0, start=start)
    record, again = play_record(settings), play_record(settings)
    assert record["seed"] == 3 and record["outcome"] == "completed"
    assert record["triggered_at_s"] == 0.004  # at the first tick
    assert record["start_distance_m"] == 0.7
    assert 0.5 < record["evading_min_distance_m"] < 0.75
    assert record["evading_min_distance_m"] >= record["min_distance_m"]
    assert json.loads(json.dumps(record, allow_nan=False)) == record
    for one in (record, again):
        del one["wall_s"]
    assert record == again
    other = play_record(replace(settings, seed=4))
    assert other["digest"] != record["digest"]


def test_only_a_certified_start_has_a_certified_distance() -> None:
    facing = StartSettings(0.75, 0.0, 0.0)
    blind = StartSettings(0.75, 3.0, 3.0)
    settings = DuelSettings(duration=0.1, start=facing)
    assert 0.3 < play_record(settings)["certified_m"] < 0.75
    for changes in (
        {"start": blind},
        {"strategy": Evasion(saturated=True)},
        {"strategy": Evasion(angle=0.0)},
    ):
        record = play_record(replace(settings, **changes))
        assert record["certified_m"] is None


def test_an_edited_strategy_file_changes_the_key(tmp_path: Path) -> None:
    """By its file's content; and pushes, which came later, count if any."""
    file = tmp_path / "own.py"
    file.write_text("first")
    own = replace(SETTINGS, evader_strategy=f"{file}:Own")
    before = settings_hash(own)
    assert settings_hash(own) == before != settings_hash(SETTINGS)
    file.write_text("second")
    after = settings_hash(own)
    assert after != before
    file.unlink()
    assert settings_hash(own) not in (before, after)
    pushed = replace(SETTINGS, pushes=(Push(1.0, 2.0, 0.0),))
    assert settings_hash(pushed) != settings_hash(SETTINGS)


def test_mean_interval_and_worst_seed_are_known_ones() -> None:
    records = [made(s, distance_m=d) for s, d in enumerate([0.8, 0.9, 1.3])]
    row = value_row("distance_m", records, 0.9, 0)
    assert row is not None
    assert row["mean"] == pytest.approx(1.0)
    assert row["deviation"] == pytest.approx(0.2645751)
    half = 4.302653 * 0.2645751 / np.sqrt(3.0)
    assert row["mean_high"] == pytest.approx(1.0 + half)
    assert row["mean_low"] == pytest.approx(1.0 - half)
    assert (row["least"], row["median"], row["greatest"]) == (0.8, 0.9, 1.3)
    assert row["worst_seed"] == 2  # farthest from theory
    assert row["worst"] == 1.3
    low = value_row("distance_m", records, 0.9, -1)
    assert low is not None and low["worst_seed"] == 0
    high = value_row("distance_m", records[:2], None, 1)
    assert high is not None and high["worst_seed"] == 1


def test_a_value_without_records_is_left_out() -> None:
    assert value_row("misled_s", [made(1)], None, 1) is None
    assert "misled_s" not in summarise_duels(SETTINGS, [made(1)])["figures"]


def test_outcomes_and_convergence_are_counted() -> None:
    records = [
        made(1),
        made(2, converged_at_s=None),
        made(3, outcome="fall", message="evader fell", converged_at_s=None),
    ]
    summary = summarise_duels(SETTINGS, records)
    assert summary["outcomes"]["completed"]["number"] == 2
    assert summary["outcomes"]["fall"]["of"] == 3
    assert summary["outcomes"]["contact"]["number"] == 0
    assert summary["on_the_circle"]["number"] == 1
    assert summary["not_on_the_circle"] == [2]
    assert summary["not_completed"] == [
        {"seed": 3, "outcome": "fall", "message": "evader fell"}
    ]
    assert summary["figures"]["distance_m"]["number"] == 2
    assert summary["theory"]["radius_m"] == pytest.approx(0.6366198)


@pytest.mark.parametrize("duration", [60.0, 120.0])
def test_in_time_is_before_the_last_third(duration: float) -> None:
    """The rule of the claims page; the last 5 s count otherwise."""
    settings = replace(SETTINGS, duration=duration)
    limit = duration * 2.0 / 3.0
    since = (None, 0.0, limit - 0.1, limit, duration - 5.0)
    records = [made(n, converged_at_s=s) for n, s in enumerate(since)]
    summary = summarise_duels(settings, records)
    assert summary["on_the_circle"]["number"] == 4
    assert summary["on_the_circle_in_time"]["number"] == 2
    assert summary["on_the_circle_in_time"]["of"] == 5
    assert summary["on_the_circle_by_s"] == pytest.approx(limit)


def test_a_share_has_wilsons_interval() -> None:
    found = proportion([True] * 1000)
    assert found["number"] == found["of"] == 1000
    assert found["low"] == pytest.approx(0.99617, abs=1e-5)
    assert found["high"] == pytest.approx(1.0)


def test_approaches_are_held_against_the_certificate() -> None:
    records = [
        made(1, certified_m=0.4, evading_min_distance_m=0.5),
        made(2, certified_m=0.5, evading_min_distance_m=0.48),
        made(3),
    ]
    row = certificate_row(records)
    assert row["certified"]["number"] == 2 and row["certified"]["of"] == 3
    assert row["nearer_than_certified"]["number"] == 1
    assert row["least_excess_m"] == pytest.approx(-0.02)
    assert row["median_excess_m"] == pytest.approx(0.04)
    assert row["worst_seed"] == 2
    assert certificate_row([made(1)])["worst_seed"] is None


def test_the_command_writes_records_summary_and_figure(
    tmp_path: Path, inline_workers: None
) -> None:
    folder = tmp_path / "out"
    line = ["--seeds", "5:7", "--duration", "0.5", "--workers", "1"]
    answer = CliRunner().invoke(
        duels, [*line, "--json", "--output", str(folder)]
    )
    assert answer.exit_code == 0, answer.output
    found = json.loads(answer.stdout)
    assert found["seeds"] == "5:7" and found["summary"]["duels"] == 2
    assert found == json.loads((folder / "summary.json").read_text())
    assert count_records(folder / "duels.sqlite") == 2
    assert (folder / "duels.png").stat().st_size > 1000
    table = CliRunner().invoke(duels, [*line, "--output", str(folder)])
    assert "completed" in table.output and "2 of 2" in table.output


@pytest.mark.parametrize(
    "bad", ["", "a", "-1:3", "3:3", "5:2", "0:99999999", "1:2:3", "1.5"]
)
def test_invalid_seeds_are_refused(bad: str) -> None:
    answer = CliRunner().invoke(duels, ["--seeds", bad, "--json"])
    assert answer.exit_code == 2
    assert "FIRST" in answer.output and "got" in answer.output


CHILD = """
import os, signal, sys, time
from concurrent.futures import as_completed
from stepaside.core.worker_pool import cancel_pending, worker_pool

def stay(number):
    print(os.getpid(), flush=True)
    time.sleep(300)

if __name__ == "__main__":
    # A background shell ignores Ctrl-C, and so would the child.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with worker_pool(1) as pool:
            futures = [pool.submit(stay, number) for number in range(20)]
            try:
                list(as_completed(futures))
            except BaseException:
                cancel_pending(pool, futures)
                raise
    except KeyboardInterrupt:
        sys.exit(130)
"""


@pytest.mark.parametrize(
    ("how", "everyone"),
    [(signal.SIGKILL, False), (signal.SIGINT, False), (signal.SIGINT, True)],
)
def test_workers_end_with_their_parent(
    tmp_path: Path, how: signal.Signals, everyone: bool
) -> None:
    """However it ends; their output is at its end when all are gone.

    A terminal's Ctrl-C reaches the workers, too; either way nothing of the
    twenty that were waiting begins, and nothing is complained of.
    """
    script = tmp_path / "child.py"
    script.write_text(CHILD)
    with subprocess.Popen(
        [sys.executable, str(script)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        start_new_session=True,
        text=True,
    ) as parent:
        assert parent.stdout is not None and parent.stderr is not None
        assert int(parent.stdout.readline()) > 0
        if everyone:
            os.killpg(parent.pid, how)
        else:
            parent.send_signal(how)
        assert parent.stdout.read() == ""
        complaints = parent.stderr.read()
    if how is signal.SIGINT:
        assert parent.returncode == 130
        assert complaints == ""
