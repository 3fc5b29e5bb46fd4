"""Findings about a contract: missing, misfitting and implausible values."""

from collections.abc import Collection
from typing import NamedTuple

import numpy as np

from ...core.errors import PolicyError
from .contract import PER_JOINT, PolicyContract
from .contract_reader import ContractReading
from .network import PolicyNetwork

PERIODS = 0.002, 0.1  # plausible control periods, in [s]
ANGLE = 3.2  # greatest plausible default angle, in [rad]


class Finding(NamedTuple):
    """One remark about a contract.

    Attributes:
        severity: "error" if the network cannot run, else "warning".
        text: What is wrong, with the name of the entry.
    """

    severity: str
    text: str


def examine(
    reading: ContractReading, network: PolicyNetwork, joints: Collection[str]
) -> tuple[Finding, ...]:
    """Return what is missing or wrong in a contract.

    Args:
        reading: Values that were read.
        network: Network of the policy.
        joints: Joints of the robot; empty if the robot is not known.
    """
    found = [
        Finding("error", f"{name} is missing") for name in reading.missing
    ]
    if not reading.missing:
        try:
            found += _misfits(reading.contract(), network)
        except PolicyError as error:
            found.append(Finding("error", str(error)))
    if joints:
        found += [
            Finding("error", f"the robot has no joint {name!r}")
            for name in reading.values.get("joints", ())
            if name not in joints
        ]
    read = reading.convention.keys if reading.convention else {}
    found += [
        Finding("warning", f"metadata key {key!r} is not read")
        for key in network.metadata
        if read and key.startswith("observation_") and key not in read
    ]
    return tuple(found + _implausible(reading))


def check_contract(
    reading: ContractReading, network: PolicyNetwork, joints: Collection[str]
) -> PolicyContract:
    """Return the contract of a network that can run on a robot.

    Raises:
        PolicyError: Names the first error.
    """
    for finding in examine(reading, network, joints):
        if finding.severity == "error":
            raise PolicyError(f"legs: {network.path}: {finding.text}")
    return reading.contract()


def _misfits(
    contract: PolicyContract, network: PolicyNetwork
) -> list[Finding]:
    """Compare the widths of contract and network."""
    found = []
    width = network.observation.width
    if width != contract.observation_width:
        terms = ", ".join(
            f"{term.name} {contract.width_of(term)}" for term in contract.terms
        )
        found.append(
            Finding(
                "error",
                f"input {network.observation} must have "
                f"{contract.observation_width} values: {contract.history} x "
                f"({terms})",
            )
        )
    if network.action.width != contract.action_width:
        more = " and one for the clock"
        found.append(
            Finding(
                "error",
                f"output {network.action} must have {contract.action_width} "
                "values, one for each joint"
                + more
                * (contract.action_width > len(contract.joints)),
            )
        )
    return found


def _implausible(reading: ContractReading) -> list[Finding]:
    """Find values that occur in published files and cannot be meant."""
    values, texts = reading.values, []
    arrays = {
        name: np.array(values[name]) for name in PER_JOINT if name in values
    }
    stiffness, damping = arrays.get("stiffness"), arrays.get("damping")
    if stiffness is not None:
        if (stiffness == 0.0).any():
            texts.append("stiffness is 0 N m/rad: those joints are limp")
        elif stiffness.size > 1 and (stiffness == 1.0).all():
            texts.append(
                "stiffness is 1 N m/rad at every joint: the exporter did not "
                "write the gains"
            )
    if damping is not None:
        if damping.size and (damping == 0.0).all():
            sign = "-0" if np.signbit(damping).any() else "0"
            texts.append(
                f"damping is {sign} at every joint: the exporter did not "
                "write the gains"
            )
    scale = arrays.get("action_scale")
    if scale is not None and (scale == 0.0).any():
        texts.append("action_scale is 0: those joints never move")
    posture = arrays.get("default_posture")
    if posture is not None and (np.abs(posture) > ANGLE).any():
        texts.append(
            f"default_posture exceeds {ANGLE} rad: the unit must be [rad]"
        )
    if not PERIODS[0] <= values["period"] <= PERIODS[1]:
        texts.append(
            f"period must lie in [{PERIODS[0]}, {PERIODS[1]}] [s], got "
            f"{values['period']}"
        )
    return [Finding("warning", text) for text in texts]
