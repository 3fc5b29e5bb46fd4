"""Contract of a network, the source of each value, and what is wrong.

Entries of the robot description come before the contract that a network
carries, that before the trainer's deployment file beside it, this before the
metadata of the exporter, and these before the convention of the trainer, a
file of ``conventions``.
"""

import json
import tomllib
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, fields
from functools import cache
from math import inf, isfinite
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ...core.errors import PolicyError
from ...core.setting import EntryReader
from .contract import (
    PER_JOINT,
    CommandRanges,
    HistoryOrder,
    ObservationTerm,
    PhaseClock,
    PolicyContract,
)
from .network import PolicyNetwork

OWN_ENTRY = "stepaside_contract"
"""Metadata entry with such entries as JSON."""

FOLDER = Path(__file__).parent / "conventions"
NOTHING: Mapping[str, Mapping[str, float]] = {}
MALFORMED = AttributeError, KeyError, RecursionError, TypeError, ValueError
PERIODS = 0.002, 0.1  # plausible control periods, in [s]
ANGLE = 3.2  # greatest plausible default angle, in [rad]
DEFAULTS: Mapping[str, Any] = {
    each.name: each.default
    for each in fields(PolicyContract)
    if isinstance(each.default, bool | int | float | str | CommandRanges)
} | {"clock": None}
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

AXES = {
    "lin_vel_x": "forward",
    "lin_vel_y": "lateral",
    "ang_vel_yaw": "turn",
    "ang_vel_z": "turn",
    "heading": "",  # from which trainers draw turning rates
}
"""Trainers' names of the axes of a command."""


@dataclass(frozen=True)
class Convention:
    """Contract values that one trainer has in common for its networks.

    Attributes:
        name: Name of the convention.
        source: Where it is published.
        values: Values as in ``[locomotion]`` of a robot description.
        metadata: Field by the metadata key that the exporter writes;
            ``terms.scale`` and the like have one value for each term.
        unused: Further keys that it writes, which change no contract.
        recognised_by: Metadata keys by which its networks are recognised.
        postures: Default angles by joint, in [rad], of robots whose networks
            do not contain them; joints that are absent are at zero.
        by_joint: Further values for robots that have a joint.
        deployment: Places of values in the YAML file that the trainer keeps
            beside a network, if it does: keys separated by dots.
    """

    name: str
    source: str
    values: dict[str, Any]
    metadata: dict[str, str] = field(default_factory=dict)
    unused: tuple[str, ...] = ()
    recognised_by: tuple[str, ...] = ()
    postures: dict[str, float] = field(default_factory=dict)
    by_joint: dict[str, dict[str, Any]] = field(default_factory=dict)
    deployment: dict[str, Any] = field(default_factory=dict)


@cache
def conventions() -> Mapping[str, Convention]:
    """Return the conventions of trainers by name."""
    return {
        path.stem: Convention(
            path.stem, **tomllib.loads(path.read_text(encoding="utf-8"))
        )
        for path in sorted(FOLDER.glob("*.toml"))
    }


class TermEntry(NamedTuple):
    """Term of an observation with its scale and clip."""

    name: str
    scale: float | tuple[float, ...] = 1.0
    clip: float = inf


ByJoint = float | tuple[float, ...] | dict[str, float]


@dataclass(frozen=True)
class LocomotionEntries:
    """Entries of ``[locomotion]`` in a robot description.

    Those of :class:`.PolicyContract`; values of joints also as one for all,
    or by joint.
    """

    network: str | None = None
    convention: str | None = None
    joints: tuple[str, ...] | None = None
    terms: tuple[str | TermEntry, ...] | None = None
    default_posture: ByJoint | None = None
    stiffness: ByJoint | None = None
    damping: ByJoint | None = None
    action_scale: ByJoint | None = None
    action_clip: float | None = None
    observes_clipped: bool | None = None
    action_filter: float | None = None
    history: int | None = None
    history_order: HistoryOrder | None = None
    period: float | None = None
    clock: PhaseClock | None = None
    command_ranges: CommandRanges | None = None
    command_rate: float | None = None


class Finding(NamedTuple):
    """One remark about a contract.

    Attributes:
        severity: "error" if the network cannot run, else "warning".
        text: What is wrong, with the name of the entry.
    """

    severity: str
    text: str


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

    def put_entries(self, entries: Mapping[str, Any], source: str) -> None:
        """Set values of entries as in ``[locomotion]``.

        Raises:
            PolicyError: If one is unknown or of another type.
        """
        reader = EntryReader()
        own = reader.read_table(entries, LocomotionEntries, "locomotion")
        if reader.problems:
            raise PolicyError(reader.text)
        for key in entries:
            if key == "terms":
                self.put(key, tuple(map(_term, own.terms)), source)
            elif key not in ("network", "convention"):
                self.put(key, getattr(own, key), source)

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
                "given in [locomotion] of robot.toml, or by --set "
                "legs.contract=NAME"
            )
        return PolicyContract(**self.values)


def read_contract(
    network: PolicyNetwork,
    *,
    motors: Sequence[str],
    legs: Sequence[str],
    entries: Mapping[str, Any],
    published: Mapping[str, Mapping[str, float]] = NOTHING,
    convention: str = "",
) -> ContractReading:
    """Collect the contract of a network.

    Args:
        network: The network.
        motors: Actuated joints of the robot, in the order of its model.
        legs: Leg joints of the robot, in the order of its description.
        entries: Entries of ``[locomotion]`` of the robot description.
        published: Gains and posture of the robot's model, by joint, which
            fill in what is missing.
        convention: Name of the convention; empty to recognise it.

    Raises:
        PolicyError: If an entry is unknown or malformed.
    """
    own = _own_entries(network)
    name = convention or entries.get("convention", own.get("convention", ""))
    used = _convention_of(str(name), network.metadata)
    reading = ContractReading(convention=used)
    for key, value in DEFAULTS.items():
        reading.put(key, value, "default")
    reading.put("convention", "none", "default")
    if used is not None:
        reading.put("convention", used.name, "given" if name else "recognised")
        reading.put_entries(used.values, used.name)
        _put_metadata(reading, network.metadata, used)
        beside = network.path.with_suffix(".yaml")
        if used.deployment and beside.is_file():
            _put_deployment(reading, beside, used)
    reading.put_entries(own, f"metadata {OWN_ENTRY}")
    reading.put_entries(entries, "robot.toml")
    for names, words in ((motors, "all joints"), (legs, "leg joints")):
        fits = len(names) == network.action.width
        if "joints" not in reading.values and fits:
            reading.put("joints", tuple(names), f"assumed: {words} in order")
    if used is not None:
        _put_robot_values(reading, used)
    joints = reading.values.get("joints", ())
    for key, values in published.items():
        own = {name: values[name] for name in joints if name in values}
        if key not in reading.values and len(own) == len(joints) > 0:
            reading.put(key, own, "model")
    _spread(reading)
    _drop_unobserved_velocity(reading, network)
    return reading


def examine(
    reading: ContractReading, network: PolicyNetwork, joints: Collection[str]
) -> tuple[Finding, ...]:
    """Return what is missing or wrong in a contract.

    Args:
        reading: Values that were read.
        network: Network of the policy.
        joints: Joints of the robot; empty if the robot is not known.
    """
    errors = [f"{name} is missing" for name in reading.missing]
    if not errors:
        try:
            errors += _misfits(reading.contract(), network)
        except PolicyError as error:
            errors.append(str(error))
    if joints:
        errors += [
            f"the robot has no joint {name!r}"
            for name in reading.values.get("joints", ())
            if name not in joints
        ]
    used, read = reading.convention, {OWN_ENTRY}
    if used is not None:
        read |= {*used.metadata, *used.unused}
    warnings = [
        f"metadata key {key!r} is not read"
        for key in network.metadata
        if key not in read
    ]
    if network.draws:
        warnings.append(
            "the network draws random numbers: the same walk never comes again"
        )
    return (
        *(Finding("error", text) for text in errors),
        *(Finding("warning", t) for t in warnings + _implausible(reading)),
    )


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


def _convention_of(
    name: str, metadata: Mapping[str, str]
) -> Convention | None:
    """Return a convention by name, else by its metadata keys, if any."""
    known = conventions()
    if name and name not in known:
        raise PolicyError(
            f"legs contract must be one of {', '.join(known)}, got {name!r}"
        )
    if name:
        return known[name]
    for each in known.values():
        if each.recognised_by and set(each.recognised_by) <= metadata.keys():
            return each
    return None


def _own_entries(network: PolicyNetwork) -> dict[str, Any]:
    """Return the entries in the metadata of the network."""
    text = network.metadata.get(OWN_ENTRY, "{}")
    try:
        return dict(json.loads(text))
    except (TypeError, ValueError, RecursionError) as error:
        raise PolicyError(
            f"legs: metadata entry {OWN_ENTRY!r} is malformed: {text[:60]!r}"
        ) from error


def _put_metadata(
    reading: ContractReading, metadata: Mapping[str, str], used: Convention
) -> None:
    """Read the keys of an exporter: JSON, or values separated by commas."""
    for key, target in used.metadata.items():
        text = metadata.get(key, "null")
        if text in ("null", ""):
            continue
        try:
            try:
                value = json.loads(text)
            except ValueError:
                value = [part.strip() for part in text.split(",")]
                value = value[0] if len(value) == 1 else value
            if target.startswith("terms."):
                _change_terms(reading, target[6:], value)
            elif target == "flattened":
                _check_flattened(reading, value)
            else:
                if target == "history":  # exporters write 0 for none
                    value = [max(1.0, float(x)) for x in _listed(value)]
                value = _value_of(target, value)
                reading.put(target, value, f"metadata {key}")
        except MALFORMED as error:
            raise PolicyError(
                f"legs: metadata entry {key!r} is malformed: {text[:60]!r}"
            ) from error


def _change_terms(reading: ContractReading, key: str, given: Any) -> None:
    """Change one property of all terms, in order or by name."""
    terms: tuple[ObservationTerm, ...] = reading.values["terms"]
    values = _listed(given)
    if isinstance(given, Mapping):
        values = [given.get(term.name) for term in terms]
    changed = [
        term if value is None else term._replace(**_property(key, value))
        for term, value in zip(terms, values, strict=True)
    ]
    reading.values["terms"] = tuple(changed)


def _property(key: str, value: Any) -> dict[str, Any]:
    """Return the property of a term by a value of metadata."""
    parts = value.split(";") if isinstance(value, str) else value
    numbers = tuple(map(float, _listed(parts)))
    if key == "clip":
        low, high = (-numbers[0], *numbers)[-2:]
        if low != -high:
            raise ValueError(value)
        return {"clip": high}
    return {"scale": numbers}


def _check_flattened(reading: ContractReading, value: Any) -> None:
    """Refuse an input in which the past has an axis of its own."""
    flat = (1, 1.0, "1", "1.0", "1.000", "true", "True")
    if reading.values["history"] > 1:
        if any(each not in flat for each in _listed(value)):
            raise ValueError(value)


def _listed(value: Any) -> list[Any]:
    return value if isinstance(value, list) else [value]


def _put_deployment(
    reading: ContractReading, path: Path, used: Convention
) -> None:
    """Read the YAML file that a trainer keeps beside a network."""
    import yaml

    try:
        given = yaml.safe_load(path.read_text(encoding="utf-8"))
        places = dict(used.deployment)
        scales = places.pop("scales")
        entries = {key: _found(given, where) for key, where in places.items()}
        step, every = entries["period"]
        entries["period"] = round(float(step) * int(every), 9)
        moved = slice(-int(entries.pop("moved", 0)), None)
        for key in PER_JOINT:
            if isinstance(entries.get(key), list):
                entries[key] = entries[key][moved]
        for key, value in entries.items():
            reading.put(key, _value_of(key, value), path.name)
        found = {name: _found(given, where) for name, where in scales.items()}
        _change_terms(reading, "scale", found)
        reading.sources["terms"] = path.name
    except OSError as error:
        raise PolicyError(
            f"legs: cannot read {path}: {error.strerror}"
        ) from error
    except (yaml.YAMLError, *MALFORMED) as error:
        lacks = f": it lacks {error}" if isinstance(error, KeyError) else ""
        raise PolicyError(
            f"legs: {path} is not a deployment file of {used.name}{lacks}"
        ) from error


def _found(given: Any, where: Any) -> Any:
    """Return the value at a place in nested tables, or at several."""
    if isinstance(where, list):
        return [_found(given, each) for each in where]
    for key in where.split("."):
        given = given[key]
    return given


def _put_robot_values(reading: ContractReading, used: Convention) -> None:
    """Add what the convention knows of the robot with these joints."""
    joints = reading.values.get("joints", ())
    for joint, values in used.by_joint.items():
        for key, value in values.items():
            if joint in joints and reading.sources.get(key) == used.name:
                source = f"{used.name}, for {joint}"
                reading.put_entries({key: value}, source)
    if any(name in used.postures for name in joints):
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
    used = reading.convention
    if reading.missing or used is None:
        return
    terms = reading.values["terms"]
    without = tuple(t for t in terms if t.name != "base_lin_vel")
    if reading.sources["terms"] != used.name or without == terms:
        return
    narrower = PolicyContract(**(reading.values | {"terms": without}))
    if narrower.observation_width == network.observation.width:
        reading.put("terms", without, f"{used.name}, without base_lin_vel")


def _misfits(contract: PolicyContract, network: PolicyNetwork) -> list[str]:
    """Compare the widths of contract and network."""
    found = []
    if network.observation.width != contract.observation_width:
        terms = ", ".join(
            f"{term.name} {contract.width_of(term)}" for term in contract.terms
        )
        found.append(
            f"input {network.observation} must have "
            f"{contract.observation_width} values: {contract.history} x "
            f"({terms})"
        )
    if network.action.width != contract.action_width:
        more = contract.action_width > len(contract.joints)
        found.append(
            f"output {network.action} must have {contract.action_width} "
            "values, one for each joint" + " and one for the clock" * more
        )
    return found


def _implausible(reading: ContractReading) -> list[str]:
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
    if damping is not None and damping.size and (damping == 0.0).all():
        sign = "-0" if np.signbit(damping).any() else "0"
        texts.append(
            f"damping is {sign} at every joint: the exporter did not write "
            "the gains"
        )
    if (arrays.get("action_scale", np.ones(1)) == 0.0).any():
        texts.append("action_scale is 0: those joints never move")
    if (np.abs(arrays.get("default_posture", np.zeros(1))) > ANGLE).any():
        texts.append(
            f"default_posture exceeds {ANGLE} rad: the unit must be [rad]"
        )
    if not PERIODS[0] <= values["period"] <= PERIODS[1]:
        texts.append(
            f"period must lie in [{PERIODS[0]}, {PERIODS[1]}] [s], got "
            f"{values['period']}"
        )
    return texts


def _value_of(target: str, value: Any) -> Any:
    """Convert a value of metadata or of YAML to that of a field."""
    if target == "terms":
        return tuple(_term(each) for each in value)
    if target == "joints":
        return tuple(str(each) for each in value)
    if target == "command_ranges":
        named = {AXES.get(key, key): limits for key, limits in value.items()}
        ranges = CommandRanges()._asdict()
        for axis, (low, high) in named.items():
            if axis:
                ranges[axis] = float(low), float(high)
        return CommandRanges(**ranges)
    if target == "clock":
        return PhaseClock(**{key: _plain(x) for key, x in value.items()})
    if target == "history":
        (length,) = {float(each) for each in _listed(value)}  # all alike
        if not length.is_integer():
            raise ValueError(value)
        return int(length)
    if target in PER_JOINT:
        if isinstance(value, Mapping):
            return {key: _number(x) for key, x in value.items()}
        if isinstance(value, list):
            return tuple(_number(x) for x in value)
        return _number(value)
    if target in ("period", "action_clip", "action_filter", "command_rate"):
        return _number(value)
    return value


def _plain(value: Any) -> Any:
    return tuple(map(float, value)) if isinstance(value, list) else value


def _number(value: Any) -> float:
    number = float(value)
    if not isfinite(number):
        raise ValueError(value)
    return number


def _term(given: Any) -> ObservationTerm:
    """Return a term given by name, table or :class:`TermEntry`."""
    entry = given
    if isinstance(given, str):
        entry = TermEntry(given)
    elif isinstance(given, Mapping):
        entry = TermEntry(**given)
    name = SPELLINGS.get(entry.name, entry.name)
    scales = entry.scale
    if isinstance(scales, int | float):
        scales = (scales,)
    return ObservationTerm(name, tuple(map(float, scales)), entry.clip)
