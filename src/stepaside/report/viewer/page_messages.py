"""Filter of the messages that pages send to the server."""

from collections.abc import Callable, Mapping
from math import isfinite
from typing import Any

import msgspec
import viser

MAX_SIZE = 65_536  # of a message, in [bytes]; typical ones have some hundred
MAX_VALUE = 1e9  # of a number in a message
# Fields of the messages and their lengths; 0 is a number, not a list.
CAMERA = {
    "fov": 0,
    "near": 0,
    "far": 0,
    "image_height": 0,
    "image_width": 0,
    "wxyz": 4,
    "position": 3,
    "look_at": 3,
    "up_direction": 3,
}
DRAG = {
    "start_position": 3,
    "start_screen_pos": 2,
    "end_position": 3,
    "end_screen_pos": 2,
}
PHASES = "start", "update", "end"
SWITCHES = viser.GuiButtonHandle, viser.GuiCheckboxHandle
CHOICES = viser.GuiDropdownHandle, viser.GuiButtonGroupHandle
NUMBERS = viser.GuiNumberHandle, viser.GuiSliderHandle


class MessageFilter:
    """Accepts only messages that the controls of a page can produce.

    viser sets any attribute that a message names to any value; this filter
    runs before it and accepts only values that a control can take.
    """

    def __init__(self) -> None:
        """Start without controls."""
        self._controls: Mapping[str, Any] = {}
        self._nodes: Mapping[str, Any] = {}
        self._notify: Callable[[str], None] = lambda text: None

    def watch(
        self,
        gui: viser.GuiApi,
        scene: viser.SceneApi,
        notify: Callable[[str], None],
    ) -> None:
        """Accept messages of a page's controls and scene.

        Args:
            gui: Controls; controls that are added later count, too.
            scene: Scene; nodes that are added later count, too.
            notify: Called with the reason for a refusal.
        """
        self._notify = notify
        self._controls = gui._gui_input_handle_from_uuid
        self._nodes = scene._handle_from_node_name

    def accepts(self, raw: str | bytes) -> bool:
        """Return whether a message is accepted; text never is."""
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
        """Return whether a message drags a known node by finite numbers."""
        keys = "phase", "name", "instance_index", "button", "modifier"
        if not _has(message, *keys, "owner", *DRAG):
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
        if set(updates) == {"value"} and accepts_value(
            control, updates["value"]
        ):
            return True
        label = getattr(control, "label", "a control")
        self._notify(f"invalid value for {label}")
        return False


def accepts_value(control: Any, value: Any) -> bool:
    """Return whether a control can take a value.

    Args:
        control: Control of a page.
        value: New value.
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
        and abs(value) <= MAX_VALUE
    )


def _has(message: Mapping[Any, Any], *names: str) -> bool:
    return set(message) == set(names)


def _is_camera(message: Mapping[Any, Any]) -> bool:
    if not _has(message, *CAMERA):
        return False
    return _are_numbers(message, CAMERA)


def _are_numbers(message: Mapping[Any, Any], counts: dict[str, int]) -> bool:
    """Return whether fields are finite numbers, or lists of given lengths."""
    for name, count in counts.items():
        value = message[name]
        values = value if count else [value]
        if not isinstance(values, list) or len(values) != (count or 1):
            return False
        if not all(_is_number(each) for each in values):
            return False
    return True
