"""Drawing functions of the generated figures."""

import json
from pathlib import Path

import numpy as np

from .store import Store


def duel(store: Store, file: Path) -> None:
    """Draw the duel of the README from its stored trajectories."""
    from stepaside.games.duel_settings import DuelSettings
    from stepaside.games.run_archive import read_record
    from stepaside.report.run_figure import draw_run

    result = store.result("duel-seed7")
    with np.load(store.folder / result["trajectories"]["file"]) as arrays:
        tracks = {name: arrays[name] for name in arrays.files}
    settings = DuelSettings(seed=result["settings"]["seed"])
    run = read_record("duel-seed7", settings, result["summary"], tracks)
    draw_run(run, file)


def push_limits(store: Store, file: Path) -> None:
    """Draw push limits over the phase, with the pendulum's bound."""
    from stepaside.report.study_figures import draw_limits

    draw_limits(store.result("pushes")["rows"], file)


def people(store: Store, file: Path) -> None:
    """Draw the closest approach of people by the direction they come from."""
    from stepaside.report.study_figures import draw_people

    result = store.result("people-ideal")
    draw_people(result["origins"], result["clearance_m"], file)


UNITS = {
    "push": "N s",
    "friction": "1",
    "unevenness": "m",
    "delay": "cycles",
    "backlash": "deg",
    "noise": "times the preset",
    "model": "relative mass error",
}


def survival_on_hardware(store: Store, file: Path) -> None:
    """Draw survival over the strength of each disturbance."""
    from stepaside.report.study_figures import draw_survival

    rows = [
        # This result has a former name of backlash.
        row | {"kind": {"play": "backlash"}.get(row["kind"], row["kind"])}
        for row in store.result("survival-hardware")["survival"]
    ]
    draw_survival(rows, UNITS, file)


def many_duels(store: Store, file: Path) -> None:
    """Draw the distributions of the values of many duels, by kind."""
    from stepaside.report.study_figures import draw_duels

    groups = {}
    for kind in ("ideal", "hardware", "cameras"):
        lines = (store.folder / f"duels-{kind}.jsonl").read_text("utf-8")
        groups[kind] = [json.loads(line) for line in lines.splitlines()]
    draw_duels(groups, store.result("duels-ideal")["summary"], file)
