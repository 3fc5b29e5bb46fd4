"""Games of commands: played with a progress bar, saved and reported."""

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..core.progress import ProgressLine
from ..report.result_labels import label_of, unit_of
from .tables import format_value, print_table
from .terminal import NOTHING_SAVED, echo, exit_interrupted, print_json

if TYPE_CHECKING:
    from ..games.game import Progress
    from ..games.run import Run
    from ..games.summary import Summary

MOST_PAIRS = 15  # that are all printed
ERRORS = ("tracking", "estimation")  # of a walk: only in JSON


def run_folder(
    output: Path | None, as_json: bool, name: str | None
) -> Path | None:
    """Return the folder of a run, checked; None if it is not saved.

    Without an ``output`` it is a new folder in ``runs`` of a name, if any.

    Raises:
        ConfigurationError: If the folder is not empty or not writable.
    """
    from ..report.run_folder import check_output, free_folder

    if output is None and name is not None and not as_json:
        output = free_folder(Path("runs"), name)
    if output is not None:
        check_output(output)
    return output


def play_with_bar(
    settings: Any, play: Callable[[Any, "Callable[[Progress], None]"], "Run"]
) -> "Run":
    """Play a game with a progress bar on standard error."""
    total = settings.duration
    with ProgressLine(settings.game, total, "s simulated") as bar:

        def report(progress: "Progress") -> None:
            text = f"{progress.real_time_factor:.1f}x real time"
            if progress.distance is not None:
                text = f"distance {progress.distance:.2f} m, {text}"
            bar.show(progress.time, text=text)

        run = play(settings, report)
        bar.show(min(run.duration, total))
    return run


def print_run(run: "Run") -> None:
    """Print the summary of a run, with values of theory beside those of it.

    Of many pairs only those of players that decide; JSON has all.
    """
    found = run.results()
    theory = found.pop("theory") or {}
    rows = [("outcome", f"{run.outcome.value}: {run.message}")]
    for name in ("outcome", "message", "seed", "duration_s"):
        del found[name]
    if run.game == "duel":
        since = found.pop("converged_at_s")
        missing = since is None and _missing_circle(run.summary)
        rows.append(("on the circle", missing or f"since {since:.1f} s"))
        begin = 2.0 / 3.0 * run.duration
        if since is not None and since > begin:
            rows.append(("means", f"measured from {begin:.1f} s on"))
        rows.append(("expected", theory["words"] or "-"))
    radii = {
        "pursuer": {"radius_m": theory.get("pursuer_radius_m")},
        "evader": {"radius_m": theory.get("radius_m")},
    }
    groups = [
        (name, _facts(own, radii.get(name)))
        for name, own in found.pop("players").items()
    ]
    pairs, others = found.pop("pairs"), {*run.players} - {*run.deciding}
    for names, pair in pairs.items() if len(run.players) > 2 else ():
        if len(pairs) <= MOST_PAIRS or not others.issuperset(
            names.split(" - ")
        ):
            groups.append((names, _facts(pair)))
    for name, value in found.items():
        if isinstance(value, Mapping):
            groups.append((name, _facts(value)))
        elif isinstance(value, list):
            rows += [(name, ", ".join(value))] if value else []
        else:
            facts = _facts({name: value}, theory, labelled=False)
            rows += [(label_of(name), fact) for fact in facts]
    print_table([*rows, *((name, ", ".join(own)) for name, own in groups)])


def _missing_circle(summary: "Summary") -> str:
    """Return why a duel did not end on its circle."""
    theory = summary.theory
    if theory is None or theory.expected in ("contact", "no circle"):
        return "not expected"
    if summary.triggered_at_s is None:
        return "not reached: the evader was never triggered"
    if theory.circle_since_s is not None:
        since = f"{theory.circle_since_s:.0f} s"
        return f"not reached: the template reaches it at {since}"
    return "not reached"


def _facts(
    values: Mapping[str, Any],
    theory: Mapping[str, Any] | None = None,
    within: str = "",
    *,
    labelled: bool = True,
) -> list[str]:
    """Return values as texts with labels and units; without tables.

    Args:
        values: Values by name, and groups of values.
        theory: Values of theory by name.
        within: Name of their group; its unit is that of the values.
        labelled: Whether the texts begin with labels.
    """
    facts: list[str] = []
    for name, value in values.items():
        if isinstance(value, Mapping) and name not in ERRORS:
            facts += _facts(value, within=name if unit_of(name) else "")
        elif isinstance(value, bool | int | float | str):
            text = format_value(within or name, value, 4)
            label = label_of(name)
            if within:
                label = f"{within.rpartition('_')[0].replace('_', ' ')} {name}"
            expected = (theory or {}).get(name)
            if expected is not None:
                text += f" (theory {format_value(name, expected, 4)})"
            facts.append(f"{label} {text}" if labelled else text)
    return facts


def finish_run(
    run: "Run",
    folder: Path | None,
    as_json: bool,
    show: Callable[[], None] | None = None,
    results: Any = None,
) -> None:
    """Save and print a run; exit as its outcome and its saving require.

    A run that cannot be saved where requested is saved in the temporary
    folder.

    Args:
        run: The run.
        folder: Folder to write; None to save nothing.
        as_json: Whether to print one JSON object.
        show: Prints the summary, if not as :func:`print_run`.
        results: Results for JSON; those of the run by default.

    Raises:
        OutputError: If the run could not be written to the folder.
    """
    from ..games.outcome import Outcome
    from ..report.run_folder import figure_name, save_run

    failed = None
    if folder is not None:
        requested = folder
        folder, failed = save_run(requested, run)
        if failed is not None and folder is not None:
            echo(
                f"stepaside: cannot write to {requested}; the run is saved "
                f"in {folder}",
                err=True,
            )
    if as_json:
        saved = {} if folder is None else {"run_folder": str(folder)}
        print_json((results or run.results()) | saved)
    else:
        (show or partial(print_run, run))()
        if folder is not None:
            figure = folder / figure_name(run)
            echo(f"\nfigure:     {figure}" if figure.exists() else "")
            echo(f"run folder: {folder}")
    if failed is not None:
        raise failed
    if run.outcome is Outcome.INTERRUPTED:
        exit_interrupted(
            f"{NOTHING_SAVED} without --output"
            if folder is None
            else f"the run so far is saved in {folder}"
        )
