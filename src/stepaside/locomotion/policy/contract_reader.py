"""Contract of a network, the source of each value, and what is wrong.

Entries of the robot description come before the contract that a network
carries, that before the trainer's deployment file beside it, this before the
metadata of the exporter, and these before the convention of the trainer, a
file of ``conventions``.
"""

import json
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from functools import cache
from math import isfinite
from pathlib import Path
from typing import Any, NamedTuple, get_type_hints

import numpy as np

from ...core.errors import PolicyError
from ...core.setting import EntryReader, descriptions_of
from ...robots.description import RobotDescription
from ...robots.tree_cache import load_tree
from .contract import PER_JOINT, PolicyContract
from .runner import PolicyNetwork

OWN_ENTRY = "stepaside_contract"
"""Metadata entry with such entries as JSON."""

FOLDER = Path(__file__).parent / "conventions"
MALFORMED = AttributeError, KeyError, RecursionError, TypeError, ValueError
LEAST_PERIOD = 0.002  # that is plausible, in [s]
UNSET = ("convention", "joints", "terms", *PER_JOINT)  # without defaults
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
    """Contract values that one trainer has in common for its networks."""

    name: str
    source: str  # where it is published
    # values as in ``[locomotion]`` of a robot description
    values: dict[str, Any]
    metadata: dict[str, str] = field(default_factory=dict)
    # further keys that it writes, which change no contract
    unused: tuple[str, ...] = ()
    # metadata keys by which its networks are recognised
    recognised_by: tuple[str, ...] = ()
    postures: dict[str, float] = field(default_factory=dict)  # [rad]
    # further values for robots that have a joint
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


class Finding(NamedTuple):
    """One remark about a contract."""

    severity: str  # "error" if the network cannot run, else "warning"
    text: str  # what is wrong, with the name of the entry


class RobotJoints(NamedTuple):
    """What a contract takes from a robot; empty if it is not known."""

    motors: tuple[str, ...] = ()  # actuated joints, in the order of the model
    driven: tuple[str, ...] = ()  # all joints that motors move
    legs: tuple[str, ...] = ()  # leg joints, in the order of the description
    entries: Mapping[str, Any] = {}  # ``[locomotion]`` of the description
    # gains and posture of the model, by joint, which fill in what is missing
    published: Mapping[str, Mapping[str, float]] = {}

    @classmethod
    def of(cls, description: RobotDescription) -> "RobotJoints":
        """Return those of a description."""
        tree, own = load_tree(description), description
        joints = tree.motors, tuple(tree.driven_joints), own.legs
        return cls(*joints, own.locomotion, own.published)


@dataclass
class ContractReading:
    """Values of a contract with their sources; some may be missing."""

    network: PolicyNetwork
    # convention in use; None if none was named or recognised
    convention: Convention | None
    # values by field of the contract
    values: dict[str, Any] = field(default_factory=dict)
    # source of each value, as text
    sources: dict[str, str] = field(default_factory=dict)
    # what is missing, wrong or implausible
    findings: list[Finding] = field(default_factory=list)
    # the contract; None if it is incomplete or invalid
    contract: PolicyContract | None = None

    def put(self, entries: Mapping[str, Any], source: str) -> None:
        """Set values of entries, in place of earlier ones."""
        for key, value in entries.items():
            if key in ("network", "convention"):
                continue
            if key == "terms" and isinstance(value, list):
                value = list(map(_term, value))
            self.values[key], self.sources[key] = value, source

    def check(self) -> PolicyContract:
        """Return the contract of a network that can run."""
        errors = [each for each in self.findings if each.severity == "error"]
        if errors or self.contract is None:
            raise PolicyError(f"legs: {self.network.path}: {errors[0].text}")
        return self.contract


def read_contract(
    network: PolicyNetwork,
    robot: RobotJoints = RobotJoints(),  # noqa: B008 (immutable)
    convention: str = "",
) -> ContractReading:
    """Collect and examine the contract of a network."""
    own = _own_entries(network)
    name = convention or robot.entries.get("convention", own.get("convention"))
    used = _convention_of(str(name or ""), network.metadata)
    reading = ContractReading(network, used)
    known = {each.name: each.default for each in fields(PolicyContract)}
    reading.put({k: known[k] for k in known if k not in UNSET}, "default")
    reading.values["convention"] = "none" if used is None else used.name
    reading.sources["convention"] = "given" if name else "recognised"
    if used is not None:
        reading.put(used.values, used.name)
        _put_metadata(reading, used)
        beside = network.path.with_suffix(".yaml")
        if used.deployment and beside.is_file():
            _put_deployment(reading, beside, used)
    reading.put(own, f"metadata {OWN_ENTRY}")
    reading.put(robot.entries, "robot.toml")
    _complete(reading, robot)
    _examine(reading, robot)
    return reading


def _convention_of(
    name: str, metadata: Mapping[str, str]
) -> Convention | None:
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
    text = network.metadata.get(OWN_ENTRY, "{}")
    try:
        return dict(json.loads(text))
    except (TypeError, ValueError, RecursionError) as error:
        raise PolicyError(
            f"legs: metadata entry {OWN_ENTRY!r} is malformed: {text[:60]!r}"
        ) from error


def _put_metadata(reading: ContractReading, used: Convention) -> None:
    for key, target in used.metadata.items():
        text = reading.network.metadata.get(key, "null")
        if text in ("null", ""):
            continue
        try:
            value = _parsed(text)
            if target.startswith("terms."):
                _change_terms(reading, target[6:], value)
            elif target == "flattened":
                _check_flattened(reading, value)
            else:
                value = _converted(target, value)
                reading.put({target: value}, f"metadata {key}")
        except MALFORMED as error:
            raise PolicyError(
                f"legs: metadata entry {key!r} is malformed: {text[:60]!r}"
            ) from error


def _parsed(text: str) -> Any:
    """Return JSON, or values separated by commas."""
    try:
        return json.loads(text)
    except ValueError:
        parts = [part.strip() for part in text.split(",")]
    try:
        numbers: list[Any] = list(map(float, parts))
    except ValueError:
        numbers = parts
    return numbers if len(numbers) > 1 else numbers[0]


def _converted(target: str, value: Any) -> Any:
    """Turn a value of an exporter into that of an entry."""
    if target == "command_ranges":
        named = {AXES.get(key, key): limits for key, limits in value.items()}
        return {axis: limits for axis, limits in named.items() if axis}
    if target == "history":  # exporters write 0 for none
        lengths = {max(1.0, float(each)) for each in _listed(value)}
        return int(*lengths) if len(lengths) == 1 else value
    if target in ("joints", "terms", *PER_JOINT):
        return value if isinstance(value, dict) else _listed(value)
    return value


def _change_terms(reading: ContractReading, key: str, given: Any) -> None:
    """Change one property of all terms, in order or by name."""
    terms, values = reading.values["terms"], _listed(given)
    if isinstance(given, Mapping):
        values = [given.get(term["name"]) for term in terms]
    reading.values["terms"] = [
        term if value is None else term | _property(key, value)
        for term, value in zip(terms, values, strict=True)
    ]


def _property(key: str, value: Any) -> dict[str, Any]:
    parts = value.split(";") if isinstance(value, str) else value
    numbers = list(map(float, _listed(parts)))
    if key == "scale":
        return {"scale": numbers}
    low, high = (-numbers[0], *numbers)[-2:]
    if low != -high:
        raise ValueError(value)
    return {"clip": high} if isfinite(high) else {}


def _check_flattened(reading: ContractReading, value: Any) -> None:
    """Refuse an input in which the past has an axis of its own."""
    flat = (1, 1.0, "1", "1.0", "1.000", "true", "True")
    if reading.values["history"] != 1:
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
        found = {name: _found(given, where) for name, where in scales.items()}
        _change_terms(reading, "scale", found)
        reading.put(entries, path.name)
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


def _complete(reading: ContractReading, robot: RobotJoints) -> None:
    """Add what the robot and its convention tell, joint by joint."""
    values, used = reading.values, reading.convention
    width = reading.network.action.width
    for names, words in ((robot.motors, "all"), (robot.legs, "leg")):
        if "joints" not in values and len(names) == width:
            source = f"assumed: {words} joints in order"
            reading.put({"joints": list(names)}, source)
    joints = values.get("joints", [])
    if used is not None:
        for joint, known in used.by_joint.items():
            for key, value in known.items():
                if joint in joints and reading.sources[key] == used.name:
                    reading.put({key: value}, f"{used.name}, for {joint}")
        if not used.postures.keys().isdisjoint(joints):
            if "default_posture" not in values:
                angles = [used.postures.get(name, 0.0) for name in joints]
                reading.put({"default_posture": angles}, used.name)
    for key, given in robot.published.items():
        own = [given[name] for name in joints if name in given]
        if key not in values and len(own) == len(joints) > 0:
            reading.put({key: own}, "model")
    for key in PER_JOINT:
        if key in values:
            values[key] = _by_joint(key, values[key], joints)


def _by_joint(key: str, value: Any, joints: Any) -> Any:
    if isinstance(value, int | float):
        return [value] * len(joints)
    if not isinstance(value, Mapping):
        return value
    for joint in value:
        if joint not in joints:
            raise PolicyError(
                f"locomotion.{key}: {joint!r} is not a joint of the policy; "
                f"there are {', '.join(joints)}"
            )
    absent = [joint for joint in joints if joint not in value]
    if absent and key != "default_posture":
        raise PolicyError(f"locomotion.{key}.{absent[0]} is missing")
    return [value.get(joint, 0.0) for joint in joints]


def _term(given: Any) -> Any:
    """Return a term, given by name or as a table, as a table."""
    entry = {"name": given} if isinstance(given, str) else given
    if not isinstance(entry, Mapping):
        return given
    name, scale = entry.get("name"), entry.get("scale", 1.0)
    return {
        **entry,
        "name": SPELLINGS.get(str(name), name),
        "scale": list(scale) if isinstance(scale, list | tuple) else [scale],
    }


def _examine(reading: ContractReading, robot: RobotJoints) -> None:
    """Build the contract, and note what is missing or wrong."""
    values, network = reading.values, reading.network
    missing = [f"{name} is missing" for name in UNSET if name not in values]
    errors = _read_fields(reading) + missing
    if not errors:
        try:
            contract = _fitted(reading, PolicyContract(**reading.values))
            reading.contract = contract
            errors += _misfits(contract, network)
        except PolicyError as error:
            errors.append(str(error))
    if robot.driven:
        errors += [
            f"the robot has no joint {name!r}"
            for name in values.get("joints", ())
            if name not in robot.driven
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
    reading.findings += [Finding("error", text) for text in errors]
    warnings += _implausible(values)
    reading.findings += [Finding("warning", text) for text in warnings]


def _read_fields(reading: ContractReading) -> list[str]:
    """Turn the values into those of a contract; return what does not fit."""
    hints, known = (
        get_type_hints(PolicyContract),
        descriptions_of(PolicyContract),
    )
    problems = []
    for name, value in list(reading.values.items()):
        source = reading.sources[name]
        if name not in hints:
            problems.append(
                f"unknown entry locomotion.{name} ({source}); there are "
                f"{', '.join(hints)}"
            )
            continue
        reader = EntryReader()
        path = f"locomotion.{name}"
        read = reader.read(value, hints[name], path, known[name])
        reading.values[name] = read
        if reader.problems:
            del reading.values[name]
            problems.append(f"{reader.text} ({source})")
    return problems


def _fitted(
    reading: ContractReading, contract: PolicyContract
) -> PolicyContract:
    """Leave out the linear velocity where the input is narrower by it.

    Trainers drop it for robots that cannot measure it.
    """
    used, sources = reading.convention, reading.sources
    without = tuple(t for t in contract.terms if t.name != "base_lin_vel")
    if used is None or sources["terms"] != used.name or not without:
        return contract
    narrower = replace(contract, terms=without)
    width = reading.network.observation.width
    if narrower == contract or narrower.observation_width != width:
        return contract
    reading.values["terms"] = without
    sources["terms"] = f"{used.name}, without base_lin_vel"
    return narrower


def _misfits(contract: PolicyContract, network: PolicyNetwork) -> list[str]:
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


def _implausible(values: Mapping[str, Any]) -> list[str]:
    """Find values that occur in published files and cannot be meant."""
    plausible = np.array([2.0])
    stiffness, damping, scale = (
        np.array(values.get(name, plausible), dtype=float)
        for name in ("stiffness", "damping", "action_scale")
    )
    sign = "-0" if np.signbit(damping).any() else "0"
    unwritten = "at every joint: the exporter did not write the gains"
    period = values.get("period", LEAST_PERIOD)
    found = {
        "stiffness is 0 N m/rad: those joints are limp": (
            (stiffness == 0.0).any()
        ),
        f"stiffness is 1 N m/rad {unwritten}": (
            stiffness.size > 1 and (stiffness == 1.0).all()
        ),
        f"damping is {sign} {unwritten}": (
            damping.size and (damping == 0.0).all()
        ),
        "action_scale is 0: those joints never move": (scale == 0.0).any(),
        f"period must be at least {LEAST_PERIOD} [s], got {period}": (
            period < LEAST_PERIOD
        ),
    }
    return [text for text, holds in found.items() if holds]
