"""Test the file of a measured response."""

import tomllib
from dataclasses import replace
from math import inf, nan
from pathlib import Path
from typing import Any

import pytest
import tomli_w

from stepaside.core.errors import PolicyError
from stepaside.locomotion.policy.contract import CommandRanges
from stepaside.locomotion.policy.velocity_response import (
    AXES,
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


@pytest.mark.parametrize("bad", [nan, inf, -inf, -1e3])
@pytest.mark.parametrize(
    "place",
    [
        *(("tube",), ("odometry_ratio", 1)),
        *((axis, name) for axis in AXES for name in ("lag", "halting")),
        *((axis, "commands", 0) for axis in AXES),
        *((axis, "delivered", 0, n) for axis in AXES for n in range(3)),
    ],
)
def test_a_number_that_cannot_be_is_refused_by_file_name_and_value(
    place: tuple[str | int, ...], bad: float, tmp_path: Path
) -> None:
    network = stored(tmp_path)
    file = response_path(tmp_path, network)
    entries = tomllib.loads(file.read_text())
    *outer, last = place
    found: Any = entries
    for key in outer:
        found = found[key]
    found[last] = bad
    file.write_text(tomli_w.dumps(entries))
    names = [key for key in place if isinstance(key, str)]
    with pytest.raises(PolicyError) as refused:
        load_response(tmp_path, network)
    text = str(refused.value)
    assert str(file) in text and f"got {bad:g}" in text
    assert all(name in text for name in names)


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
