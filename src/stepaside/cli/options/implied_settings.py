"""Settings that the options of a command imply."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import click

from ...arena import RoomRecipe, generate_room, load_room
from ...locomotion.zmp.control_settings import ControlSettings
from ...planning import STABILISED

RECIPE = "recipe"  # section of the options that generate a room


def with_control(
    given: Mapping[str, Any],
    control: ControlSettings,
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
    body, method = given.get("body"), given.get("control.method")
    feedback = given.get("control.feedback")
    if feedback and method is None and method_in_file:
        method = control.method
    if given.get("gait") in STABILISED and feedback is not False:
        method = method or "closed-form"
        return {**given, "control.method": method, "control.feedback": True}
    if feedback is None and (method or body) is not None:
        feedback = body not in (None, "ideal") or (
            method not in (None, "closed-form")
        )
        feedback = feedback or needed or (body is None and control.feedback)
    if feedback is None:
        return dict(given)
    if method is None:
        method = "measured" if feedback else "closed-form"
    return {**given, "control.method": method, "control.feedback": feedback}


def with_trigger(given: Mapping[str, Any], pursuer: str) -> dict[str, Any]:
    """Add the trigger that other values imply.

    Against a person, a robot with a fast gait evades by time to contact:
    people walk at any speed, and a trigger distance suits only one speed.

    Args:
        given: Values by path; presets are still names.
        pursuer: Kind of pursuer so far.
    """
    values = dict(given)
    person = values.get("pursuer", pursuer) == "person"
    if person and values.get("gait") in STABILISED:
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
    if values.get("map.source") == "seen" and not sensing_in_file:
        if room_in_file or values.get("room.plan") is not None:
            values.setdefault("sensing", "cameras")
    return values


def with_room(given: Mapping[str, Any]) -> dict[str, Any]:
    """Replace the options that describe a room by the room itself.

    Args:
        given: Values by path.

    Raises:
        UsageError: If options generate a room but no seed is given.
        ConfigurationError: If the room cannot be generated or loaded.
    """
    recipe = {
        path.removeprefix(f"{RECIPE}."): value
        for path, value in given.items()
        if path.startswith(f"{RECIPE}.")
    }
    values = {
        path: value
        for path, value in given.items()
        if not path.startswith(f"{RECIPE}.")
    }
    source = values.get("room.plan")
    if recipe and not isinstance(source, int):
        name = next(iter(recipe)).replace("_", "-")
        option = "--room-size" if name == "size" else f"--{name}"
        room = "no --room" if source is None else f"the file {source}"
        raise click.UsageError(
            f"{option} requires a random room (--room SEED), got {room}"
        )
    if isinstance(source, int):
        size = recipe.pop("size", (3.0, 3.0)) or (None, None)
        made = RoomRecipe(width=size[0], depth=size[1], **recipe)
        values["room.plan"] = generate_room(made, source)
    elif isinstance(source, Path):
        values["room.plan"] = load_room(source)
    return values
