"""Measured response of legs, in a file beside the robot description."""

import hashlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...core.entries import load_entries, read_entries
from ...core.errors import PolicyError
from .velocity_response import AXES, AxisResponse, VelocityResponse


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
    axes = zip(AXES, response.axes, strict=True)
    return {
        "network": digest_of(network),
        "tube": response.tube,
        "odometry_ratio": list(response.odometry_ratio),
        **{
            name: {
                "commands": list(axis.commands),
                "delivered": [list(row) for row in axis.delivered],
                "lag": axis.lag,
                "halting": axis.halting,
            }
            for name, axis in axes
        },
    }


@dataclass(frozen=True)
class ResponseEntries:
    """Entries of the file of a response."""

    network: str
    forward: AxisResponse
    lateral: AxisResponse
    turn: AxisResponse
    tube: float = 0.0
    odometry_ratio: tuple[float, float] = (1.0, 1.0)


def load_response(folder: Path, network: Path) -> VelocityResponse | None:
    """Load the response of a network on a robot.

    Returns:
        The response; None if it was not measured, or of another network of
        this name.

    Raises:
        PolicyError: If the file is malformed.
    """
    path = response_path(folder, network)
    if not path.is_file():
        return None
    try:
        own = read_entries(
            ResponseEntries, load_entries(path, PolicyError), error=PolicyError
        )
        if own.network != digest_of(network):
            return None
        axes = own.forward, own.lateral, own.turn
        return VelocityResponse(axes, own.tube, own.odometry_ratio)
    except PolicyError as error:
        raise PolicyError(
            f"{path} is not a response of legs: {error}; `stepaside legs "
            "measure` writes it anew"
        ) from error
