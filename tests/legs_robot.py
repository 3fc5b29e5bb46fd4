"""NAO on a small walking policy, for tests of games on learned legs."""

import shutil
from pathlib import Path

import numpy as np

import stepaside.robots
from small_policies import write_policy

JOINTS = ("LKneePitch", "LAnklePitch", "RKneePitch", "RAnklePitch")


def nao_on_legs(
    folder: Path,
    bias: tuple[float, float] = (0.0, 0.0),
    gain: float = 0.0,
    **changes: object,
) -> Path:
    """Write a NAO whose knees and ankles are moved by a policy.

    Args:
        folder: New folder of its description.
        bias: Constant action of knees and ankles, in [rad].
        gain: Action of the ankles per commanded forward velocity.
        changes: Entries of ``[locomotion]`` as TOML text.
    """
    source = Path(next(iter(stepaside.robots.__path__))) / "nao"
    shutil.copytree(source, folder)
    weights = np.zeros((4, 3))
    weights[[1, 3], 0] = gain
    write_policy(folder / "policy.onnx", weights, np.array(bias * 2))
    entries = {
        "network": "'policy.onnx'",
        "joints": str(list(JOINTS)),
        "terms": "['command']",
        "default_posture": "[0.6, -0.3, 0.6, -0.3]",
        "stiffness": "200.0",
        "damping": "10.0",
        "action_scale": "1.0",
    } | changes
    text = (folder / "robot.toml").read_text(encoding="utf-8")
    lines = [f"{key} = {value}" for key, value in entries.items()]
    table = "\n".join(["", "[locomotion]", *lines, ""])
    (folder / "robot.toml").write_text(text + table, encoding="utf-8")
    return folder
