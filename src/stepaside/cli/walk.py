"""``stepaside walk``: the walk of one humanoid, with pushes."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..games.walk_settings import WalkSettings
from .options.common_options import figure_option, folder_option, json_option
from .options.settings_options import WALK, takes_settings
from .output_files import attempt, writes_files
from .progress import SIMULATED, announce_effort, show_progress
from .run_output import check_run_folder, save_run
from .tables import print_table
from .terminal import print_json

if TYPE_CHECKING:
    from ..games.run import WalkRun


@click.command("walk")
@takes_settings(WalkSettings, WALK)
@folder_option(help="Run folder; the run is not saved by default.")
@figure_option()
@json_option
@writes_files
def walk(
    settings: WalkSettings,
    output: Path | None,
    figure: str | None,
    as_json: bool,
) -> None:
    """Simulate the walk of one humanoid and measure it.

    Speed, turning, slip, tracking error and estimation error are measured
    after the first three seconds, in the frame of the support foot.
    `stepaside show` replays the run folder.
    """
    from ..games.outcome import Outcome
    from ..games.run_archive import results_of

    check_run_folder(output)
    seconds = settings.duration
    announce_effort(f"a walk of {seconds:g} s", seconds / SIMULATED)
    run = _walk(settings)
    saved = save_run(output, run)
    if figure is not None and run.outcome is not Outcome.INTERRUPTED:
        from ..report.run_figure import draw_run

        attempt(lambda: draw_run(run, Path(figure)))
    summary = results_of(run) | saved.entries
    if as_json:
        print_json(summary)
    else:
        _print(summary)
        saved.print_paths(f"{run.game}.png")
    saved.raise_failure()
    saved.exit_if_interrupted(run.outcome)


def _walk(settings: WalkSettings) -> "WalkRun":
    """Walk with a progress bar on standard error."""
    from ..games.game import Progress
    from ..games.recorded_game import run_walk

    look = "{desc} {bar} {n:.0f}/{total:.0f} s simulated"
    total = settings.duration
    with show_progress("walk", total, "s simulated", bar_format=look) as bar:

        def report(progress: Progress) -> None:
            bar.n = progress.time
            bar.refresh()

        result = run_walk(settings, report)
        bar.n = result.duration
    return result


def _print(summary: dict[str, Any]) -> None:
    def number(value: float | None, text: str, scale: float = 1.0) -> str:
        return "-" if value is None else text.format(scale * value)

    def rms(group: str, name: str, text: str, scale: float) -> str:
        error = summary[group][name]
        return "-" if error is None else text.format(scale * error["rms"])

    print_table(
        [
            (
                "outcome",
                f"{summary['outcome']} after {summary['duration_s']:.2f} s",
            ),
            (
                "steps",
                f"{summary['steps']}, {summary['adapted_steps']} adapted by "
                "feedback",
            ),
            ("speed", number(summary["speed_m_s"], "{:.4f} m/s")),
            ("speed / planned", number(summary["speed_ratio"], "{:.3f}")),
            ("turning / planned", number(summary["yaw_ratio"], "{:.3f}")),
            (
                "slip per step",
                number(summary["slip_per_step_m"], "{:.2f} mm", 1e3),
            ),
            (
                "CoM error",
                rms("tracking", "com_x_m", "{:.2f}", 1e3)
                + rms("tracking", "com_y_m", " / {:.2f} mm rms", 1e3),
            ),
            (
                "estimation error",
                rms("estimation", "com_x_m", "{:.2f}", 1e3)
                + rms("estimation", "com_y_m", " / {:.2f} mm rms", 1e3),
            ),
            ("maximum tilt", number(summary["tilt_max_deg"], "{:.2f} deg")),
            (
                "ZMP margin",
                number(summary["min_zmp_margin_m"], "{:.1f} mm", 1e3),
            ),
            (
                "simulation speed",
                f"{summary['real_time_factor']:.1f} x real time",
            ),
        ]
    )
