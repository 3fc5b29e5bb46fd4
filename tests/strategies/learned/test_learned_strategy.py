"""Test strategies that a network decides."""

from collections.abc import Mapping, Sequence
from math import pi
from pathlib import Path

import numpy as np
import pytest

from floor_duels import play_steps
from stepaside.core.errors import ConfigurationError, PolicyError
from stepaside.planning import Direction
from stepaside.strategies import (
    STAND,
    Evasion,
    Intent,
    Knowledge,
    Limits,
    Pursuit,
    load_strategy,
)
from stepaside.strategies.learned import (
    LearnedStrategy,
    StrategyContract,
    contract_of,
    dense_network,
    discrete_headings,
)
from stepaside.theory.unicycle import RelativeStart

LIMITS = Limits(0.1, 0.2, 0.04, 0.4)
KNOWN = Knowledge(0.0, 0.6, 1.0, LIMITS)
START = RelativeStart(1.0, 0.3, -0.2)
EVADES = Direction.BACKWARD


def linear(
    rows: Sequence[Sequence[float]],
    offsets: Sequence[float],
    headings: tuple[float | None, ...] = (),
) -> LearnedStrategy:
    """Strategy with outputs that are linear in cosine and sine."""
    contract = StrategyContract(EVADES, ("bearing",), headings)
    layer = np.array(rows, dtype=float), np.array(offsets, dtype=float)
    return LearnedStrategy(dense_network([layer]), contract)


def test_continuous_outputs_are_heading_and_speed() -> None:
    strategy = linear([[0.0, 0.0], [1.0, 0.0]], [0.1, 0.25])
    intent, _ = strategy.decide(KNOWN, None)
    assert intent.heading == pytest.approx(0.1 + np.sin(0.6))
    assert intent.speed_factor == pytest.approx(0.25)


def test_the_largest_discrete_output_decides() -> None:
    headings = discrete_headings(3)
    third = 2.0 * pi / 3.0
    assert headings == (-third, 0.0, third, None)
    for chosen, expected in enumerate(
        [Intent(-third), Intent(0.0), Intent(third), STAND]
    ):
        offsets = 1.0 * (np.arange(4) == chosen)
        strategy = linear(np.zeros((2, 4)).tolist(), offsets, headings)
        assert strategy.decide(KNOWN, None)[0] == expected


def test_an_output_that_is_not_finite_is_refused() -> None:
    strategy = linear([[0, 0], [0, 0]], [0.0, np.nan])
    with pytest.raises(PolicyError, match="output 1 of .* finite"):
        strategy.decide(KNOWN, None)


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A network that moves back: its heading is about the bearing."""
    path = tmp_path_factory.mktemp("learned") / "back.onnx"
    linear([[0.0, 0.0], [1.0, 0.0]], [0.0, 1.0]).save(path)
    return path


def test_a_file_plays_steps_and_unicycles(file: Path) -> None:
    learned = load_strategy(str(file))
    evaders = (
        learned,
        Evasion(0.0, safety_radius=1e6),
        Evasion(safety_radius=1e6),
    )
    for level in ("steps", "unicycle"):
        played, back, aside = (
            play_steps(Pursuit(), evader, START.poses(), 100, level=level)
            for evader in evaders
        )
        assert played.closest_distance > aside.closest_distance
        assert played.closest_distance == pytest.approx(
            back.closest_distance, abs=0.02
        )


def test_metadata_hold_the_contract() -> None:
    contract = StrategyContract(EVADES, ("bearing",), (0.5, None))
    assert contract_of(contract.metadata()) == contract


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            {"stepaside_strategy": None},
            "stepaside_strategy must be 1, got None",
        ),
        ({"stepaside_strategy": "9"}, "must be 1, got '9'"),
        ({"direction": "up"}, "must be forward or backward, got 'up'"),
        ({"observation_names": "7"}, "observation_names must be a list"),
        ({"observation_names": '["sonar"]'}, "term 'sonar'; there are"),
        (
            {"action_headings": '["left"]'},
            r"heading must lie in .* got 'left'",
        ),
        ({"action_headings": "[99]"}, r"heading must lie in .* got 99"),
    ],
)
def test_metadata_that_do_not_fit_are_refused(
    change: Mapping[str, str | None], message: str
) -> None:
    metadata = StrategyContract(EVADES, ("bearing",)).metadata()
    entries: dict[str, str | None] = {**metadata, **change}
    given = {k: v for k, v in entries.items() if v is not None}
    with pytest.raises(PolicyError, match=message):
        contract_of(given)


@pytest.mark.parametrize("content", [None, b"no network"])
def test_a_bad_file_is_refused_in_one_line(
    content: bytes | None, tmp_path: Path
) -> None:
    file = tmp_path / "bad.onnx"
    if content is not None:
        file.write_bytes(content)
    with pytest.raises(ConfigurationError, match="strategy .*bad.onnx") as got:
        load_strategy(str(file))
    assert "\n" not in str(got.value)
