"""Walking policy that imitates the paper's walk, made in seconds.

Tests that need a policy that walks find one on every machine: a network of
one hidden layer with random weights, whose output layer is fitted to the
joint targets of our own walk, with a linear feedback of tilt to the ankles.
"""

import json
import shutil
from dataclasses import replace
from math import pi
from pathlib import Path

import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper

import stepaside.robots
from stepaside.games.game_settings import walk
from stepaside.games.recorded_game import RecordedGame
from stepaside.planning import Foot
from stepaside.robots.description import load_robot
from stepaside.robots.tree_cache import load_tree
from walkers import walker_of

HIDDEN, SAMPLES = 400, 20_000
PHASES = 64  # of a gait cycle
STEADY = 3.0  # from here on the walk is periodic, in [s]
SHRINKS = 0.02, 0.08  # commands below which steps are lower [m/s, rad/s]
SCALES = 1.0, 1.0, 0.04, 0.04, 0.12  # of phase and command, for the layer
TILT, RATE = 0.5, 0.05  # feedback to the ankles, as of the stabiliser
SPEED, TURN = 0.073, 0.23  # greatest commands, in [m/s] and [rad/s]


def nao_on_imitated_walk(
    folder: Path, lateral: float = 1e-3, period: float = 0.004
) -> Path:
    """Write a NAO with a policy that walks ahead, back, and turns.

    Args:
        folder: New folder of its description.
        lateral: Greatest lateral command, in [m/s]; the policy steps
            sideways as it steps ahead, with the rolls of its legs.
        period: Time from one evaluation to the next, in [s].
    """
    source = Path(next(iter(stepaside.robots.__path__))) / "nao"
    shutil.copytree(source, folder)
    motors = load_tree(load_robot("nao")).motors
    legs = [
        i
        for i, name in enumerate(motors)
        if any(part in name for part in ("Hip", "Knee", "Ankle"))
    ]
    cycle = 2.0 * walk().gait.step_duration
    ahead, back = (_targets(1.0, 0.0, backward) for backward in (False, True))
    left, right = (_targets(0.1, side * pi / 2) for side in (1.0, -1.0))
    rest = _resting_targets()[legs]
    stride = (ahead - back)[:, legs] / (2.0 * SPEED)
    turning = (left - right)[:, legs] / (2.0 * TURN)
    names = [motors[i] for i in legs]
    sideways = np.zeros_like(stride)
    for side in "LR":
        pitch = stride[:, names.index(f"{side}HipPitch")]
        sideways[:, names.index(f"{side}HipRoll")] = -pitch
        sideways[:, names.index(f"{side}AnkleRoll")] = pitch
    sideways = 0.5 * (sideways - _mirrored(sideways, names))
    stepping = 0.5 * (left + right)[:, legs] - rest - 0.1 * SPEED * stride
    stepping = 0.5 * (stepping + _mirrored(stepping, names))
    _write_network(
        folder / "policy.onnx",
        (stepping, stride, sideways, turning),
        lateral,
        names,
        {
            "joints": names,
            "terms": [
                *("sin_phase", "cos_phase", "command"),
                *("projected_gravity", "base_ang_vel"),
            ],
            "default_posture": rest.tolist(),
            "stiffness": 200.0,
            "damping": 10.0,
            "action_scale": 1.0,
            "period": period,
            "clock": {"period": cycle, "offsets": [0.0]},
            "command_rate": 0.1,
            "command_ranges": {
                "forward": [-SPEED, SPEED],
                "lateral": [-lateral, lateral],
                "turn": [-TURN, TURN],
            },
        },
    )
    text = (folder / "robot.toml").read_text(encoding="utf-8")
    entry = "\n[locomotion]\nnetwork = 'policy.onnx'\n"
    (folder / "robot.toml").write_text(text + entry, encoding="utf-8")
    return folder


def _mirrored(part: np.ndarray, names: list[str]) -> np.ndarray:
    """The same motion half a cycle later, left for right."""
    twins = [("R" if name[0] == "L" else "L") + name[1:] for name in names]
    columns = [
        names.index(twin if twin in names else name)
        for name, twin in zip(names, twins, strict=True)
    ]
    signs = [-1.0 if "Roll" in name else 1.0 for name in names]
    found: np.ndarray = np.roll(part, PHASES // 2, axis=0)[:, columns] * signs
    return found


def _targets(
    scale: float, bearing: float, backward: bool = False
) -> np.ndarray:
    """Joint targets of one gait cycle of our walk. Shape (PHASES, joints)."""
    gait = walk().gait
    slower = replace(
        gait, speed=scale * gait.speed, stride=scale * gait.stride
    )
    cycle = 2.0 * gait.step_duration
    settings = walk(
        duration=STEADY + 2.0 * cycle,
        gait=slower,
        bearing=bearing,
        backward=backward,
    )
    game = RecordedGame(settings, recorded=False, endless=True)
    rows, phases = [], []
    while game.world.time < settings.duration:
        now = game.world.time
        assert game.tick() is None, game.message
        state = walker_of(game).scheme.walk
        if now >= STEADY and state.plan is not None:
            first = state.plan.first_foot is Foot.LEFT
            phase = (now - state.plan_started) / cycle + 0.5 * (not first)
            phases.append(phase % 1.0)
            rows.append(game.in_physics.data.ctrl.copy())
    game.world.close()
    order = np.argsort(phases)
    times, values = np.array(phases)[order], np.array(rows)[order]
    grid = np.arange(PHASES) / PHASES
    columns = [np.interp(grid, times, v, period=1.0) for v in values.T]
    return np.stack(columns, axis=1)


def _resting_targets() -> np.ndarray:
    game = RecordedGame(walk(duration=1.0), recorded=False, endless=True)
    targets: np.ndarray = walker_of(game).scheme.joint_targets.copy()
    game.world.close()
    return targets


def _write_network(
    file: Path,
    parts: tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray],
    widest: float,
    joints: list[str],
    contract: dict[str, object],
) -> None:
    """Fit the output layer, and write the network with its contract.

    Args:
        file: File to write.
        parts: Joint targets by phase, relative to standing: of stepping on
            the spot, and per forward, lateral and turning velocity.
        widest: Greatest lateral command, in [m/s].
        joints: Joints of the actions.
        contract: Entries of the contract.
    """
    generator = np.random.default_rng(1)
    phase = generator.integers(0, PHASES, SAMPLES)
    share = generator.uniform(0.0, 1.0, SAMPLES)
    forward = share * generator.uniform(-SPEED, SPEED, SAMPLES)
    turn = share * generator.uniform(-TURN, TURN, SAMPLES)
    lateral = share * generator.uniform(-widest, widest, SAMPLES)
    speed = np.hypot(forward, lateral)
    lifted = np.hypot(speed / SHRINKS[0], turn / SHRINKS[1]).clip(max=1.0)
    stepping, stride, sideways, turning = (part[phase] for part in parts)
    wanted = lifted[:, None] * stepping
    wanted += forward[:, None] * stride + turn[:, None] * turning
    wanted += lateral[:, None] * sideways
    angle = 2.0 * pi * phase / PHASES
    inputs = np.stack(
        [np.sin(angle), np.cos(angle), forward, lateral, turn], axis=1
    )
    first = 1.5 * generator.normal(size=(HIDDEN, 5)) / np.array(SCALES)
    bias = generator.uniform(-2.0, 2.0, size=HIDDEN)
    hidden = np.tanh(inputs @ first.T + bias)
    hidden = np.concatenate([hidden, np.ones((SAMPLES, 1))], axis=1)
    squares = hidden.T @ hidden + 1e-3 * np.eye(HIDDEN + 1)
    last = np.linalg.solve(squares, hidden.T @ wanted)
    feedback = np.zeros((11, len(joints)))
    for i, name in enumerate(joints):
        if "AnkleRoll" in name:
            feedback[[6, 8], i] = TILT, RATE
        if "AnklePitch" in name:
            feedback[[5, 9], i] = TILT, RATE
    numbers = {
        "first": np.pad(first, ((0, 0), (0, 6))),
        "bias": bias,
        "last": last[:-1],
        "offset": last[-1],
        "feedback": feedback,
    }
    tensor, real = helper.make_tensor_value_info, TensorProto.FLOAT
    graph = helper.make_graph(
        [
            helper.make_node(
                "Gemm", ["obs", "first", "bias"], ["sum"], transB=1
            ),
            helper.make_node("Tanh", ["sum"], ["hidden"]),
            helper.make_node("Gemm", ["hidden", "last", "offset"], ["gait"]),
            helper.make_node("MatMul", ["obs", "feedback"], ["balance"]),
            helper.make_node("Add", ["gait", "balance"], ["actions"]),
        ],
        "imitated walk",
        [tensor("obs", real, [1, 11])],
        [tensor("actions", real, [1, len(joints)])],
        [
            numpy_helper.from_array(value.astype(np.float32), name)
            for name, value in numbers.items()
        ],
    )
    opset = [helper.make_opsetid("", 17)]
    model = helper.make_model(graph, opset_imports=opset, ir_version=9)
    contract_text = json.dumps(contract)
    helper.set_model_props(model, {"stepaside_contract": contract_text})
    onnx.save(model, file)
