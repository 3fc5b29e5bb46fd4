"""Learned legs of a robot, from its settings and files."""

from pathlib import Path

from ...robots.description import RobotDescription
from .contract import PolicyContract
from .contract_reader import RobotJoints, read_contract
from .legs_settings import LegsSettings
from .network import PolicyNetwork
from .network_pool import NetworkPool
from .policy_legs import PolicyLegs
from .response_file import load_response


def load_policy(
    legs: LegsSettings,
    description: RobotDescription,
    pool: NetworkPool | None = None,
) -> tuple[PolicyContract, PolicyNetwork]:
    """Load a network with its contract for one robot.

    Args:
        legs: Settings of the legs.
        description: Description of the robot.
        pool: Pool whose walkers share networks; by default the network is
            loaded for this robot.

    Raises:
        PolicyError: If the network cannot run on the robot.
    """
    network = (pool or NetworkPool()).load(Path(legs.network))
    robot = RobotJoints.of(description)
    return read_contract(network, robot, legs.contract).check(), network


def load_legs(
    legs: LegsSettings,
    description: RobotDescription,
    *,
    tick: float,
    pool: NetworkPool | None = None,
) -> PolicyLegs:
    """Build learned legs, with their measured response if there is one.

    Args:
        legs: Settings of the legs.
        description: Description of the robot.
        tick: Control period, in [s].
        pool: Pool whose walkers share networks, if any.

    Raises:
        PolicyError: If the network cannot run on the robot.
    """
    contract, network = load_policy(legs, description, pool)
    return PolicyLegs(
        contract,
        network,
        description,
        tick=tick,
        response=load_response(description.folder, network.path),
        learns=legs.learn,
    )
