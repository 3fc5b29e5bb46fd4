"""Test networks of learned strategies in ONNX files."""

import pickle
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from stepaside.core.errors import ConfigurationError
from stepaside.planning import Direction
from stepaside.strategies import load_strategy
from stepaside.strategies.learned import (
    LearnedStrategy,
    StrategyContract,
    dense_network,
    load_learned_strategy,
    open_network,
)

onnx = pytest.importorskip("onnx")
RANDOM = np.random.default_rng(5)
LAYERS = [
    (RANDOM.normal(size=(6, 8)), RANDOM.normal(size=8)),
    (RANDOM.normal(size=(8, 2)), 0.1 * RANDOM.normal(size=2)),
]
TERMS = ("distance", "bearing", "bearing_rate", "closing_speed", "moving")
CONTRACT = StrategyContract(Direction.BACKWARD, TERMS)
INPUTS = 0.1 * RANDOM.normal(size=(4, 6))


def saved(path: Path, **values: Any) -> Path:
    LearnedStrategy(dense_network(LAYERS, **values), CONTRACT).save(path)
    return path


def test_a_dense_network_is_products_and_activations(tmp_path: Path) -> None:
    file = saved(tmp_path / "a.onnx", activation="Tanh")
    onnx.checker.check_model(file, full_check=True)
    (first, b), (second, c) = LAYERS
    made = np.tanh(INPUTS @ first + b) @ second + c
    expected = np.clip(made, (-np.pi, 0.0), (np.pi, 1.0))
    strategy = load_learned_strategy(file)
    np.testing.assert_allclose(strategy.intents(INPUTS), expected, atol=1e-5)
    again = pickle.loads(pickle.dumps(strategy))
    assert again == strategy and again.contract == CONTRACT


def changed(file: Path, **values: Any) -> Path:
    """Write the network again, with weights beside it or a row at a time."""
    model = onnx.load(file)
    if values.pop("one", False):
        for port in (*model.graph.input, *model.graph.output):
            port.type.tensor_type.shape.dim[0].dim_value = 1
    onnx.save(model, file, **values)
    return file


def test_a_network_of_one_row_decides_for_many(tmp_path: Path) -> None:
    file = saved(tmp_path / "a.onnx")
    expected = load_learned_strategy(file).intents(INPUTS)
    found = load_learned_strategy(changed(file, one=True)).intents(INPUTS)
    np.testing.assert_allclose(found, expected, atol=1e-6)


BESIDE = {"save_as_external_data": True, "location": "w", "size_threshold": 0}


def test_weights_may_lie_beside_the_network(tmp_path: Path) -> None:
    file = saved(tmp_path / "a.onnx")
    expected = load_learned_strategy(file).intents(INPUTS)
    strategy = load_learned_strategy(changed(file, **BESIDE))
    (tmp_path / "w").unlink()
    np.testing.assert_array_equal(strategy.intents(INPUTS), expected)
    with pytest.raises(ConfigurationError, match=r"a\.onnx.*\bw\b"):
        load_strategy(str(file))


def test_the_reason_of_the_runtime_is_told(tmp_path: Path) -> None:
    file = saved(tmp_path / "a.onnx")
    model = onnx.load(file)
    model.graph.node[0].op_type = "Gem"
    onnx.save(model, file)
    with pytest.raises(ConfigurationError, match=r"a\.onnx.*Gem\b") as told:
        load_strategy(str(file))
    assert "\n" not in str(told.value)


def test_a_network_of_one_number_is_refused(tmp_path: Path) -> None:
    text = "s (float x) => (float y) { y = Identity(x) }"
    model = onnx.parser.parse_model(
        f'<ir_version: 8, opset_import: ["": 17]> {text}'
    )
    onnx.helper.set_model_props(model, CONTRACT.metadata())
    onnx.save(model, tmp_path / "a.onnx")
    with pytest.raises(ConfigurationError, match="must have 2 outputs"):
        load_strategy(str(tmp_path / "a.onnx"))


@pytest.mark.parametrize("share", [0.0, 0.2, 0.6])
def test_a_file_that_ends_early_is_refused(
    share: float, tmp_path: Path
) -> None:
    file = saved(tmp_path / "a.onnx")
    whole = file.read_bytes()
    file.write_bytes(whole[: int(share * len(whole))])
    with pytest.raises(ConfigurationError, match=r"strategy .*a\.onnx"):
        load_strategy(str(file))


def test_the_extra_that_is_missing_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = saved(tmp_path / "a.onnx", activation="Elu")
    open_network.cache_clear()
    monkeypatch.setitem(sys.modules, "onnxruntime", None)
    with pytest.raises(ModuleNotFoundError, match=r"stepaside\[legs\]"):
        load_strategy(str(file))
