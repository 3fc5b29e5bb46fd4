"""``stepaside walk``: one humanoid walks, and somebody pushes it."""

from typing import TYPE_CHECKING, Any

import click

from .declared.body import BODY, CONTROL, PHYSICS
from .declared.common import json_option
from .declared.gait import GAIT, WALK
from .declared.game import RUN
from .declared.take import SettingsCommand, takes_settings
from .options import print_json, print_table

if TYPE_CHECKING:
    from ..games.walk import WalkRun, WalkSettings


def _walk_settings() -> "type[WalkSettings]":
    from ..games.walk import WalkSettings

    return WalkSettings


@click.command("walk", cls=SettingsCommand)
@takes_settings(_walk_settings, RUN, WALK, GAIT, BODY, CONTROL, PHYSICS)
@json_option
def walk(settings: "WalkSettings", as_json: bool) -> None:
    """Let one humanoid walk, and say how well it does.

    Speed, turning, slip, tracking and estimation are those after the first
    three seconds, in the frame of the support foot.
    """
    from ..games.walk_summary import summarise_walk

    result = _walk(settings)
    summary = summarise_walk(result)
    if as_json:
        print_json(summary)
    else:
        _print(summary)
    if summary["outcome"] == "interrupted":
        raise SystemExit(130)


def _walk(settings: "WalkSettings") -> "WalkRun":
    """Walk with a progress bar on standard error."""
    from tqdm import tqdm

    from ..games.walk import run_walk

    with tqdm(
        total=settings.duration,
        desc="walk",
        disable=None,
        bar_format="{desc} {bar} {n:.0f}/{total:.0f} s simulated",
    ) as bar:

        def report(time: float) -> None:
            bar.n = time
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
                f"{summary['steps']}, {summary['adapted_steps']} moved by "
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
            ("greatest tilt", number(summary["tilt_max_deg"], "{:.2f} deg")),
            (
                "ZMP margin",
                number(summary["min_zmp_margin_m"], "{:.1f} mm", 1e3),
            ),
            ("time", f"{summary['real_time_factor']:.1f} x real time"),
        ]
    )
