"""Difference of walk settings from the default, as JSON text."""

import json
from dataclasses import replace
from functools import cache
from typing import Any

from ..games.configuration_file import parse_settings, settings_entries
from ..games.walk_settings import WalkSettings
from ..locomotion.zmp.control_settings import OPEN_LOOP
from ..sim.body_settings import BODIES

OWN = "own"  # body that is no preset


def changes_of(walk: WalkSettings) -> tuple[str, str]:
    """Return the body preset of a walk and its other changed settings.

    Settings that each trial of a campaign sets are left out: seed, duration,
    method, feedback and pushes.

    Args:
        walk: Settings of the undisturbed walk.

    Returns:
        Preset of the body, or ``OWN``; and the changes as JSON, empty if
        there are none.
    """
    default = WalkSettings(control=OPEN_LOOP)
    presets = [name for name, body in BODIES.items() if body == walk.body]
    plain = replace(
        walk,
        seed=default.seed,
        duration=default.duration,
        pushes=default.pushes,
        body=default.body if presets else walk.body,
        control=replace(
            walk.control,
            method=OPEN_LOOP.method,
            feedback=OPEN_LOOP.feedback,
        ),
    )
    found = _differences(settings_entries(plain), settings_entries(default))
    return (presets or [OWN])[0], json.dumps(found) if found else ""


@cache
def changed_walk(changes: str) -> WalkSettings:
    """Return the default walk with changes.

    Args:
        changes: Changes of :func:`changes_of`.
    """
    entries = json.loads(changes) if changes else {}
    return parse_settings(WalkSettings, entries, "changes of a walk")


def _differences(
    entries: dict[str, Any], default: dict[str, Any]
) -> dict[str, Any]:
    """Return the entries that differ from the default, by section.

    Settings that are None by default have no entry there.
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
