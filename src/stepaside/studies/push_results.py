"""The largest pushes of a campaign, with all that they depend on."""

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from ..games.walk_settings import WalkSettings
from .push_limits import RESOLUTION
from .result_files import header
from .robustness_campaign import mass_of
from .settings_diff import changes_of
from .survival import DEFAULT, PUSH, summarise_limits, walking_reach

ROOMS = ("studies/survival",)  # module that finds limits and the bounds


def pushes_result(
    rows: Sequence[dict[str, Any]],
    methods: Sequence[str],
    body: str,
    *,
    phases: int,
    seed: int,
    walk: WalkSettings = DEFAULT,
) -> dict[str, Any]:
    """Rows of limits with the command, the version and the settings.

    Args:
        rows: Of :func:`~stepaside.studies.survival.limit_rows`.
        methods: That were tried.
        body: Preset of the body.
        phases: Of the gait cycle at which pushes begin.
        seed: Of every walk.
        walk: That was pushed.

    Returns:
        What can be written as JSON.
    """
    asked = " ".join(f"--method {method}" for method in methods)
    settings = {
        "body": body,
        "phases": phases,
        "seed": seed,
        "push_duration_s": PUSH,
        "resolution_n_s": RESOLUTION,
        "reach_m": walking_reach(walk)._asdict(),
        "gait": asdict(walk.gait),
        "robot": walk.robot,
        "mass_kg": mass_of(walk.robot),
    }
    # Any other walk needs the file or the options that it was made by.
    command = (
        None
        if changes_of(walk)[1]
        else (
            f"stepaside robustness --kind push {asked} "
            f"--body {body} --phases {phases} --seed {seed}"
        )
    )
    return header(settings, rooms=ROOMS, command=command) | {
        "summary": summarise_limits(rows),
        "rows": list(rows),
    }
