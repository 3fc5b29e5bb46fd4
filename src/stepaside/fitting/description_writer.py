"""Writer of ``robot.toml``: every value with a comment on its origin."""

from collections.abc import Iterable, Mapping
from typing import Any

from ..robots.description import RobotDescription
from ..robots.description_types import NO_OVERLAY, ServoGains
from .derivation import DerivedDescription, coupled_of
from .motor_data import SATURATION_ANGLE

ASK = "ASK: not in the model;"
GAIT_COMMENTS = {
    "speed": "[m/s], of the path: a stride in 2.42 sqrt(z / g), as for NAO",
    "gain": "[1/s]: 0.033 sqrt(g / z), as for NAO",
    "stride": "[m]: 0.15 of the CoM height",
    "foot_spacing": "[m]: between the ankles in the zero posture, limited "
    "by hips, CoM height and soles",
    "step_height": "[m]: 0.075 of the CoM height",
    "single_support": "[s]: 2.0 sqrt(z / g)",
    "double_support": "[s]: 0.58 sqrt(z / g)",
    "start_support": "[s]: 4.8 sqrt(z / g)",
    "zmp_forward": "[m]: 0.9 of the distance to the middle of the sole",
}
STABILISER_COMMENTS = {
    "dead_zone": "[m]",
    "yielding": "[1/s]",
    "ankle_rate": "[s]",
    "edge": "[m]",
    "reach_forward": "[m]: two strides",
    "reach_backward": "[m]: two strides",
    "reach_outward": "[m]",
    "gap": "[m]",
    "step_speed": "[m/s]",
    "stride_gain": "not needed without backlash; learning strains the legs",
    "stride_bound": "[m]",
    "joint_gain": "[1/s]",
    "joint_leak": "[1/s]",
    "load_share": "full feedforward of servo deflection under load",
}
CONTROL_COMMENTS = {
    "method": "",
    "feedback": "",
    "learn_turns": "feet slip in yaw: correct turns by the gyro",
}
GAME_COMMENTS = {
    "safety_radius": "[m]: 0.89 of the distance on the circle",
    "start_least": "[m]: nearer, outstretched arms could touch",
    "start_near": "[m]: least random initial distance",
    "start_far": "[m]: greatest random initial distance",
    "push_unit": "[N s]: 0.12 m sqrt(g z)",
    "force_unit": "scale of force errors: weight relative to NAO",
    "length_unit": "scale of length errors: CoM height relative to NAO",
}


def write_description(derived: DerivedDescription) -> str:
    """Return the text of a ``robot.toml``."""
    return (
        "\n".join(
            [
                *_identity(derived),
                *_posture(derived),
                *_speeds(derived),
                "# NAO's gait, scaled by CoM height z and time constant",
                "# sqrt(z / g) of the pendulum, with quicker steps;",
                "# `stepaside robot tune` improves it.",
                *_gait(derived),
                *_sole(derived),
                *_control(derived),
                *_body(derived),
                *_overlay(derived),
                *_published(derived),
            ]
        )
        + "\n"
    )


def _identity(derived: DerivedDescription) -> list[str]:
    own, analysis = derived.description, derived.analysis
    legs = ",\n".join(
        "    " + ", ".join(_quoted(name) for name in leg.joints)
        for leg in analysis.legs
    )
    coupled = ", ".join(sorted(coupled_of(analysis))) or "none"
    return [
        f"# {own.name}, derived from the model by `stepaside robot init`.",
        "# The model file is not changed; [overlay] is added whenever it is",
        "# read. A comment with ASK marks a value that is not in the model:",
        "# an estimate, to be replaced by a measured value.",
        *_missing_meshes(derived),
        f"name = {_quoted(own.name)}",
        _line("model", own.model, "as published"),
        _line("torso", own.torso, "root body with the most descendants"),
        f"left_foot = {_quoted(own.left_foot)}",
        f"right_foot = {_quoted(own.right_foot)}",
        'accent = ""                      # no material: colour the torso',
        *_lean(derived),
        "",
        "# Joint chains from the torso to the lowest end on either side,",
        "# without joints that both share.",
        *_comment(f"Joints that follow others: {coupled}."),
        f"legs = [\n{legs},\n]",
        "",
    ]


def _posture(derived: DerivedDescription) -> list[str]:
    own = derived.description
    return [
        "# Standing posture in [rad]: knees slightly bent, arms hanging.",
        *_table("standing", own.standing),
        "# Knees stay slightly bent, in [rad]: inverse kinematics of a leg",
        "# has two branches, which meet where the knee is straight.",
        *_table("working_limits", own.working_limits),
    ]


def _sole(derived: DerivedDescription) -> list[str]:
    left, right = derived.analysis.legs
    source = (
        f"{ASK} a guess from the length of the leg, measure it"
        if left.is_guessed
        else f"lowest points of the geoms of {left.foot} and {right.foot}"
    )
    return [
        f"# Outline of a left sole in the foot frame, in [m]: {source}.",
        *_table("sole", derived.description.sole),
    ]


def _control(derived: DerivedDescription) -> list[str]:
    own = derived.description
    return [
        "# Many robots walk open loop; `stepaside robot check` tests it,",
        "# `stepaside robot tune` writes better values.",
        "[control]",
        *_lines(
            {k: own.control[k] for k in CONTROL_COMMENTS}, CONTROL_COMMENTS
        ),
        "",
        "# Scaled by CoM height and time constant of the pendulum.",
        *_table(
            "control.stabiliser",
            own.control["stabiliser"],
            STABILISER_COMMENTS,
        ),
        *_table("game", own.game, GAME_COMMENTS),
        "# Reference point midway between the hips (forward of the torso",
        "# origin), and radius around it that contains the standing robot,",
        "# in [m].",
        "[place]",
        f"forward = {own.place.forward}",
        f"reach = {own.place.reach}",
        "",
    ]


def _body(derived: DerivedDescription) -> list[str]:
    body = derived.description.body
    if not body:
        return []
    comment = (
        "Values of the hardware body in place of NAO's: torque limits of the "
        "model are those at the joint, which applies the gains it is sent."
    )
    return [*_comment(comment), *_table("body", body)]


def _published(derived: DerivedDescription) -> list[str]:
    """Return gains and posture of the model, of use to walking policies."""
    published = derived.description.published
    if not published:
        return []
    comment = (
        "Gains [N m/rad, N m s/rad] and posture [rad] of the model, for "
        "walking policies that do not bring their own."
    )
    tables = (
        line
        for name, values in published.items()
        for line in _table(f"published.{name}", values)
    )
    return [*_comment(comment), *tables]


def _missing_meshes(derived: DerivedDescription) -> list[str]:
    missing = derived.analysis.missing
    if not missing:
        return []
    return _comment(
        f"{len(missing)} mesh files are missing or in a format that MuJoCo "
        f"does not read, like {missing[0]}: their geoms are removed."
    )


def _lean(derived: DerivedDescription) -> list[str]:
    lean = derived.description.lean
    if lean == 0.0:
        return []
    comment = "[rad], roll of the torso over the stance foot: relieves hips"
    return [_line("lean", lean, comment)]


def _gait(derived: DerivedDescription) -> list[str]:
    own = derived.description
    comments = dict(GAIT_COMMENTS)
    low, high = derived.lowest, derived.highest
    comments["com_height"] = (
        f"[m]: {derived.size.com_height / high:.2f} of the greatest in reach "
        f"({low:.3f} to {high:.3f})"
    )
    if derived.lengths < 1.0:
        for name in ("stride", "step_height"):
            comments[name] += (
                f", times {derived.lengths:.2f} for the speed limits"
            )
    if derived.zmp_offset < 1.0:
        comments["zmp_forward"] += (
            f", times {derived.zmp_offset:g} for the ankle torques"
        )
    return _table("gait", own.gait, comments)


def _speeds(derived: DerivedDescription) -> list[str]:
    published = derived.published_speeds
    limits = derived.description.speed_limits
    assumed = [name for name in limits if name not in published]
    comment = "Speed limits of the model, in [rad/s]."
    if assumed:
        joints = "" if not published else f" of {', '.join(assumed)}"
        comment = f"{ASK} no-load speeds{joints}, in [rad/s]."
    return [*_comment(comment), *_table("speed_limits", limits)]


def _overlay(derived: DerivedDescription) -> list[str]:
    own: RobotDescription = derived.description
    assumed = [
        name
        for name in own.overlay.servos
        if name not in derived.published_torques
    ]
    comment = (
        "Torque limits of the model. Stiffness of legs and waist: 12 m g z"
    )
    if derived.is_weak:
        usual = 100.0 * derived.loads.usual
        comment += (
            f", but no more than the torque limit over {SATURATION_ANGLE} "
            f"rad, since a step takes {usual:.0f} % of a torque limit most "
            "of the time"
        )
    comment += (
        "; damping: 0.3 sqrt(z / g) times stiffness. Other joints by the "
        "load that they carry. An armature is set if that of the model is "
        "negligible."
    )
    request = f"{ASK} torque limits of {', '.join(assumed)}."
    soles = [
        f"    {{ body = {_quoted(sole.body)}, place = {_row(sole.place)}, "
        f"turn = {_row(sole.turn)} }},"
        for sole in own.overlay.soles
    ]
    meshes = ", ".join(_quoted(folder) for folder in own.overlay.meshes)
    return [
        "# Added to the model: a free joint if it has none, an IMU at the",
        "# torso origin, four touch sensors under each foot, and:",
        "[overlay]",
        f"meshes = [{meshes}]",
        *_torso_orientation(own),
        "# Foot frames at the sole, under the last joint of each leg.",
        "soles = [",
        *soles,
        "]",
        "",
        *_comment(comment),
        *(_comment(request) if assumed else ()),
        "[overlay.servos]",
        *(
            f"{_key(name)} = {_servo(gains)}"
            for name, gains in own.overlay.servos.items()
        ),
    ]


def _torso_orientation(own: RobotDescription) -> list[str]:
    if own.overlay.turn == NO_OVERLAY.turn:
        return []
    comment = (
        "Orientation of the published torso in axes forward, left, up, as a "
        "quaternion: its x axis does not point forward."
    )
    return [*_comment(comment), f"turn = {_row(own.overlay.turn)}"]


def _servo(gains: ServoGains) -> str:
    text = (
        f"{{ stiffness = {gains.stiffness}, damping = {gains.damping}, "
        f"torque = {gains.torque}"
    )
    if gains.armature > 0.0:
        text += f", armature = {gains.armature}"
    return text + " }"


def _table(
    name: str,
    values: Mapping[str, Any],
    comments: Mapping[str, str] | None = None,
) -> list[str]:
    return [f"[{name}]", *_lines(values, comments or {}), ""]


def _lines(
    values: Mapping[str, Any], comments: Mapping[str, str]
) -> list[str]:
    return [_line(k, v, comments.get(k, "")) for k, v in values.items()]


def _line(key: str, value: Any, comment: str) -> str:
    text = f"{_key(key)} = {_value(value)}"
    return f"{text:<32} # {comment}" if comment else text


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
    """Wrap a text into comment lines of at most 79 characters."""
    lines, line = [], "#"
    for word in text.split():
        if len(line) + 1 + len(word) > 79:
            lines.append(line)
            line = "#"
        line += f" {word}"
    return [*lines, line]
