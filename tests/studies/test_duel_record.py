"""Test the record of a duel, and workers that end with their parent."""

import json
import os
import signal
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from stepaside.games.game_settings import StartSettings, duel
from stepaside.strategies import Evasion
from stepaside.studies.study_games import play_duel


def test_a_record_holds_the_figures_of_its_duel() -> None:
    start = StartSettings(distance=0.7)
    settings = duel(seed=3, duration=2.0, start=start)
    record, again = play_duel(settings), play_duel(settings)
    assert record["seed"] == 3 and record["outcome"] == "completed"
    assert record["triggered_at_s"] == 0.004  # at the first tick
    assert 0.5 < record["evading_min_distance_m"] < 0.75
    assert record["evading_min_distance_m"] >= record["min_distance_m"]
    assert json.loads(json.dumps(record, allow_nan=False)) == record
    for name in ("distance_m", "min_distance_m", "players.evader.path_m"):
        assert record[name] == again[name]
    other = play_duel(replace(settings, seed=4))
    assert other["distance_m"] != record["distance_m"]


def test_only_a_certified_start_has_a_certified_distance() -> None:
    facing = StartSettings(0.75, 0.0, 0.0)
    blind = StartSettings(0.75, 3.0, 3.0)
    settings = duel(duration=0.1, start=facing)
    record = play_duel(settings)
    assert 0.3 < record["certified_m"] < 0.75
    over = record["evading_min_distance_m"] - record["certified_m"]
    assert record["nearer_than_certified"] is (over < 0.0)
    for changes in (
        {"start": blind},
        {"evasion": Evasion(saturated=True)},
        {"evasion": Evasion(angle=0.0)},
    ):
        record = play_duel(settings.changed(**changes))
        assert record["certified_m"] is None
        assert record["nearer_than_certified"] is None


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
