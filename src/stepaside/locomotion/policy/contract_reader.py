"""Contract of a network from its metadata, its robot and a convention."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields
from math import isfinite
from typing import Any

from ...core.errors import PolicyError
from .contract import (
    PER_JOINT,
    CommandRanges,
    ObservationTerm,
    PhaseClock,
    PolicyContract,
)
from .deployment_file import DEPLOYMENTS, read_deployment
from .network import PolicyNetwork
from .trainer_conventions import (
    COMMON_VALUES,
    SPELLINGS,
    Convention,
    find_convention,
    recognise,
)

ENTRIES = (
    *(each.name for each in fields(PolicyContract)),
    "network",
)
"""Entries of ``[locomotion]`` in a robot description."""

OWN_ENTRY = "stepaside_contract"
"""Metadata entry with such entries as JSON."""

MALFORMED = AttributeError, KeyError, RecursionError, TypeError, ValueError


@dataclass
class ContractReading:
    """Values of a contract with their sources; some may be missing.

    Attributes:
        values: Values by field of the contract.
        sources: Source of each value, as text.
        convention: Convention in use; None if none was named or recognised.
    """

    values: dict[str, Any] = field(default_factory=dict)
    sources: dict[str, str] = field(default_factory=dict)
    convention: Convention | None = None

    def put(self, name: str, value: Any, source: str) -> None:
        """Set a value, in place of an earlier one."""
        self.values[name], self.sources[name] = value, source

    @property
    def missing(self) -> tuple[str, ...]:
        """Fields of the contract without a value."""
        return tuple(
            each.name
            for each in fields(PolicyContract)
            if each.name not in self.values
        )

    def contract(self) -> PolicyContract:
        """Return the complete contract.

        Raises:
            PolicyError: If a value is missing or does not fit the others.
        """
        if self.missing:
            raise PolicyError(
                f"legs: {', '.join(self.missing)} of the contract must be "
                "given in [locomotion] of robot.toml, or by --legs-contract"
            )
        return PolicyContract(**self.values)


def read_contract(
    network: PolicyNetwork,
    *,
    motors: Sequence[str],
    legs: Sequence[str],
    entries: Mapping[str, Any],
    convention: str = "",
) -> ContractReading:
    """Collect the contract of a network.

    Entries of the robot description come before metadata of the network, and
    these before the convention.

    Args:
        network: The network.
        motors: Actuated joints of the robot, in the order of its model.
        legs: Leg joints of the robot, in the order of its description.
        entries: Entries of ``[locomotion]`` of the robot description.
        convention: Name of the convention; empty to recognise it.

    Raises:
        PolicyError: If an entry is unknown or malformed.
    """
    own = _own_entries(network)
    for key in (*entries, *own):
        if key not in ENTRIES:
            raise PolicyError(
                f"unknown entry locomotion.{key}; there are "
                f"{', '.join(ENTRIES)}"
            )
    named = entries.get("convention", own.get("convention", ""))
    name = convention or str(named)
    used = find_convention(name) if name else recognise(network.metadata)
    reading = ContractReading(convention=used)
    for key, value in COMMON_VALUES.items():
        reading.put(key, value, "default")
    if used is not None:
        reading.put("convention", used.name, "given" if name else "recognised")
        for key, value in used.values.items():
            reading.put(key, value, used.name)
        for key, target in used.keys.items():
            text = network.metadata.get(key, "null")
            if text not in ("null", ""):
                value = _from_metadata(key, target, text)
                reading.put(target, value, f"metadata {key}")
        beside = network.path.with_suffix(".yaml")
        if used.name in DEPLOYMENTS and beside.is_file():
            _put_entries(reading, read_deployment(beside, used), beside.name)
    else:
        reading.put("convention", "none", "default")
    _put_entries(reading, own, f"metadata {OWN_ENTRY}")
    _put_entries(reading, entries, "robot.toml")
    _put_joints(reading, network, motors, legs)
    if used is not None:
        _put_robot_values(reading, used)
    _spread(reading)
    _drop_unobserved_velocity(reading, network)
    return reading


def _own_entries(network: PolicyNetwork) -> dict[str, Any]:
    """Return the entries in the metadata of the network."""
    text = network.metadata.get(OWN_ENTRY, "{}")
    try:
        return dict(json.loads(text))
    except (TypeError, ValueError, RecursionError) as error:
        raise PolicyError(
            f"legs: metadata entry {OWN_ENTRY!r} is malformed: {text[:60]!r}"
        ) from error


def _put_entries(
    reading: ContractReading, entries: Mapping[str, Any], source: str
) -> None:
    """Set values of entries as in ``[locomotion]``."""
    for key, value in entries.items():
        if key not in ("network", "convention"):
            reading.put(key, _from_entry(key, value), source)


def _put_joints(
    reading: ContractReading,
    network: PolicyNetwork,
    motors: Sequence[str],
    legs: Sequence[str],
) -> None:
    """Assume joints of the robot where none are named and the number fits."""
    if "joints" in reading.values:
        return
    for names, words in ((motors, "all joints"), (legs, "leg joints")):
        if len(names) == network.action.width:
            reading.put("joints", tuple(names), f"assumed: {words} in order")
            return


def _put_robot_values(reading: ContractReading, used: Convention) -> None:
    """Add what the convention knows of the robot with these joints."""
    joints = reading.values.get("joints", ())
    for joint, values in used.by_joint.items():
        for key, value in values.items():
            if joint in joints and reading.sources.get(key) == used.name:
                reading.put(key, value, f"{used.name}, for {joint}")
    if used.postures and any(name in used.postures for name in joints):
        if "default_posture" not in reading.values:
            angles = tuple(used.postures.get(name, 0.0) for name in joints)
            reading.put("default_posture", angles, used.name)


def _spread(reading: ContractReading) -> None:
    """Turn single values and values by joint into one for each joint."""
    joints = reading.values.get("joints", ())
    for name in PER_JOINT:
        value = reading.values.get(name)
        if isinstance(value, float):
            reading.values[name] = (value,) * len(joints)
        elif isinstance(value, Mapping):
            for joint in value:
                if joint not in joints:
                    raise PolicyError(
                        f"locomotion.{name}: {joint!r} is not a joint of "
                        f"the policy; there are {', '.join(joints)}"
                    )
            rest = 0.0 if name == "default_posture" else None
            absent = [joint for joint in joints if joint not in value]
            if absent and rest is None:
                raise PolicyError(f"locomotion.{name}.{absent[0]} is missing")
            reading.values[name] = tuple(value.get(j, rest) for j in joints)


def _drop_unobserved_velocity(
    reading: ContractReading, network: PolicyNetwork
) -> None:
    """Leave out the linear velocity where the input is narrower by it.

    Trainers drop it for robots that cannot measure it.
    """
    terms = reading.values.get("terms", ())
    if reading.missing or reading.convention is None:
        return
    if reading.sources["terms"] != reading.convention.name:
        return
    without = tuple(t for t in terms if t.name != "base_lin_vel")
    narrower = PolicyContract(**(reading.values | {"terms": without}))
    if narrower.observation_width == network.observation.width:
        source = f"{reading.convention.name}, without base_lin_vel"
        if without != terms:
            reading.put("terms", without, source)


def _from_metadata(key: str, target: str, text: str) -> Any:
    """Parse a metadata entry: JSON, or values separated by commas."""
    try:
        try:
            value = json.loads(text)
        except ValueError:
            value = [part.strip() for part in text.split(",")]
            value = value[0] if len(value) == 1 else value
        return _value_of(target, value)
    except MALFORMED as error:
        raise PolicyError(
            f"legs: metadata entry {key!r} is malformed: {text[:60]!r}"
        ) from error


def _from_entry(key: str, value: Any) -> Any:
    """Convert an entry of a robot description."""
    if key == "command_ranges" and isinstance(value, Mapping):
        for axis in value:
            if axis not in CommandRanges._fields:
                raise PolicyError(
                    f"unknown entry locomotion.command_ranges.{axis}; there "
                    f"are {', '.join(CommandRanges._fields)}"
                )
    try:
        return _value_of(key, value)
    except PolicyError:
        raise
    except MALFORMED as error:
        raise PolicyError(
            f"locomotion.{key} is malformed, got {str(value)[:60]}"
        ) from error


def _value_of(target: str, value: Any) -> Any:
    """Convert a JSON, CSV or TOML value to that of a contract field."""
    if target == "terms":
        return tuple(_term(each) for each in value)
    if target == "joints":
        return tuple(str(each) for each in value)
    if target == "command_ranges":
        return _ranges(value)
    if target == "clock":
        return PhaseClock(**{k: _plain(v) for k, v in value.items()})
    if target == "history":
        lengths = set(value if isinstance(value, list) else [value])
        (length,) = lengths  # other than all alike is malformed
        return int(length)
    if target in PER_JOINT:
        if isinstance(value, Mapping):
            return {k: _number(v) for k, v in value.items()}
        if isinstance(value, list):
            return tuple(_number(x) for x in value)
        return _number(value)
    if target in ("period", "action_clip", "action_filter", "command_rate"):
        return _number(value)
    return value


def _number(value: Any) -> float:
    number = float(value)
    if not isfinite(number):
        raise ValueError(value)
    return number


def _plain(value: Any) -> Any:
    return tuple(map(float, value)) if isinstance(value, list) else value


def _term(value: Any) -> ObservationTerm:
    """Convert a name, or a table with name, scale and clip."""
    entry = {"name": value} if isinstance(value, str) else dict(value)
    name = SPELLINGS.get(entry["name"], entry["name"])
    scale = entry.get("scale", 1.0)
    scales = scale if isinstance(scale, list) else [scale]
    limits = {"clip": float(entry["clip"])} if "clip" in entry else {}
    return ObservationTerm(name, tuple(map(float, scales)), **limits)


def _ranges(value: Mapping[str, Any]) -> CommandRanges:
    """Convert ranges under our names, or under those of the trainers."""
    names = {
        "lin_vel_x": "forward",
        "lin_vel_y": "lateral",
        "ang_vel_yaw": "turn",
        "ang_vel_z": "turn",
    }
    found = {}
    for key, limits in value.items():
        name = names.get(key, key)
        if name in CommandRanges._fields:
            low, high = map(float, limits)
            found[name] = (low, high)
    return CommandRanges(**found)
