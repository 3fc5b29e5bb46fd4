# /// script
# requires-python = ">=3.11"
# dependencies = ["torch", "onnx", "onnxscript", "onnxruntime"]
# ///
"""Export a walking policy from TorchScript to ONNX, and check the ONNX file.

Buffers that change, such as the state of an LSTM, become inputs and outputs,
zero at the start. ``--store`` writes what a file answers to drawn
observations, ``--check`` compares::

    uv run tools/export_policy.py motion.pt --convention legged_gym
    uv run tools/export_policy.py motion.pt --store outputs.json
    uv run tools/export_policy.py motion.onnx --check outputs.json

Stored in ``tools/policy_outputs``: ``deploy/pre_train/g1/motion.pt`` of
unitree_rl_gym, ``deploy/models/T1.pt`` of booster_gym and ``k1_walk.pt`` of
test_deploy.
"""

import argparse
import hashlib
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

STEPS = 20  # of one walker, each with the states of the last
TOLERANCE = 1e-5  # of an output, relative or absolute
Step = Callable[..., list[Any]]


def load_step(path: Path) -> tuple[Step, dict[str, list[int]]]:
    """Return a policy as a function of all its inputs, with their shapes.

    Args:
        path: TorchScript or ONNX file.
    """
    if path.suffix == ".onnx":
        import onnxruntime

        session = onnxruntime.InferenceSession(str(path))
        shapes = {each.name: each.shape for each in session.get_inputs()}
        return lambda *given: session.run(
            None, dict(zip(shapes, given, strict=True))
        ), shapes
    import torch

    net = torch.jit.load(str(path), map_location="cpu").eval()
    parameters = dict(net.named_parameters())
    first = next((x for x in parameters if "weight_ih" in x), None)
    width = parameters[first or next(iter(parameters))].shape[-1]
    before = {name: each.clone() for name, each in net.named_buffers()}
    with torch.no_grad():
        net(torch.ones(1, width))
    states = {
        name: list(each.shape)
        for name, each in net.named_buffers()
        if not torch.equal(each, before[name])
    }

    def step(observation: Any, *given: Any) -> list[Any]:
        for name, state in zip(states, given, strict=True):
            module, _, own = name.rpartition(".")
            setattr(_part(net, module), own, torch.as_tensor(state).clone())
        with torch.no_grad():
            action = net(torch.as_tensor(observation))
        after = dict(net.named_buffers())
        return [action, *(after[name] for name in states)]

    return step, {"obs": [1, width], **states}


def _part(net: Any, name: str) -> Any:
    for each in name.split(".") if name else ():
        net = getattr(net, each)
    return net


def export(path: Path, output: Path, convention: str) -> None:
    """Write a TorchScript policy as ONNX, with the name of its convention."""
    import onnx
    import torch
    from torch.fx.experimental.proxy_tensor import make_fx

    step, shapes = load_step(path)
    zeros = tuple(torch.zeros(shape) for shape in shapes.values())
    with torch.backends.mkldnn.flags(enabled=False):  # not known to ONNX
        graph = make_fx(torch.func.functionalize(step))(*zeros)
    names = [name.replace(".", "_") for name in shapes]
    torch.onnx.export(
        graph,
        zeros,
        output,
        input_names=names,
        output_names=["actions", *(f"new_{name}" for name in names[1:])],
        external_data=False,
        verbose=False,
    )
    model = onnx.load(output)
    entries = {"convention": convention} if convention else {}
    onnx.helper.set_model_props(
        model, {"stepaside_contract": json.dumps(entries)}
    )
    onnx.checker.check_model(model, full_check=True)
    onnx.save(model, output)


def outputs(path: Path, seed: int = 0) -> list[list[float]]:
    """Return actions on drawn observations. Shape (STEPS, actions)."""
    step, shapes = load_step(path)
    draw = np.random.default_rng(seed).standard_normal
    first, *others = shapes.values()
    states = [np.zeros(shape, np.float32) for shape in others]
    rows = []
    for _ in range(STEPS):
        action, *states = step(draw(first).astype(np.float32), *states)
        rows.append(np.asarray(action)[0].tolist())
    return rows


def main() -> None:
    """Export, store or check."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("policy", type=Path)
    parser.add_argument("--output", type=Path)
    parser.add_argument("--convention", default="", help="see docs/legs.md")
    parser.add_argument("--store", type=Path)
    parser.add_argument("--check", type=Path)
    asked = parser.parse_args()
    if asked.store:
        digest = hashlib.sha256(asked.policy.read_bytes()).hexdigest()
        stored = {"sha256": digest, "actions": outputs(asked.policy)}
        asked.store.write_text(json.dumps(stored) + "\n")
    elif asked.check:
        wanted = np.array(json.loads(asked.check.read_text())["actions"])
        found = np.array(outputs(asked.policy))
        print(f"largest difference {np.abs(found - wanted).max():.2g}")
        np.testing.assert_allclose(
            found, wanted, rtol=TOLERANCE, atol=TOLERANCE
        )
    else:
        output = asked.output or asked.policy.with_suffix(".onnx")
        export(asked.policy, output, asked.convention)
        print(f"wrote {output}")


if __name__ == "__main__":
    main()
