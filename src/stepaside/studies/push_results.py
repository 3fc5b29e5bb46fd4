"""Result file of a campaign of largest pushes."""

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from ..games.walk_settings import WalkSettings
from .push_limits import RESOLUTION
from .result_files import header
from .robustness_trial import mass_of
from .settings_diff import changes_of
from .survival_statistics import DEFAULT, PUSH, foot_reach, summarise_limits


def pushes_result(
    rows: Sequence[dict[str, Any]],
    methods: Sequence[str],
    body: str,
    *,
    phases: int,
    seed: int,
    walk: WalkSettings = DEFAULT,
) -> dict[str, Any]:
    """Return the rows of limits with command, version and settings.

    Args:
        rows: Those of
            :func:`~stepaside.studies.survival_statistics.limit_rows`.
        methods: Control methods of the campaign.
        body: Preset of the body.
        phases: Number of phases of the gait cycle at which pushes begin.
        seed: Seed of every walk.
        walk: Settings of the walk.

    Returns:
        Values for JSON.
    """
    options = " ".join(f"--method {method}" for method in methods)
    settings = {
        "body": body,
        "phases": phases,
        "seed": seed,
        "push_duration_s": PUSH,
        "resolution_n_s": RESOLUTION,
        "reach_m": foot_reach(walk)._asdict(),
        "gait": asdict(walk.gait),
        "robot": walk.robot,
        "mass_kg": mass_of(walk.robot),
    }
    # A changed walk cannot be repeated by this command alone.
    command = (
        None
        if changes_of(walk)[1]
        else (
            f"stepaside robustness --kind push {options} "
            f"--body {body} --phases {phases} --seed {seed}"
        )
    )
    return header(settings, command) | {
        "summary": summarise_limits(rows),
        "rows": list(rows),
    }
