"""``stepaside robot tune``: search for the steadiest gait in simulation."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..core.atomic_output import atomic_draft
from ..core.progress import show_progress
from .options import json_option, workers_option
from .study_output import executor_option
from .tables import print_table
from .terminal import echo, exit_interrupted, print_json, resume_message

if TYPE_CHECKING:
    from ..fitting.gait_search import RatedCandidate, SearchResult
    from ..robots.description import RobotDescription

RECORDS = "tune.sqlite"


@click.command("tune")
@click.argument(
    "folder", type=click.Path(exists=True, file_okay=False, path_type=Path)
)
@workers_option
@executor_option
@json_option
def tune(
    folder: Path, workers: int | None, executor: str, as_json: bool
) -> None:
    """Find the steadiest gait of the robot in FOLDER and store it.

    Varies servo gains, support durations, stride, foot spacing, lean, ZMP
    position, CoM height and feedback in short simulated walks on all cores.
    The best gait is written to the description with its measurements. Walks
    are recorded in FOLDER/tune.sqlite, so that an interrupted search can be
    continued with the same command.
    """
    from ..fitting.description_writer import rewrite_description
    from ..robots.description import FILE, load_robot

    description = load_robot(folder)
    tuned = _search(description, folder / RECORDS, workers, executor)
    best = tuned.best.candidate.applied(description)
    assert best is not None
    changed = tuned.best.candidate != tuned.before.candidate
    if changed:
        file = folder / FILE
        text = file.read_text(encoding="utf-8")
        with atomic_draft(file) as draft:
            draft.write_text(
                rewrite_description(text, best, _comment_lines(tuned)),
                encoding="utf-8",
            )
    facts = {
        "robot": description.name,
        "changed": changed,
        "tried": tuned.tried,
        "before": _to_json(tuned.before),
        "best": _to_json(tuned.best),
        "gait": dict(best.gait),
    }
    if as_json:
        print_json(facts)
    else:
        _print(tuned, folder, changed)
    if tuned.best.unsteadiness >= 1.0:
        raise SystemExit(1)


def _search(
    description: "RobotDescription",
    records: Path,
    workers: int | None,
    executor: str,
) -> "SearchResult":
    """Search with a progress bar on standard error."""
    from ..fitting.gait_search import search_gait
    from ..studies.executors import open_executor

    with (
        open_executor(executor, workers) as opened,
        show_progress("tune", unit="gaits") as bar,
    ):

        def report(tried: int, of: int, least: float) -> None:
            bar.n, bar.total = tried, of
            bar.set_postfix_str(f"unsteadiness {least:.2f}")

        try:
            return search_gait(description, opened, records, report)
        except KeyboardInterrupt:
            exit_interrupted(resume_message(f"{bar.n} gaits", records))


def _to_json(rated: "RatedCandidate") -> dict[str, Any]:
    return {
        "changes": rated.candidate.to_json(),
        "unsteadiness": rated.unsteadiness,
        "walks": list(rated.walks),
    }


def _comment_lines(tuned: "SearchResult") -> list[str]:
    """Return the measurements as lines of a comment."""
    before, best = tuned.before, tuned.best
    changes = [
        f"{name} {value:g}"
        for name, value in best.candidate.to_json().items()
        if value != before.candidate.to_json()[name]
    ]
    lines = [
        f"{', '.join(changes) or 'nothing changed'};",
        f"unsteadiness {before.unsteadiness:.2f} before, "
        f"{best.unsteadiness:.2f} after (steady below 1),",
        f"best of {tuned.tried} gaits.",
    ]
    for walk in best.walks:
        if walk["completed"]:
            lines.append(
                f"{walk['way']}: tilt {walk['tilt']:.2f} deg, speed "
                f"{walk['speed']:.3f} of the planned one"
            )
    return lines


def _print(tuned: "SearchResult", folder: Path, changed: bool) -> None:
    rows = [
        ("gaits tried", str(tuned.tried)),
        ("unsteadiness before", f"{tuned.before.unsteadiness:.2f}"),
        ("unsteadiness after", f"{tuned.best.unsteadiness:.2f}"),
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
            "\nthe gait is steady already (tune improves steadiness, not "
            "torques): the description is unchanged"
        )
    else:
        echo("\nno better gait was found: the description is unchanged")
