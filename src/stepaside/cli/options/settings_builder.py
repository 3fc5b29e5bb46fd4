"""Settings with the values of options, and the values that options imply."""

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any, TypeVar

from .body_options import BODY_PRESET, FEEDBACK, METHOD
from .gait_options import PRESET
from .game_options import SENSING
from .room_options import MAP, PLAN

if TYPE_CHECKING:
    from ...locomotion.zmp.control_settings import ControlSettings

S = TypeVar("S")


def changed(settings: S, values: Mapping[str, Any]) -> S:
    """Return settings with new values at some paths.

    Outer sections are replaced before inner ones, and all values of one
    section at once, because their validity may depend on each other.

    Args:
        settings: Settings to start from.
        values: New values by path, like ``physics.friction``.

    Raises:
        StepAsideError: If a value is invalid.
    """
    sections: dict[tuple[str, ...], dict[str, Any]] = {}
    for path, value in values.items():
        *section, name = path.split(".")
        sections.setdefault(tuple(section), {})[name] = value
    for section_path in sorted(sections, key=len):
        settings = _put(settings, section_path, sections[section_path])
    return settings


def _put(settings: Any, section: tuple[str, ...], values: Any) -> Any:
    if not section:
        return replace(settings, **values)
    name, *deeper = section
    inner = _put(getattr(settings, name), tuple(deeper), values)
    return replace(settings, **{name: inner})


def with_control(
    given: Mapping[str, Any],
    control: "ControlSettings",
    *,
    needed: bool = False,
    method_in_file: bool = False,
) -> dict[str, Any]:
    """Add the method and the feedback that other values imply.

    Feedback is the default for every body but the ideal one, for plans from
    the measured state, and for gaits that need it. Plans of such a fast gait
    start from the planned state, because its steps are too short for the
    measured state to settle. ``--feedback`` keeps the method of a file.

    Args:
        given: Values by path; presets are still names.
        control: Control settings so far.
        needed: Whether the robot cannot walk without feedback.
        method_in_file: Whether the configuration file sets the method.
    """
    from ...planning import STABILISED

    body, method, feedback = (
        given.get(option.path) for option in (BODY_PRESET, METHOD, FEEDBACK)
    )
    if feedback and method is None and method_in_file:
        method = control.method
    if given.get(PRESET.path) in STABILISED and feedback is not False:
        method = method or "closed-form"
        return {**given, METHOD.path: method, FEEDBACK.path: True}
    if feedback is None and (method or body) is not None:
        feedback = body not in (None, "ideal") or (
            method not in (None, "closed-form")
        )
        feedback = feedback or needed or (body is None and control.feedback)
    if feedback is None:
        return dict(given)
    if method is None:
        method = "measured" if feedback else "closed-form"
    return {**given, METHOD.path: method, FEEDBACK.path: feedback}


def with_trigger(given: Mapping[str, Any], pursuer: str) -> dict[str, Any]:
    """Add the trigger that other values imply.

    Against a person, a robot with a fast gait evades by time to contact:
    people walk at any speed, and a trigger distance suits only one speed.

    Args:
        given: Values by path; presets are still names.
        pursuer: Kind of pursuer so far.
    """
    from ...planning import STABILISED

    values = dict(given)
    person = values.get("pursuer", pursuer) == "person"
    if person and values.get(PRESET.path) in STABILISED:
        values.setdefault("strategy.trigger", "time")
    return values


def with_sensing(
    given: Mapping[str, Any], *, room_in_file: bool, sensing_in_file: bool
) -> dict[str, Any]:
    """Add camera sensing if a map is to be built from camera images.

    Args:
        given: Values by path.
        room_in_file: Whether the configuration file sets a room.
        sensing_in_file: Whether the configuration file sets the sensing.
    """
    values = dict(given)
    if values.get(MAP.path) == "seen" and not sensing_in_file:
        if room_in_file or values.get(PLAN) is not None:
            values.setdefault(SENSING.path, "cameras")
    return values
