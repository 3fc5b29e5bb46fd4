"""The text of a description, each value with where it comes from."""

from collections.abc import Iterable, Mapping
from typing import Any

from ..robots.description import RobotDescription
from ..robots.description_types import NO_OVERLAY, ServoGains
from .derivation import DerivedDescription, coupled_of
from .motor_data import GIVES

ASK = "ASK: the model does not say;"
GAIT_WHY = {
    "speed": "[m/s], of the path: a stride in 2.42 sqrt(z / g), as NAO's",
    "gain": "[1/s]: 0.033 sqrt(g / z), as NAO's",
    "stride": "[m]: 0.15 of the CoM's height",
    "foot_spacing": "[m]: between the ankles in the zero posture, or more "
    "where soles would meet",
    "step_height": "[m]: 0.075 of the CoM's height",
    "single_support": "[s]: 2.0 sqrt(z / g)",
    "double_support": "[s]: 0.58 sqrt(z / g)",
    "start_support": "[s]: 4.8 sqrt(z / g)",
    "zmp_forward": "[m]: 0.9 of the way to the middle of the sole",
}
GAIN_WHY = {
    "dead_zone": "[m]",
    "yielding": "[1/s]",
    "ankle_rate": "[s]",
    "edge": "[m]",
    "reach_forward": "[m]: two strides",
    "reach_backward": "[m]: likewise",
    "reach_outward": "[m]",
    "gap": "[m]",
    "step_speed": "[m/s]",
    "stride_gain": "joints without play need none; learning strains the legs",
    "stride_bound": "[m]",
    "joint_gain": "[1/s]",
    "joint_leak": "[1/s]",
    "load_share": "what the servos give way under load is asked beforehand",
}
HOW = {
    "method": "",
    "feedback": "",
    "learn_turns": "feet twist on the floor: turns are made whole by the gyro",
}
GAME_WHY = {
    "safety_radius": "[m]: 0.89 of the distance on the circle",
    "start_least": "[m]: nearer, what reaches out would touch",
    "start_near": "[m]: starts are drawn from here",
    "start_far": "[m]: to here",
    "push_unit": "[N s]: 0.12 m sqrt(g z)",
    "force_unit": "errors of forces by NAO's: its weight by NAO's",
    "length_unit": "likewise of lengths: its CoM's height by NAO's",
}


def write_description(derived: DerivedDescription) -> str:
    """Text of a robot.toml."""
    own, found = derived.description, derived.survey
    left, right = found.legs
    legs = ",\n".join(
        "    " + ", ".join(_quoted(name) for name in leg.joints)
        for leg in found.legs
    )
    soles = (
        f"{ASK} a guess from the length of the leg, measure it"
        if left.is_guessed
        else f"lowest points of the geoms of {left.foot} and {right.foot}"
    )
    coupled = ", ".join(sorted(coupled_of(found))) or "none"
    lines = [
        f"# {own.name}, derived from the model by `stepaside robot init`.",
        "# The model itself is left as it is; [overlay] is put on it when it",
        "# is read. Where a comment says ASK, the model does not tell a",
        "# value: what stands there is a sensible start.",
        *_missing(derived),
        f"name = {_quoted(own.name)}",
        _line("model", own.model, "as published"),
        _line("torso", own.torso, "root of the model: the most bodies"),
        f"left_foot = {_quoted(own.left_foot)}",
        f"right_foot = {_quoted(own.right_foot)}",
        'accent = ""                      # no material: the torso is dyed',
        *_lean(derived),
        "",
        "# Chains from the torso to the lowest ends on either side, without",
        f"# the joints that both share; joints that follow others: {coupled}.",
        f"legs = [\n{legs},\n]",
        "",
        "# Knees bent a little, arms hanging, in [rad].",
        *_table("standing", own.standing),
        "# Knees stay bent a little, or a leg can change its branch, [rad].",
        *_table("working_limits", own.working_limits),
        *_speeds(derived),
        "# How it walks: NAO's gait by the height of the CoM and the time of",
        "# its pendulum, with quicker steps. `stepaside robot tune` betters",
        "# it.",
        *_gait(derived),
        f"# Box of a left sole in the foot frame, in [m]: {soles}.",
        *_table("sole", own.sole),
        "# Stiff joints alone carry many robots; `stepaside robot check`",
        "# says whether they do, `robot tune` writes what is better.",
        "[control]",
        *_lines({k: own.control[k] for k in HOW}, HOW),
        "",
        "# By the height of the CoM and the time of its pendulum.",
        *_table("control.stabiliser", own.control["stabiliser"], GAIN_WHY),
        *_table("game", own.game, GAME_WHY),
        "# The point of the torso that stands for the robot, midway between",
        "# the hips, ahead of the torso's origin, and the reach of all of it",
        "# around that point when it stands, in [m].",
        "[place]",
        f"forward = {own.place.forward}",
        f"reach = {own.place.reach}",
        "",
        *_overlay(derived),
    ]
    return "\n".join(lines) + "\n"


def _missing(derived: DerivedDescription) -> list[str]:
    missing = derived.survey.missing
    if not missing:
        return []
    return [
        f"# {len(missing)} mesh files are not there or of a kind that MuJoCo",
        f"# does not read, like {missing[0]}: those geoms are left out.",
    ]


def _lean(derived: DerivedDescription) -> list[str]:
    lean = derived.description.lean
    if lean == 0.0:
        return []
    why = "[rad], of the torso over a foot that stands: relieves the hips"
    return [_line("lean", lean, why)]


def _gait(derived: DerivedDescription) -> list[str]:
    own = derived.description
    why = dict(GAIT_WHY)
    low, high = derived.lowest, derived.highest
    why["com_height"] = (
        f"[m]: {derived.size.com_height / high:.2f} of the greatest of "
        f"{low:.3f} to {high:.3f} in reach"
    )
    if derived.share < 1.0:
        slow = f"; {derived.share:.2f} of that: the joints are no faster"
        for name in ("stride", "step_height"):
            why[name] += slow
    if derived.ahead < 1.0:
        less = f"; {derived.ahead:g} of that: the ankles bear no more"
        why["zmp_forward"] += less
    return _table("gait", own.gait, why)


def _speeds(derived: DerivedDescription) -> list[str]:
    told = derived.told_speeds
    limits = derived.description.speed_limits
    unlimited = [name for name in limits if name not in told]
    why = "as the model tells, in [rad/s]"
    if unlimited:
        of = "" if not told else f" for {', '.join(unlimited)}"
        why = f"{ASK} no-load speeds{of}, in [rad/s]"
    return [*_comment(why), *_table("speed_limits", limits)]


def _overlay(derived: DerivedDescription) -> list[str]:
    own: RobotDescription = derived.description
    untold = [n for n in own.overlay.servos if n not in derived.told_torques]
    why = "Torques as the model tells; stiffness and damping of the legs and "
    why += "the waist are 12 m g z and 0.3 sqrt(z / g) of that"
    if derived.is_weak:
        usual = 100.0 * derived.borne.usual
        usual = 100.0 * derived.borne.usual
        why += f", less where {GIVES} rad would ask for more than the torque, "
        why += f"for a step asks for {usual:.0f} % of one, at times for more"
    why += "; of others by what "
    why += "they carry; an armature is given where the model has hardly any."
    asked = f"{ASK} torques of {', '.join(untold)}." if untold else ""
    soles = [
        f"    {{ body = {_quoted(sole.body)}, place = {_row(sole.place)}, "
        f"turn = {_row(sole.turn)} }},"
        for sole in own.overlay.soles
    ]
    meshes = ", ".join(_quoted(folder) for folder in own.overlay.meshes)
    return [
        "# What is put on the model: a free joint if it has none, an IMU at",
        "# the torso's origin, four touch sensors under either foot, and:",
        "[overlay]",
        f"meshes = [{meshes}]",
        *_turned(own),
        "# Foot frames at the sole, under the last joint of each leg.",
        "soles = [",
        *soles,
        "]",
        "",
        *_comment(why),
        *(_comment(asked) if asked else ()),
        "[overlay.servos]",
        *(
            f"{_key(name)} = {_servo(gains)}"
            for name, gains in own.overlay.servos.items()
        ),
    ]


def _turned(own: RobotDescription) -> list[str]:
    if own.overlay.turn == NO_OVERLAY.turn:
        return []
    why = "The published torso in axes forward, left and up (quaternion): its "
    why += "x axis points elsewhere."
    return [*_comment(why), f"turn = {_row(own.overlay.turn)}"]


def _servo(gains: ServoGains) -> str:
    text = (
        f"{{ stiffness = {gains.stiffness}, damping = {gains.damping}, "
        f"torque = {gains.torque}"
    )
    if gains.armature > 0.0:
        text += f", armature = {gains.armature}"
    return text + " }"


def _table(
    name: str, values: Mapping[str, Any], why: Mapping[str, str] | None = None
) -> list[str]:
    return [f"[{name}]", *_lines(values, why or {}), ""]


def _lines(
    values: Mapping[str, Any], why: Mapping[str, str] | None = None
) -> list[str]:
    return [_line(k, v, (why or {}).get(k, "")) for k, v in values.items()]


def _line(key: str, value: Any, why: str) -> str:
    text = f"{_key(key)} = {_value(value)}"
    return f"{text:<32} # {why}" if why else text


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return _quoted(value)
    if isinstance(value, tuple | list):
        return _row(value)
    return repr(float(value))


def _row(values: Iterable[Any]) -> str:
    return f"[{', '.join(_value(value) for value in values)}]"


def _key(name: str) -> str:
    plain = name.replace("_", "").replace("-", "")
    return name if plain.isascii() and plain.isalnum() else _quoted(name)


def _quoted(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return f'"{escaped}"'


def _comment(text: str) -> list[str]:
    """Text as comments of at most 79 characters."""
    lines, line = [], "#"
    for word in text.split():
        if len(line) + 1 + len(word) > 79:
            lines.append(line)
            line = "#"
        line += f" {word}"
    return [*lines, line]
