"""JavaScript of robots on learned legs: formulas, tables and addresses.

Kinematics, IMU, odometry, the filter of gravity and the inverse response of
the legs are the sources that Python runs; the network is a file that the
visitor of the page chooses.
"""

from hashlib import sha256
from math import inf
from pathlib import Path
from typing import Any

import numpy as np

from ..core.errors import ConfigurationError
from ..games.duel import Duel
from ..games.policy_player import PolicyPlayer
from ..locomotion.policy import gravity_filter, leg_odometry, policy_legs
from ..locomotion.policy.contract import PolicyContract
from ..locomotion.policy.legs_loader import load_policy
from ..locomotion.policy.network import PolicyNetwork
from ..locomotion.policy.policy_legs import PolicyLegs
from ..locomotion.policy.policy_walk import PolicyWalk
from ..locomotion.policy.runner import (
    ACT,
    OBSERVE,
    ObservationLayout,
    action_limits,
    clock_values,
)
from ..locomotion.policy.velocity_response import INVERT
from ..robots.description import RobotDescription, load_robot
from ..robots.forward_kinematics import ForwardKinematics, posture_source
from ..robots.tree_cache import load_tree
from ..sim.sensor_errors import STRAPDOWN, axes_of


def legs_of(player: object) -> PolicyLegs:
    """Return the learned legs of a player.

    Raises:
        ConfigurationError: If it walks in another way.
    """
    walk = player.scheme.locomotion if isinstance(player, PolicyPlayer) else 0
    if not isinstance(walk, PolicyWalk):
        raise ConfigurationError("both robots must walk by a policy")
    return walk.legs


def legs_sources(description: RobotDescription) -> list[str]:
    """Return the loops of learned legs as Python source.

    Args:
        description: The robot.
    """
    return [
        posture_source(description),
        leg_odometry.NOTE,
        INVERT,
        STRAPDOWN,
        gravity_filter.FOLLOW,
        policy_legs.LEARN,
        OBSERVE,
        ACT,
    ]


def legs_data(duel: Duel) -> dict[str, Any]:
    """Return the values of learned legs, as plain values.

    Args:
        duel: Duel of two equal robots on one policy.

    Raises:
        ConfigurationError: If the IMU is not on the torso.
    """
    settings = duel.settings.robot_of("pursuer")
    description = load_robot(settings.robot)
    legs = legs_of(duel.pursuer)
    contract, network = load_policy(settings.legs, description)
    if abs(contract.period - duel.world.physics.tick) > 1e-9:
        raise ConfigurationError(
            f"a page needs a policy whose period, {contract.period:g} [s], is "
            "a multiple of the time step of physics"
        )
    tree = load_tree(description)
    sizes, commands, effects = legs.response.tables
    learning = policy_legs.LEARNING if settings.legs.learn else 0.0
    forward = ForwardKinematics(description)
    return {
        "posture": legs.standing.posture.tolist(),
        "targets": legs.standing.joint_targets.tolist(),
        "joints": [tree.motor_of(name) for name in contract.joints],
        "coupled": legs.coupled,
        "corners": forward.force_sensors().tolist(),
        "smoothing": leg_odometry.SMOOTHING,
        "ratio": legs.response.odometry_ratio,
        "calibration": gravity_filter.CALIBRATION,
        "corrections": [
            [gravity_filter.FIRST, 0.0],
            [gravity_filter.CORRECTION, gravity_filter.BIAS_CORRECTION],
        ],
        "learning": learning,
        "bounds": [list(axis) for axis in legs.velocities[:3]],
        "sizes": sizes.tolist(),
        "commands": commands.tolist(),
        "effects": effects.tolist(),
        "gravity": duel.world.model.opt.gravity.tolist(),
        "policy": policy_data(contract),
        "network": network_data(network),
        "players": [body_data(duel, p, description) for p in duel.players],
    }


def policy_data(contract: PolicyContract) -> dict[str, Any]:
    """Return observations, actions and clock of a contract."""
    layout, clock = ObservationLayout.of(contract), contract.clock
    places = {
        name: [layout.places[name].start, layout.places[name].stop]
        for name in ("actions", "frequency")
    }
    return {
        "size": layout.size,
        **places,
        "order": layout.order.tolist(),
        "scales": layout.scales.tolist(),
        "clips": [x if x < inf else None for x in layout.clips.tolist()],
        "history": contract.history,
        "flat": layout.flat.tolist(),
        "default": list(contract.default_posture),
        "scale": list(contract.action_scale),
        "limits": [x if x < inf else None for x in action_limits(contract)],
        "period": contract.period,
        "clock": [x if x < inf else None for x in clock_values(contract)],
        "offsets": [] if clock is None else list(clock.offsets),
    }


def network_data(network: PolicyNetwork) -> dict[str, Any]:
    """Return names and shapes of a network, and the digest of its file."""
    path = Path(network.path)
    return {
        "file": path.name,
        "sha256": sha256(path.read_bytes()).hexdigest(),
        "input": network.observation.name,
        "output": network.action.name,
        "states": [
            [given.name, found.name, [size or 1 for size in given.shape]]
            for given, found in network.states
        ],
    }


def body_data(
    duel: Duel, player: Any, description: RobotDescription
) -> dict[str, Any]:
    """Return the addresses of a robot's sensors and joints in the model.

    Raises:
        ConfigurationError: If the IMU is not on the torso.
    """
    model, name = duel.world.model, player.name
    sensors = description.sensors
    joints = [
        model.joint(f"{name}/{joint}") for joint in player.robot.joint_names
    ]
    root = model.body(f"{name}/{description.torso}")
    free = model.joint(int(root.jntadr[0]))
    site = int(model.sensor_objid[model.sensor(f"{name}/{sensors.gyro}").id])
    if model.site_bodyid[site] != root.id:
        raise ConfigurationError(
            f"a page needs the IMU of {description.name} on its torso"
        )
    axes = axes_of(model.site_quat[site].tolist())
    return {
        "free": [int(free.qposadr[0]), int(free.dofadr[0])],
        "qpos": [int(joint.qposadr[0]) for joint in joints],
        "dofs": [int(joint.dofadr[0]) for joint in joints],
        "place": model.site_pos[site].tolist(),
        "mount": np.asarray(axes).tolist(),
        "forces": [
            int(model.sensor(f"{name}/{foot}").adr[0]) for foot in sensors.feet
        ],
    }
