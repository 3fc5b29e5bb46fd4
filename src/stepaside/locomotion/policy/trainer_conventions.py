"""Conventions of the trainers that export walking policies.

Each convention fills in what the metadata of its networks leave out. Sources
are the public configurations and deployment programs of the trainers; numbers
and orders are theirs, the code is not.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from math import inf, radians
from typing import Any

from ...core.errors import PolicyError
from .contract import CommandRanges, ObservationTerm, PhaseClock

Term = ObservationTerm


@dataclass(frozen=True)
class Convention:
    """Contract values that one trainer has in common for its networks.

    Attributes:
        name: Name of the convention.
        source: Where it is published.
        values: Values by field of
            :class:`~stepaside.locomotion.policy.contract.PolicyContract`.
        keys: Fields by the metadata key that the exporter writes.
        signature: Metadata keys by which its networks are recognised.
        postures: Default angles by joint, in [rad], of robots whose networks
            do not contain them; joints that are absent are at zero.
        by_joint: Further values for robots that have a joint.
    """

    name: str
    source: str
    values: Mapping[str, Any]
    keys: Mapping[str, str] = field(default_factory=dict)
    signature: frozenset[str] = frozenset()
    postures: Mapping[str, float] = field(default_factory=dict)
    by_joint: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)


def _both(**angles: float) -> dict[str, float]:
    """Return angles for the joints of both sides, in Unitree's names."""
    sides = ("left", "right")
    return {f"{s}_{n}_joint": a for s in sides for n, a in angles.items()}


HOLOSOMA = Convention(
    "holosoma",
    "https://github.com/amazon-far/holosoma, holosoma_inference/config: "
    "terms are sorted by name",
    {
        "terms": (
            Term("actions"),
            Term("base_ang_vel", (0.25,)),
            Term("command_ang_vel"),
            Term("command_lin_vel"),
            Term("cos_phase"),
            Term("joint_pos"),
            Term("joint_vel", (0.05,)),
            Term("projected_gravity"),
            Term("sin_phase"),
        ),
        "action_scale": 0.25,
        "action_clip": 100.0,
        "clock": PhaseClock(period=1.0, standing="holds"),
    },
    keys={
        "dof_names": "joints",
        "kp": "stiffness",
        "kd": "damping",
        "command_ranges": "command_ranges",
        "action_scale": "action_scale",
    },
    signature=frozenset({"dof_names", "kp", "kd"}),
    postures=_both(
        hip_pitch=-0.312,
        knee=0.669,
        ankle_pitch=-0.363,
        shoulder_pitch=0.2,
        elbow=0.6,
    )
    | {"left_shoulder_roll_joint": 0.2, "right_shoulder_roll_joint": -0.2}
    | {
        f"{side}_{name}": angle
        for side in ("Left", "Right")
        for name, angle in {
            "Shoulder_Pitch": 0.2,
            "Hip_Pitch": -0.2,
            "Knee_Pitch": 0.4,
            "Ankle_Pitch": -0.25,
        }.items()
    }
    | {
        "Left_Shoulder_Roll": -1.35,
        "Right_Shoulder_Roll": 1.35,
        "Left_Elbow_Yaw": -0.5,
        "Right_Elbow_Yaw": 0.5,
    },
    by_joint={
        "AAHead_yaw": {
            "terms": (
                Term("actions"),
                Term("base_ang_vel"),
                Term("command_ang_vel"),
                Term("command_lin_vel"),
                Term("cos_phase"),
                Term("joint_pos"),
                Term("joint_vel", (0.1,)),
                Term("projected_gravity"),
                Term("sin_phase"),
            )
        }
    },
)
_MANAGER_TERMS = (
    Term("base_lin_vel"),
    Term("base_ang_vel"),
    Term("projected_gravity"),
)
MJLAB = Convention(
    "mjlab",
    "https://github.com/mujocolab/mjlab, src/mjlab/rl/exporter_utils.py and "
    "tasks/velocity/velocity_env_cfg.py",
    {
        "terms": (
            *_MANAGER_TERMS,
            *(Term("joint_pos"), Term("joint_vel")),
            *(Term("actions"), Term("command")),
        ),
        "command_ranges": CommandRanges(turn=(-0.5, 0.5)),
    },
    keys={
        "joint_names": "joints",
        "joint_stiffness": "stiffness",
        "joint_damping": "damping",
        "default_joint_pos": "default_posture",
        "action_scale": "action_scale",
        "observation_names": "terms",
        "observation_history_lengths": "history",
    },
    signature=frozenset({"joint_names", "observation_names"}),
)
ISAAC_LAB = Convention(
    "isaac_lab",
    "https://github.com/isaac-sim/IsaacLab, isaaclab_tasks/manager_based/"
    "locomotion/velocity/velocity_env_cfg.py",
    {
        "terms": (
            *_MANAGER_TERMS,
            *(Term("command"), Term("joint_pos")),
            *(Term("joint_vel"), Term("actions")),
        ),
        "action_scale": 0.5,
    },
)
LEGGED_GYM = Convention(
    "legged_gym",
    "https://github.com/unitreerobotics/unitree_rl_gym, deploy/"
    "deploy_mujoco; scales, gains and posture are in the YAML file of the "
    "same name beside the network",
    {
        "terms": (
            Term("base_ang_vel", (0.25,)),
            Term("projected_gravity"),
            Term("command", (2.0, 2.0, 0.25)),
            Term("joint_pos"),
            Term("joint_vel", (0.05,)),
            Term("actions"),
            Term("sin_phase"),
            Term("cos_phase"),
        ),
        "action_scale": 0.25,
        "clock": PhaseClock(period=0.8, offsets=(0.0,)),
    },
)
MUJOCO_PLAYGROUND = Convention(
    "mujoco_playground",
    "https://github.com/google-deepmind/mujoco_playground, mujoco_playground/"
    "_src/locomotion/g1/joystick.py and t1/joystick.py",
    {
        "terms": (
            *_MANAGER_TERMS,
            *(Term("command"), Term("joint_pos")),
            *(Term("joint_vel"), Term("actions")),
            *(Term("cos_phase"), Term("sin_phase")),
        ),
        "action_scale": 0.5,
        # Trained with 1.25 to 1.5 gait cycles per second.
        "clock": PhaseClock(period=1.0 / 1.375),
        "command_ranges": CommandRanges(lateral=(-0.5, 0.5)),
    },
    by_joint={
        "AAHead_yaw": {
            "action_scale": 1.0,
            # Trained with 1.25 to 1.75 gait cycles per second.
            "clock": PhaseClock(period=1.0 / 1.5, standing="holds"),
            "command_ranges": CommandRanges(lateral=(-0.8, 0.8)),
        }
    },
)
BOOSTER_GYM = Convention(
    "booster_gym",
    "https://github.com/BoosterRobotics/booster_gym, deploy/utils/policy.py "
    "and deploy/configs/T1.yaml",
    {
        "terms": (
            Term("projected_gravity"),
            Term("base_ang_vel"),
            Term("command"),
            Term("cos_phase"),
            Term("sin_phase"),
            Term("joint_pos"),
            Term("joint_vel", (0.1,)),
            Term("actions"),
        ),
        "action_scale": 1.0,
        "action_clip": 1.0,
        "clock": PhaseClock(period=1.0, offsets=(0.0,), standing="silent"),
        "command_rate": 1.0,
    },
    postures={
        f"{side}_{name}": angle
        for side in ("Left", "Right")
        for name, angle in {
            "Hip_Pitch": -0.2,
            "Knee_Pitch": 0.4,
            "Ankle_Pitch": -0.25,
        }.items()
    },
)
_BHUMAN = (
    "https://github.com/bhuman/BHumanCodeRelease, Src/Modules/MotionControl/"
    "WalkingEngine/RLWalkingEngine.cpp, Config/Robots/Default; gains: Config/"
    "Scenes/Includes"
)
_BHUMAN_VALUES = {
    **BOOSTER_GYM.values,
    "command_rate": inf,
    "clock": PhaseClock(1.0 / 1.5, (0.0,), "silent", settling=1.0),
}


def _legs(sides: tuple[str, str], *names: str) -> tuple[str, ...]:
    """Return the joints of the left leg, then of the right one."""
    return tuple(f"{side}{name}" for side in sides for name in names)


BHUMAN = Convention(
    "bhuman",
    _BHUMAN,
    _BHUMAN_VALUES
    | {
        "joints": _legs(
            ("L", "R"),
            *("HipYawPitch", "HipRoll", "HipPitch"),
            *("KneePitch", "AnklePitch", "AnkleRoll"),
        ),
        # The simulator of B-Human has a damping of 0.5, with which straight
        # walks turn by up to 0.5 rad/s, and 4 of 10 random minutes end in
        # falls; with 1 they turn by 0.16 rad/s at most, without a fall.
        "stiffness": 40.0,
        "damping": 1.0,
        "command_ranges": CommandRanges(
            forward=(-0.6, 1.0), turn=(-radians(50.0), radians(50.0))
        ),
    },
    postures={
        f"{side}{name}": angle
        for side in "LR"
        for name, angle in {
            "HipPitch": -0.2,
            "KneePitch": 0.4,
            "AnklePitch": -0.25,
        }.items()
    },
)
_BOOSTER_LEGS = _legs(
    ("Left_", "Right_"),
    *("Hip_Pitch", "Hip_Roll", "Hip_Yaw"),
    *("Knee_Pitch", "Ankle_Pitch", "Ankle_Roll"),
)
_BHUMAN_BOOSTER = _BHUMAN_VALUES | {
    "terms": (*BOOSTER_GYM.values["terms"], Term("frequency")),
    "command_ranges": CommandRanges(
        lateral=(-0.5, 0.5), turn=(-radians(120.0), radians(120.0))
    ),
}
BHUMAN_K1 = Convention(
    "bhuman_k1",
    _BHUMAN,
    _BHUMAN_BOOSTER
    | {
        "joints": _BOOSTER_LEGS,
        "stiffness": (*4 * (135.0,), *2 * (35.0,)) * 2,
        "damping": (*4 * (3.5,), *2 * (2.5,)) * 2,
        "clock": replace(_BHUMAN_VALUES["clock"], spread=0.5),
    },
    postures=BOOSTER_GYM.postures,
)
BHUMAN_T1 = Convention(
    "bhuman_t1",
    _BHUMAN,
    _BHUMAN_BOOSTER
    | {
        "joints": ("Waist", *_BOOSTER_LEGS),
        "stiffness": (200.0, *(*4 * (200.0,), *2 * (50.0,)) * 2),
        "damping": (5.0, *(*4 * (5.0,), *2 * (3.0,)) * 2),
        "clock": replace(_BHUMAN_VALUES["clock"], settling=2.0, spread=0.5),
    },
    postures=BOOSTER_GYM.postures,
)
CONVENTIONS = {
    each.name: each
    for each in (
        HOLOSOMA,
        MJLAB,
        ISAAC_LAB,
        LEGGED_GYM,
        MUJOCO_PLAYGROUND,
        BOOSTER_GYM,
        BHUMAN,
        BHUMAN_K1,
        BHUMAN_T1,
    )
}
"""Conventions by name."""

COMMON_VALUES: Mapping[str, Any] = {
    "action_clip": inf,
    "observes_clipped": True,
    "action_filter": 0.0,
    "history": 1,
    "history_order": "term",
    "period": 0.02,
    "clock": None,
    "command_ranges": CommandRanges(),
    "command_rate": inf,
}
"""Values of contract fields that a convention does not mention."""

SPELLINGS = {
    "dof_pos": "joint_pos",
    "dof_vel": "joint_vel",
    "joint_pos_rel": "joint_pos",
    "joint_vel_rel": "joint_vel",
    "last_action": "actions",
    "velocity_commands": "command",
    "twist": "command",
    "gravity_orientation": "projected_gravity",
}
"""Other spellings of observation terms in metadata."""


def recognise(metadata: Mapping[str, str]) -> Convention | None:
    """Return the convention whose keys the metadata contain, if any."""
    for each in CONVENTIONS.values():
        if each.signature and each.signature <= metadata.keys():
            return each
    return None


def find_convention(name: str) -> Convention:
    """Return a convention by name.

    Raises:
        PolicyError: If there is none.
    """
    if name not in CONVENTIONS:
        raise PolicyError(
            f"legs contract must be one of {', '.join(CONVENTIONS)}, "
            f"got {name!r}"
        )
    return CONVENTIONS[name]
