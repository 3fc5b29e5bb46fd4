"""``stepaside robot tune``: the steadiest way to walk, found by walking."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..core.atomic_output import writing
from .interruption import kept_in, leave_stopped
from .options.common_options import WORKERS, json_option
from .progress import show_progress
from .terminal import echo
from .value_types import print_json, print_table

if TYPE_CHECKING:
    from ..fitting.gait_search import RatedCandidate, SearchResult
    from ..robots.description import RobotDescription

KEPT = "tune.jsonl"


@click.command("tune")
@click.argument(
    "folder", type=click.Path(exists=True, file_okay=False, path_type=Path)
)
@WORKERS.option()
@json_option
def tune(folder: Path, workers: int | None, as_json: bool) -> None:
    """Find how the robot in FOLDER walks most steadily, and write it.

    Tries servo gains, durations of the supports, stride, spacing, lean, place
    of the ZMP, CoM height, and feedback, in short walks on all cores. What it
    finds goes into the description, with what was measured. Each walk is
    kept in FOLDER/tune.jsonl: a search that was stopped goes on from there.
    """
    from ..fitting.description_edit import rewritten
    from ..robots.description import FILE, load_robot

    description = load_robot(folder)
    tuned = _search(description, folder / KEPT, workers)
    best = tuned.best.candidate.applied(description)
    assert best is not None
    changed = tuned.best.candidate != tuned.before.candidate
    if changed:
        file = folder / FILE
        text = file.read_text(encoding="utf-8")
        with writing(file) as draft:
            draft.write_text(
                rewritten(text, best, _words(tuned)), encoding="utf-8"
            )
    facts = {
        "robot": description.name,
        "changed": changed,
        "tried": tuned.tried,
        "before": _plain(tuned.before),
        "best": _plain(tuned.best),
        "gait": dict(best.gait),
    }
    if as_json:
        print_json(facts)
    else:
        _print(tuned, folder, changed)
    if tuned.best.unsteadiness >= 1.0:
        raise SystemExit(1)


def _search(
    description: "RobotDescription", kept: Path, workers: int | None
) -> "SearchResult":
    """Search with a progress bar on standard error."""
    from ..core.worker_pool import worker_pool
    from ..fitting.gait_search import GaitSearch

    with (
        worker_pool(workers) as executor,
        show_progress("tune", unit="gaits") as bar,
    ):

        def report(tried: int, of: int, least: float) -> None:
            bar.n, bar.total = tried, of
            bar.set_postfix_str(f"unsteadiness {least:.2f}")

        try:
            return GaitSearch(description, executor, kept, report).run()
        except KeyboardInterrupt:
            leave_stopped(kept_in(f"{bar.n} gaits", kept))


def _plain(judged: "RatedCandidate") -> dict[str, Any]:
    return {
        "changes": judged.candidate.to_json(),
        "unsteadiness": judged.unsteadiness,
        "walks": list(judged.walks),
    }


def _words(tuned: "SearchResult") -> list[str]:
    """What was measured, line by line."""
    before, best = tuned.before, tuned.best
    changes = [
        f"{name} {value:g}"
        for name, value in best.candidate.to_json().items()
        if value != before.candidate.to_json()[name]
    ]
    lines = [
        f"{', '.join(changes) or 'nothing changed'};",
        f"unsteadiness {before.unsteadiness:.2f} before, "
        f"{best.unsteadiness:.2f} after (1 is the most of a steady walk),",
        f"of {tuned.tried} gaits tried.",
    ]
    for walk in best.walks:
        if walk["completed"]:
            lines.append(
                f"{walk['way']}: tilt {walk['tilt']:.2f} deg, speed "
                f"{walk['speed']:.3f} of what was planned"
            )
    return lines


def _print(tuned: "SearchResult", folder: Path, changed: bool) -> None:
    rows = [
        ("gaits tried", str(tuned.tried)),
        ("unsteadiness before", f"{tuned.before.unsteadiness:.2f} of 1"),
        ("unsteadiness now", f"{tuned.best.unsteadiness:.2f} of 1"),
    ]
    rows += [
        (name, f"{value:g}")
        for name, value in tuned.best.candidate.to_json().items()
    ]
    print_table(rows)
    if changed:
        echo(f"\nwrote {folder}/robot.toml")
    elif tuned.tried == 1:
        echo(
            "\nit walks steadily already, so nothing else was tried (tune "
            "betters steadiness, not torques): the description stays as it is"
        )
    else:
        echo("\nnothing tried was better: the description stays as it is")
