"""Measured departures of walking bodies, stored beside their descriptions."""

from dataclasses import asdict
from hashlib import sha256
from pathlib import Path
from typing import Any

from ..core.atomic_output import atomic_draft
from ..core.entries import load_entries
from ..core.errors import ModelError
from ..planning import GaitSettings
from ..robots.description import RobotDescription
from ..strategies.body_departure import BodyDeparture

FILE = "departures.toml"
DIGITS = 4  # of a stored value, in [m]


def key_of(gait: GaitSettings) -> str:
    """Return the name of a gait in the file."""
    text = repr(sorted(asdict(gait).items()))
    return f"gait-{sha256(text.encode()).hexdigest()[:12]}"


def load_departure(
    robot: RobotDescription, gait: GaitSettings
) -> BodyDeparture | None:
    """Return the departure of a robot on a gait; None if not measured.

    Raises:
        ModelError: If the file of the robot is invalid.
    """
    path = Path(robot.folder) / FILE
    if not path.is_file():
        return None
    found = load_entries(path, ModelError).get(key_of(gait))
    if found is None:
        return None
    try:
        return BodyDeparture(**{k: float(v) for k, v in found.items()})
    except (TypeError, ValueError, AttributeError) as error:
        raise ModelError(
            f"{path} has no valid departure for {key_of(gait)}: {error}; "
            "`stepaside robot check` writes it anew"
        ) from error


def store_departure(
    robot: RobotDescription, gait: GaitSettings, found: BodyDeparture
) -> Path:
    """Write the departure of a robot on a gait to its file; return that."""
    import tomli_w

    path = Path(robot.folder) / FILE
    entries: dict[str, Any] = {}
    if path.is_file():
        entries = dict(load_entries(path, ModelError))
    values = {k: round(v, DIGITS) for k, v in found._asdict().items()}
    entries[key_of(gait)] = values
    with atomic_draft(path) as draft:
        draft.write_text(tomli_w.dumps(entries), encoding="utf-8")
    return path
