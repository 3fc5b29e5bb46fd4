"""What a walk has other than by default, as text that names it."""

import json
from dataclasses import replace
from functools import cache
from typing import Any

from ..games.configuration_file import parse_settings, plain_settings
from ..games.walk_settings import WalkSettings
from ..sim.body_settings import BODIES

OWN = "own"  # body that is no preset


def changes_of(walk: WalkSettings) -> tuple[str, str]:
    """Name of a walk's body, and what else it has other than by default.

    What each trial of a campaign sets itself is left out: seed, duration,
    method, feedback and pushes.

    Args:
        walk: That is to be disturbed.

    Returns:
        Preset of the body, or ``OWN``, and the changes as JSON; empty for
        none.
    """
    default = WalkSettings()
    presets = [name for name, body in BODIES.items() if body == walk.body]
    plain = replace(
        walk,
        seed=default.seed,
        duration=default.duration,
        pushes=default.pushes,
        body=default.body if presets else walk.body,
        control=replace(
            walk.control,
            method=default.control.method,
            feedback=default.control.feedback,
        ),
    )
    found = _differences(plain_settings(plain), plain_settings(default))
    return (presets or [OWN])[0], json.dumps(found) if found else ""


@cache
def changed_walk(changes: str) -> WalkSettings:
    """Walk with changes.

    Args:
        changes: Of :func:`changes_of`.
    """
    entries = json.loads(changes) if changes else {}
    return parse_settings(WalkSettings, entries, "changes of a walk")


def _differences(
    entries: dict[str, Any], default: dict[str, Any]
) -> dict[str, Any]:
    """Entries that are not as by default, section by section.

    What is None by default has no entry there.
    """
    found = {}
    for name, value in entries.items():
        if isinstance(value, dict):
            value = _differences(value, default[name])
            if value:
                found[name] = value
        elif name not in default or value != default[name]:
            found[name] = value
    return found
