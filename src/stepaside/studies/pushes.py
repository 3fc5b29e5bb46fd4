"""The largest pushes of a campaign, with all that they depend on."""

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from ..planning import GaitSettings
from .limits import RESOLUTION
from .survival import PUSH, summarise_limits, walking_reach
from .version import PHYSICS, code_version, library_versions


def pushes_result(
    rows: Sequence[dict[str, Any]],
    methods: Sequence[str],
    body: str,
    *,
    phases: int,
    seed: int,
) -> dict[str, Any]:
    """Rows of limits with the command, the version and the settings.

    Args:
        rows: Of :func:`~stepaside.studies.survival.limit_rows`.
        methods: That were tried.
        body: Preset of the body.
        phases: Of the gait cycle at which pushes begin.
        seed: Of every walk.

    Returns:
        What can be written as JSON.
    """
    asked = " ".join(f"--method {method}" for method in methods)
    return {
        "command": f"stepaside robustness --kind push {asked} "
        f"--body {body} --phases {phases} --seed {seed}",
        "version": code_version(PHYSICS),
        "libraries": library_versions(),
        "settings": {
            "body": body,
            "phases": phases,
            "seed": seed,
            "push_duration_s": PUSH,
            "resolution_n_s": RESOLUTION,
            "reach_m": walking_reach()._asdict(),
            "gait": asdict(GaitSettings()),
        },
        "summary": summarise_limits(rows),
        "rows": list(rows),
    }
