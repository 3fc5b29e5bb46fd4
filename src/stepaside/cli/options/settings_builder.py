"""Settings from defaults, a file, and the options that were given."""

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
    """Settings with other values at some paths.

    Whole sections come first, then what lies in them; the values of one
    section go in together, so that each may need the others.

    Args:
        settings: That hold for everything else.
        values: By path, like ``physics.friction``.

    Raises:
        StepAsideError: If a section refuses its values.
    """
    sections: dict[tuple[str, ...], dict[str, Any]] = {}
    for path, value in values.items():
        *section, name = path.split(".")
        sections.setdefault(tuple(section), {})[name] = value
    for where in sorted(sections, key=len):
        settings = _put(settings, where, sections[where])
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
    told_method: bool = False,
) -> dict[str, Any]:
    """Values with the method and the feedback that others imply.

    A body other than the ideal one is stabilised unless it is said not to
    be, as is a walk planned from the measured state, or with a gait that
    needs it. Such a gait is planned from the planned state: steps so quick
    have no time for what is measured to come true. Who asks for feedback
    beside a file that names a method gets that, with feedback.

    Args:
        given: Values by path, names of presets not looked up yet.
        control: What holds so far.
        needed: Whether the robot cannot walk without feedback.
        told_method: Whether a file said its method.
    """
    from ...planning import STABILISED

    body, method, feedback = (
        given.get(option.path) for option in (BODY_PRESET, METHOD, FEEDBACK)
    )
    if feedback and method is None and told_method:
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
    """Values with the trigger that others imply.

    Where a person comes and the gait is a fast one, evasion begins by time:
    people come at any speed, and a distance suits only one.

    Args:
        given: Values by path, names of presets not looked up yet.
        pursuer: Who pursues so far.
    """
    from ...planning import STABILISED

    values = dict(given)
    person = values.get("pursuer", pursuer) == "person"
    if person and values.get(PRESET.path) in STABILISED:
        values.setdefault("strategy.trigger", "time")
    return values


def with_senses(
    given: Mapping[str, Any], *, in_room: bool, told: bool
) -> dict[str, Any]:
    """Values with the senses that others imply.

    Who is to know of a room what was seen of it has to see.

    Args:
        given: Values by path.
        in_room: Whether a file said in which room they play.
        told: Whether a file said how they sense.
    """
    values = dict(given)
    if values.get(MAP.path) == "seen" and not told:
        if in_room or values.get(PLAN) is not None:
            values.setdefault(SENSING.path, "cameras")
    return values
