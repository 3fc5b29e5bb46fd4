"""Test the conversion of TorchScript archives.

The archives are written here in the format of ``torch.jit.save``; results are
compared with NumPy.
"""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("onnxruntime")
pytest.importorskip("onnx")

from stepaside.core.errors import PolicyError
from stepaside.locomotion.policy.network import PolicyNetwork
from stepaside.locomotion.policy.torchscript_conversion import (
    convert_torchscript,
    write_network,
)
from torchscript_archives import Call, Module, write_archive

NETWORK = "__torch__.net.Network"
GENERATOR = np.random.default_rng(7)
FIRST = "y = torch.linear(x, self.one)"
OBSERVATION = GENERATOR.normal(size=5)


def weights(*shape: int) -> np.ndarray:
    return GENERATOR.normal(size=shape).astype(np.float32)


def program(*lines: str) -> dict[str, str]:
    """Code of a network whose forward has these lines."""
    body = "\n    ".join(lines)
    return {
        "__torch__.net": "class Network(Module):\n"
        "  width : Final[int] = 5\n"
        "  def forward(self: __torch__.net.Network, x: Tensor) -> Tensor:\n"
        f"    {body}\n"
    }


def convert(
    path: Path, code: dict[str, str], **attributes: Any
) -> PolicyNetwork:
    archive = write_archive(path / "a.pt", Module(NETWORK, attributes), code)
    network = convert_torchscript(archive)
    write_network(network, path / "a.onnx", {})
    return PolicyNetwork(path / "a.onnx")


def evaluated(network: PolicyNetwork) -> np.ndarray:
    """Return the action for the observation, with states of zero."""
    ((action, _),) = network.evaluate(
        [OBSERVATION], [network.initial_memory()]
    )
    return action


def sigmoid(x: np.ndarray) -> np.ndarray:
    result: np.ndarray = 1.0 / (1.0 + np.exp(-x))
    return result


def test_dense_layers_of_submodules(tmp_path: Path) -> None:
    """Layers, activation and normalisation constants, in modules."""
    code = {
        "__torch__.net": "class Network(Module):\n"
        "  def forward(self: __torch__.net.Network, x: Tensor) -> Tensor:\n"
        "    _0 = torch.sub(x, self.mean)\n"
        "    _1 = torch.div(_0, torch.add(self.std, 0.01))\n"
        '    x0 = (getattr(self, "0")).forward(torch.clamp(_1, -2., 2.), )\n'
        "    return (self.last).forward(torch.elu(x0, 1.), )\n",
        "__torch__.nn": "class Linear(Module):\n"
        "  def forward(self: __torch__.nn.Linear, input: Tensor) -> Tensor:\n"
        "    return torch.linear(input, self.weight, self.bias)\n",
    }
    a, b, c, d = weights(4, 5), weights(4), weights(3, 4), weights(3)
    mean, std = weights(5), np.abs(weights(5))
    network = convert(
        tmp_path,
        code,
        **{"0": Module("__torch__.nn.Linear", {"weight": a, "bias": b})},
        last=Module("__torch__.nn.Linear", {"weight": c, "bias": d}),
        mean=mean,
        std=std,
    )
    x = np.clip((OBSERVATION - mean) / (std + 0.01), -2.0, 2.0)
    hidden = a @ x + b
    hidden = np.where(hidden > 0.0, hidden, np.expm1(hidden))
    expected = c @ hidden + d
    assert network.observation.width == 5  # of the first layer
    found = evaluated(network)
    np.testing.assert_allclose(found, expected, atol=1e-5)


@pytest.mark.parametrize("kind", ["lstm", "gru"])
def test_recurrent_layers_keep_their_state(kind: str, tmp_path: Path) -> None:
    """Two layers, against the equations of LSTM and GRU."""
    gates = {"lstm": 4, "gru": 3}[kind] * 2
    shapes = [(gates, 5), (gates, 2), (gates,), (gates,)]
    given = [weights(*shape) for shape in shapes]
    given += [weights(gates, 2), *(weights(*s) for s in shapes[1:])]
    states = ["h", "c"] if kind == "lstm" else ["h"]
    names = ", ".join(f"self.{name}" for name in states)
    results = ", ".join(f"{name}0" for name in states)
    code = program(
        "_0 = torch.unsqueeze(x, 0)",
        f"hx = [{names}]" if kind == "lstm" else "hx = self.h",
        f"y, {results}, = torch.{kind}(_0, hx, self.flat, True, 2, 0., "
        "False, False, False)",
        *(f"_{n} = torch.copy_(torch.slice(self.{n}), {n}0)" for n in states),
        "return torch.squeeze(y, 0)",
    )
    zeros = {name: np.zeros((2, 1, 2), np.float32) for name in states}
    network = convert(tmp_path, code, flat=given, **zeros)
    assert len(network.states) == len(states)
    memory = np.zeros((2, 2, 2))  # layer, h and c, width
    state = network.initial_memory()
    for _ in range(3):
        value = OBSERVATION
        for i in range(2):
            value, memory[i] = recurrence(
                kind, value, memory[i], given[4 * i : 4 * i + 4]
            )
        ((found, state),) = network.evaluate([OBSERVATION], [state])
        np.testing.assert_allclose(found, value, atol=1e-5)
    first = evaluated(network)
    assert not np.allclose(first, found)


def recurrence(
    kind: str, x: np.ndarray, memory: np.ndarray, given: list[np.ndarray]
) -> tuple[np.ndarray, np.ndarray]:
    """One step of a layer as the documentation of PyTorch gives it."""
    h, c = memory
    parts = {"lstm": 4, "gru": 3}[kind]
    inner = np.split(given[0] @ x + given[2], parts)
    outer = np.split(given[1] @ h + given[3], parts)
    if kind == "gru":
        r, z = (sigmoid(inner[i] + outer[i]) for i in (0, 1))
        n = np.tanh(inner[2] + r * outer[2])
        h = (1.0 - z) * n + z * h
        return h, np.stack([h, c])
    i, f, g, o = (a + b for a, b in zip(inner, outer, strict=True))
    c = sigmoid(f) * c + sigmoid(i) * np.tanh(g)
    h = sigmoid(o) * np.tanh(c)
    return h, np.stack([h, c])


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("torch.relu_(x)", lambda x: np.maximum(x, 0.0)),
        ("torch.tanh(x)", np.tanh),
        ("torch.silu(x)", lambda x: x * sigmoid(x)),
        ("torch.leaky_relu(x, 0.2)", lambda x: np.where(x > 0, x, 0.2 * x)),
        ("torch.softplus(x, 1, 20)", lambda x: np.log1p(np.exp(x))),
        ("torch.add(x, torch.mul(x, x), alpha=2)", lambda x: x + 2 * x * x),
        ("torch.cat([torch.slice(x, 1, 1, 3), x], -1)", None),
        ("torch.flatten(torch.reshape(x, [1, 5, 1]), 1)", lambda x: x),
        ("torch.dropout(x, 0.5, False)", lambda x: x),
    ],
)
def test_operations(line: str, expected: Any, tmp_path: Path) -> None:
    # Only the first layer tells the width: an identity.
    layer = np.eye(5, dtype=np.float32)
    lines = ["x = torch.linear(x, self.one, None)", f"return {line}"]
    network = convert(tmp_path, program(*lines), one=layer)
    values = (
        np.concatenate([OBSERVATION[1:3], OBSERVATION])
        if expected is None
        else expected(OBSERVATION)
    )
    np.testing.assert_allclose(evaluated(network), values, atol=1e-5)


def test_conditions_on_shapes_are_decided(tmp_path: Path) -> None:
    code = program(
        "if torch.ne(self.width, torch.size(x, -1)):",
        '  ops.prim.RaiseException("wrong width", "builtins.ValueError")',
        "else:",
        "  pass",
        "for i in range(2):",
        "  x = torch.mul(x, 3.)",
        "return x",
    )
    found = evaluated(convert(tmp_path, code))
    np.testing.assert_allclose(found, 9.0 * OBSERVATION, rtol=1e-6)


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        (["return torch.fft(x)"], "operation torch.fft has no counterpart"),
        ([FIRST, "return torch.linear(y, self.two)"], "4 inputs is given 3"),
        (["return self.absent"], "has no attribute 'absent'"),
        ([FIRST, "if torch.gt(y, 0):", "  pass", "return y"], "torch.gt has"),
        (["while True:", "  pass"], "statement 'while True"),
        (["_0 = torch.slice(x, 1, 1)", "return x"], "its width must be given"),
        (["return (self).forward(x, )"], "calls itself without end"),
        (["for i in range(100000000):", "  pass"], "range of 100000000"),
        ([FIRST, "return 3"], "forward must return one action"),
        (
            [FIRST, "_0 = torch.add_(torch.slice(y, 1, 1), 1)", "return y"],
            "a part of a tensor is changed in place",
        ),
    ],
)
def test_what_has_no_counterpart_is_named(
    lines: list[str], words: str, tmp_path: Path
) -> None:
    with pytest.raises(PolicyError, match=words):
        convert(
            tmp_path, program(*lines), one=weights(3, 5), two=weights(2, 4)
        )


def test_an_archive_calls_nothing(tmp_path: Path) -> None:
    marked = tmp_path / "marked"
    hostile = Call("os.system", f"touch {marked}")
    root = Module(NETWORK, {"x": hostile})
    path = write_archive(tmp_path / "a.pt", root, program("return x"))
    with pytest.raises(PolicyError, match="refers to os.system"):
        convert_torchscript(path)
    assert not marked.exists()


def test_a_tensor_beyond_its_storage_is_refused(tmp_path: Path) -> None:
    # Six values, with strides that reach to the hundredth.
    long = np.lib.stride_tricks.as_strided(weights(200), (2, 3), (400, 4))
    root = Module(NETWORK, {"x": long})
    path = write_archive(tmp_path / "a.pt", root, program("return x"))
    with pytest.raises(PolicyError, match="exceeds its storage"):
        convert_torchscript(path)


def test_another_file_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.pt"
    path.write_bytes(b"no archive")
    with pytest.raises(PolicyError, match="is not a TorchScript archive"):
        convert_torchscript(path)
