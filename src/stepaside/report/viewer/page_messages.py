"""What a page may say: messages that mean something here."""

from collections.abc import Callable, Mapping
from math import isfinite
from typing import Any

import msgspec
import viser

LARGEST = 65_536  # of a message, in [bytes]; a page's own have some hundred
GREATEST = 1e9  # of a number in a message
CAMERA = {  # numbers of each entry
    **dict.fromkeys(("fov", "near", "far", "image_height", "image_width"), 0),
    **{"wxyz": 4, "position": 3, "look_at": 3, "up_direction": 3},
}
DRAG = {  # likewise, of a pull at a part of a robot
    **{"start_position": 3, "start_screen_pos": 2},
    **{"end_position": 3, "end_screen_pos": 2},
}
PHASES = "start", "update", "end"
SWITCHES = viser.GuiButtonHandle, viser.GuiCheckboxHandle
CHOICES = viser.GuiDropdownHandle, viser.GuiButtonGroupHandle
NUMBERS = viser.GuiNumberHandle, viser.GuiSliderHandle


class MessageFilter:
    """Hears what is a control's own value, and nothing else.

    viser takes whatever a page sends for whatever attribute it names; this
    stands before it. What a control may be told is what its page could show.

    Attributes:
        say: Told what was refused, in words.
    """

    def __init__(self) -> None:
        """Begin without controls."""
        self._controls: Mapping[str, Any] = {}
        self._nodes: Mapping[str, Any] = {}
        self.say: Callable[[str], None] = lambda text: None

    def attend(self, gui: viser.GuiApi, scene: viser.SceneApi) -> None:
        """Know a page's controls and its scene, also what comes later."""
        self._controls = gui._gui_input_handle_from_uuid
        self._nodes = scene._handle_from_node_name

    def hears(self, raw: str | bytes) -> bool:
        """Whether a message may be heard; text never."""
        if isinstance(raw, str):
            return False
        try:
            message = msgspec.msgpack.decode(raw)
        except (msgspec.DecodeError, RecursionError, TypeError, ValueError):
            return False
        if not isinstance(message, dict):
            return False
        kind, rest = message.pop("type", None), message
        if kind == "ViewerCameraMessage":
            return _is_camera(rest)
        if kind == "CommandTriggerMessage":
            return _has(rest, "uuid") and isinstance(rest["uuid"], str)
        if kind == "GuiUpdateMessage" and _has(rest, "uuid", "updates"):
            return self._is_update(rest["uuid"], rest["updates"])
        if kind == "SceneNodeDragMessage":
            return self._is_drag(rest)
        return False

    def _is_drag(self, message: Mapping[Any, Any]) -> bool:
        """Whether something that can be pulled is, by plain numbers."""
        words = "phase", "name", "instance_index", "button", "modifier"
        if not _has(message, *words, "owner", *DRAG):
            return False
        name, owner = message["name"], message["owner"]
        return (
            isinstance(name, str)
            and name in self._nodes
            and isinstance(owner, str)
            and message["phase"] in PHASES
            and message["instance_index"] is None
            and message["button"] == "left"
            and message["modifier"] is None
            and _are_numbers(message, DRAG)
        )

    def _is_update(self, uuid: Any, updates: Any) -> bool:
        control = self._controls.get(uuid) if isinstance(uuid, str) else None
        if control is None or not isinstance(updates, dict):
            return False
        if set(updates) == {"value"} and may_be(control, updates["value"]):
            return True
        label = getattr(control, "label", "a control")
        self.say(f"{label} cannot be set to that")
        return False


def may_be(control: Any, value: Any) -> bool:
    """Whether a control can have a value.

    Args:
        control: Of a page.
        value: What it would be.
    """
    if isinstance(control, SWITCHES):
        return isinstance(value, bool)
    if isinstance(control, CHOICES):
        return isinstance(value, str) and value in control.options
    if not isinstance(control, NUMBERS):
        return False
    if not _is_number(value) or (
        isinstance(control.value, int) and not float(value).is_integer()
    ):
        return False
    low, high = control.min, control.max
    return (low is None or value >= low) and (high is None or value <= high)


def _is_number(value: Any) -> bool:
    return (
        isinstance(value, int | float)
        and not isinstance(value, bool)
        and isfinite(value)
        and abs(value) <= GREATEST
    )


def _has(message: Mapping[Any, Any], *names: str) -> bool:
    return set(message) == set(names)


def _is_camera(message: Mapping[Any, Any]) -> bool:
    if not _has(message, *CAMERA):
        return False
    return _are_numbers(message, CAMERA)


def _are_numbers(message: Mapping[Any, Any], counts: dict[str, int]) -> bool:
    """Whether entries are numbers, or so many of them in a list."""
    for name, count in counts.items():
        value = message[name]
        values = value if count else [value]
        if not isinstance(values, list) or len(values) != (count or 1):
            return False
        if not all(_is_number(each) for each in values):
            return False
    return True
