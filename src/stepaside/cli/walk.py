"""``stepaside run walk``: the walk of one humanoid, with pushes."""

from pathlib import Path
from typing import Any

import click

from ..games.walk_settings import WalkSettings
from .options import folder_option, json_option
from .run_output import finish_run, play_with_bar, run_folder
from .settings import takes_settings
from .tables import print_table

NAMED = {
    "--seed": "seed",
    "--duration": "duration",
    "--robot": "robot",
    "--gait": "gait",
    "--body": "body",
    "--bearing": "bearing",
    "--push": "pushes",
}


@click.command("walk")
@takes_settings(NAMED, settings=WalkSettings)
@folder_option(help="Run folder; the run is not saved by default.")
@json_option
def walk(settings: WalkSettings, output: Path | None, as_json: bool) -> None:
    """Simulate the walk of one humanoid and measure it.

    Speed, turning, slip, tracking error and estimation error are measured
    after the first three seconds, in the frame of the support foot.
    """
    from ..games.recorded_game import run_walk
    from ..games.run_archive import results_of

    folder = run_folder(output, as_json, None)
    run = play_with_bar(settings, run_walk)
    finish_run(run, folder, as_json, lambda: _print(results_of(run)))


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
