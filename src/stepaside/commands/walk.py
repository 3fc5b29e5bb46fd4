"""``stepaside walk``: one humanoid walks, and somebody pushes it."""

import re
from math import isfinite
from typing import TYPE_CHECKING, Any

import click

from .body_options import (
    body_options,
    body_settings,
    floor_options,
    floor_settings,
)
from .options import ANGLE, SECONDS, json_option, print_json, print_table

if TYPE_CHECKING:
    from ..games.walk import WalkResult
    from ..world.push import Push

PUSH = re.compile(r"^(?P<impulse>[^@]+)@(?P<time>[^:]+):(?P<direction>.+)$")


class PushType(click.ParamType["Push"]):
    """A push: ``1.2@5:90deg`` is 1.2 N s at 5 s to the left."""

    name = "IMPULSE@TIME:DIRECTION"

    def convert(
        self,
        value: Any,
        param: click.Parameter | None,
        ctx: click.Context | None,
    ) -> "Push":
        """Parse a push."""
        from ..errors import StepAsideError
        from ..world.push import Push

        parts = PUSH.match(str(value))
        if parts is None:
            self.fail(
                "must be IMPULSE@TIME:DIRECTION [N s, s, angle] like "
                f"1.2@5:90deg, got {value!r}",
                param,
                ctx,
            )
        direction = ANGLE.convert(parts["direction"], param, ctx)
        numbers = []
        for name, unit in (("impulse", "N s"), ("time", "s")):
            try:
                number = float(parts[name])
            except ValueError:
                number = float("nan")
            if not isfinite(number):
                self.fail(
                    f"{name} must be a finite number [{unit}], "
                    f"got {parts[name]!r}",
                    param,
                    ctx,
                )
            numbers.append(number)
        try:
            return Push(numbers[0], numbers[1], direction)
        except StepAsideError as error:
            self.fail(str(error), param, ctx)


@click.command("walk")
@click.option("--seed", type=click.IntRange(0), default=1, show_default=True)
@click.option("--duration", type=SECONDS, default=20.0, show_default=True)
@click.option(
    "--bearing",
    type=ANGLE,
    default=0.0,
    help="Desired heading at every step: 0 goes straight, others circle.",
)
@click.option("--backward", is_flag=True, help="Walk backward.")
@click.option(
    "--push",
    "pushes",
    type=PushType(),
    multiple=True,
    help="Push the torso, any number of times: 1.2@5:90deg is 1.2 N s at "
    "5 s to the left.",
)
@body_options
@floor_options
@click.option("--robot", default="nao", help="Robot, or its folder.")
@json_option
def walk(as_json: bool, **options: Any) -> None:
    """Let one humanoid walk, and say how well it does.

    Speed, turning, slip, tracking and estimation are those after the first
    three seconds, in the frame of the support foot.
    """
    from ..games.walk import WalkSettings
    from ..games.walk_summary import summarise_walk

    body, control = body_settings(
        options.pop("body"), options.pop("method"), options.pop("feedback")
    )
    physics = floor_settings(options)
    settings = WalkSettings(
        body=body, control=control, physics=physics, **options
    )
    result = _walk(settings)
    summary = summarise_walk(result)
    if as_json:
        print_json(summary)
    else:
        _print(summary)
    if result.outcome == "interrupted":
        raise SystemExit(130)


def _walk(settings: Any) -> "WalkResult":
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
