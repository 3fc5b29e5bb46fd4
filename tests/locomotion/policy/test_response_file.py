"""Test the file of a measured response."""

from dataclasses import replace
from pathlib import Path

import pytest
import tomli_w

from stepaside.core.errors import PolicyError
from stepaside.locomotion.policy.contract import CommandRanges
from stepaside.locomotion.policy.velocity_response import (
    VelocityResponse,
    digest_of,
    load_response,
    response_entries,
    response_path,
)

RESPONSE = replace(
    VelocityResponse.ideal(CommandRanges()), odometry_ratio=(1.03, 0.99)
)


def stored(folder: Path) -> Path:
    network = folder / "walk.onnx"
    network.write_bytes(b"one network")
    text = tomli_w.dumps(response_entries(RESPONSE, network))
    response_path(folder, network).write_text(text)
    return network


def test_a_response_is_read_as_written(tmp_path: Path) -> None:
    network = stored(tmp_path)
    read = load_response(tmp_path, network)
    assert read == replace(RESPONSE, network=digest_of(network))


def test_another_network_of_the_name_has_no_response(tmp_path: Path) -> None:
    network = stored(tmp_path)
    network.write_bytes(b"another network")
    assert load_response(tmp_path, network) is None
    assert load_response(tmp_path, tmp_path / "run.onnx") is None


def test_a_malformed_response_is_named(tmp_path: Path) -> None:
    network = stored(tmp_path)
    response_path(tmp_path, network).write_text("forward = [")
    with pytest.raises(PolicyError, match="legs-walk.toml is not a response"):
        load_response(tmp_path, network)
