"""Learned legs of a robot, from its settings and files."""

from pathlib import Path

from ...robots.description import RobotDescription
from .contract import PolicyContract
from .contract_reader import RobotJoints, read_contract
from .legs_settings import LegsSettings
from .network import PolicyNetwork
from .policy_legs import PolicyLegs
from .response_file import load_response


def load_policy(
    legs: LegsSettings,
    description: RobotDescription,
) -> tuple[PolicyContract, PolicyNetwork]:
    """Load a network with its contract for one robot."""
    network = PolicyNetwork(Path(legs.network))
    robot = RobotJoints.of(description)
    return read_contract(network, robot, legs.contract).check(), network


def load_legs(
    legs: LegsSettings,
    description: RobotDescription,
    *,
    tick: float,
) -> PolicyLegs:
    """Build learned legs, with their measured response if there is one."""
    contract, network = load_policy(legs, description)
    return PolicyLegs(
        contract,
        network,
        description,
        tick=tick,
        response=load_response(description.folder, network.path),
        learns=legs.learn,
    )
