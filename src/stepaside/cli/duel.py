"""``stepaside duel``: a duel of two humanoids in physics."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..core.constants import CAPTURE_DISTANCE
from .effort_estimate import SIMULATED, announce_effort
from .options.common_options import (
    figure_option,
    figure_width,
    folder_option,
    json_option,
)
from .options.duel_options import duel_options
from .options.settings_command import SettingsCommand
from .output_files import attempt, writes_files
from .progress import show_progress
from .run_output import save_run
from .tables import print_table
from .terminal import echo, print_json

if TYPE_CHECKING:
    from ..games.duel_settings import DuelSettings
    from ..games.run import DuelRun


@click.command("duel", cls=SettingsCommand)
@duel_options()
@folder_option(
    help="Run folder; a new one in runs/ by default, none with --json."
)
@figure_option(help="Write a copy of the figure (.png, .svg or .pdf).")
@figure_width
@json_option
@writes_files
def duel(
    settings: "DuelSettings",
    output: Path | None,
    figure: str | None,
    as_json: bool,
) -> None:
    """Simulate a duel of two humanoids in physics.

    Prints values measured over the last third of the duel beside those of
    theory, and writes a run folder with the configuration, the trajectories
    and a figure.
    """
    from ..games.outcome import Outcome
    from ..games.run_archive import results_of
    from ..report.run_folder import check_output, figure_name, free_folder
    from ..report.settling_report import explain_missing_circle

    if output is None and not as_json:
        output = free_folder(Path("runs"), f"duel-seed{settings.seed}")
    if output is not None:
        check_output(output)
    seconds = settings.duration
    announce_effort(f"a duel of {seconds:g} s", seconds / SIMULATED)
    _warn_of_expected_end(settings)
    run = _play(settings)
    saved = save_run(output, run)
    if figure is not None and run.outcome is not Outcome.INTERRUPTED:
        from ..report.duel_figure import draw_duel

        attempt(lambda: draw_duel(run, Path(figure)))
    summary = results_of(run) | saved.entries
    if as_json:
        print_json(summary)
    else:
        _print(summary, explain_missing_circle(run))
        saved.print_paths(figure_name(run))
    saved.raise_failure()
    saved.exit_if_interrupted(run.outcome)


def _warn_of_expected_end(settings: "DuelSettings") -> None:
    """Print a warning if two robots are not expected to reach a circle."""
    from ..games.forecast import ExpectedEnd, forecast
    from ..games.initial_poses import with_initial_poses

    end = forecast(with_initial_poses(settings))
    if end and end.expected in (ExpectedEnd.CONTACT, ExpectedEnd.NO_CIRCLE):
        echo(f"stepaside: expected outcome: {end.words}", err=True)


def _play(settings: "DuelSettings") -> "DuelRun":
    """Run the duel with a progress bar on standard error."""
    from ..games.duel import run_duel
    from ..games.match import Progress

    look = "{desc} {bar} {n:.0f}/{total:.0f} s simulated{postfix}"
    total = settings.duration
    with show_progress("duel", total, "s simulated", bar_format=look) as bar:

        def report(progress: Progress) -> None:
            bar.n = progress.time
            bar.set_postfix_str(
                f"distance {progress.distance:.2f} m, "
                f"{progress.real_time_factor:.1f}x real time"
            )

        result = run_duel(settings, report)
        bar.n = min(result.duration, settings.duration)
        bar.refresh()
    return result


def _print(summary: dict[str, Any], unsettled: str = "not reached") -> None:
    theory, converged = summary["theory"], summary["converged_at_s"]

    def compared(
        value: float | None, expected: float | None, unit: str
    ) -> str:
        text = "-" if value is None else f"{value:.3f} {unit}"
        if expected is None:
            return text
        return f"{text:<12} theory {expected:.3f}"

    def settled(value: float | None, expected: float | None, unit: str) -> str:
        """Format a value of the circle; mark it if not yet converged."""
        text = compared(value, expected, unit)
        reached = expected is None or converged is not None
        return text if reached else f"{text}, not converged"

    plans = summary["plan_time_us"]
    start = summary["start"]
    rows = [
        ("outcome", f"{summary['outcome']}: {summary['message']}"),
        ("start distance", f"{start['distance_m']:.3f} m"),
        ("expected", theory["words"] or "-"),
        (
            "pursuer radius",
            settled(
                summary["pursuer"]["radius_m"],
                theory["pursuer_radius_m"],
                "m",
            ),
        ),
        (
            "evader radius",
            settled(summary["evader"]["radius_m"], theory["radius_m"], "m"),
        ),
        (
            "distance",
            settled(summary["distance_m"], theory["distance_m"], "m"),
        ),
        (
            "angle between headings",
            settled(
                summary["relative_orientation_deg"],
                theory["relative_orientation_deg"],
                "deg",
            ),
        ),
        (
            "closest approach",
            compared(
                summary["min_distance_m"], theory["closest_approach_m"], "m"
            ),
        ),
        ("captured", _capture_text(summary["captured_at_s"])),
        (
            "on the circle",
            unsettled if converged is None else f"since {converged:.1f} s",
        ),
        ("maneuvers planned", str(summary["replans"])),
        (
            "planning time",
            "-"
            if plans["median"] is None
            else f"{plans['median']:.0f} us median, {plans['p99']:.0f} us p99",
        ),
        ("simulation speed", f"{summary['real_time_factor']:.1f} x real time"),
    ]
    rows += [("note", note) for note in summary["notes"]]
    if summary["sight"] is not None:
        rows += _sight_rows(summary)
    print_table(rows)


def _capture_text(time: float | None) -> str:
    """Return when the distance first fell to the capture distance."""
    text = "no" if time is None else f"at {time:.1f} s"
    return f"{text:<12} distance <= {CAPTURE_DISTANCE:.2f} m"


def _sight_rows(summary: dict[str, Any]) -> list[tuple[str, str]]:
    """Return the quality of camera sensing, as rows of the table."""
    sight = summary["sight"]
    rows = [("camera", sight["camera"])]
    for name in ("pursuer", "evader"):
        own = summary[name]["sight"]
        error = {"median": None} if own is None else own["bearing_error_deg"]
        if error["median"] is not None:
            text = f"{error['median']:.2f} deg median, {error['p95']:.2f} p95"
            rows.append((f"{name}'s bearing error", text))
    distance_error = summary["evader"]["sight"]["distance_error_m"]["median"]
    if distance_error is not None:
        text = f"{distance_error:.3f} m median"
        rows.append(("evader's distance error", text))
    triggered = summary["triggered_at_distance_m"]
    rate = sight["detection_rate"]
    rows += [
        (
            "evasion triggered at",
            "never" if triggered is None else f"{triggered:.3f} m",
        ),
        ("detection rate", "-" if rate is None else f"{100.0 * rate:.1f} %"),
        ("false detections", str(sight["false_detections"])),
        ("opponent lost for", f"{sight['lost_s']:.1f} s"),
    ]
    return rows
