"""Measured response of legs, in a file beside the robot description."""

import hashlib
import tomllib
from pathlib import Path
from typing import Any

from ...core.errors import PolicyError
from ...strategies.velocity_set import BodyVelocity
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
        entries = tomllib.loads(path.read_text(encoding="utf-8-sig"))
        if entries["network"] != digest_of(network):
            return None
        axes = [
            AxisResponse(
                tuple(map(float, entries[name]["commands"])),
                tuple(
                    BodyVelocity(*map(float, row))
                    for row in entries[name]["delivered"]
                ),
                float(entries[name]["lag"]),
                float(entries[name]["halting"]),
            )
            for name in AXES
        ]
        tube = float(entries.get("tube", 0.0))
        ahead, side = map(float, entries.get("odometry_ratio", (1.0, 1.0)))
    except (ValueError, KeyError, TypeError) as error:
        raise PolicyError(
            f"{path} is not a response of legs: `stepaside legs measure` "
            "writes it anew"
        ) from error
    try:
        return VelocityResponse(
            (axes[0], axes[1], axes[2]), tube, (ahead, side)
        )
    except PolicyError as error:
        raise PolicyError(f"{path}: {error}") from error
