"""Measured response of legs, in a file beside the robot description."""

import hashlib
from pathlib import Path
from typing import Any

from ...core.entries import load_entries, read_entries, to_entries
from ...core.errors import PolicyError
from .velocity_response import AXES, VelocityResponse


def response_path(folder: Path, network: Path) -> Path:
    """Return the file of the response of a network on a robot."""
    return folder / f"legs-{network.stem}.toml"


def digest_of(network: Path) -> str:
    """Return the SHA-256 digest of a network, to tell networks apart.

    Weights in a file beside it, as PyTorch writes them, belong to it.
    """
    weights = network.with_name(f"{network.name}.data")
    content = network.read_bytes()
    if weights.exists():
        content += weights.read_bytes()
    return hashlib.sha256(content).hexdigest()


def response_entries(
    response: VelocityResponse, network: Path
) -> dict[str, Any]:
    """Return a response as entries of its file."""
    entries: dict[str, Any] = to_entries(response)
    for name, axis in zip(AXES, response.axes, strict=True):
        entries[name]["delivered"] = [list(row) for row in axis.delivered]
    return entries | {"network": digest_of(network)}


def load_response(folder: Path, network: Path) -> VelocityResponse | None:
    """Load the response of a network on a robot.

    The response; None if it was not measured, or of another network of this
    name.
    """
    path = response_path(folder, network)
    if not path.is_file():
        return None
    try:
        entries = load_entries(path, PolicyError)
        own = read_entries(VelocityResponse, entries, error=PolicyError)
    except PolicyError as error:
        raise PolicyError(
            f"{path} is not a response of legs: {error}; `stepaside robot "
            "legs measure` writes it anew"
        ) from error
    return own if own.network == digest_of(network) else None
