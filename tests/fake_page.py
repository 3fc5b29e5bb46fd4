"""A page that is none: it keeps what is put on it and can be pressed."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import SimpleNamespace
from typing import Any


class Handle:
    """One element of a page, or of its scene."""

    def __init__(self, label: str, **values: Any) -> None:
        """Keep what it was made with."""
        self.label = label
        self.callbacks: list[Callable[[Any], Any]] = []
        self.removed = False
        self.visible = True
        self.__dict__.update(values)

    def on_click(self, call: Callable[[Any], Any]) -> Callable[[Any], Any]:
        """Take a callback, as a decorator does."""
        self.callbacks.append(call)
        return call

    on_update = on_trigger = on_click

    def press(self, value: Any = None) -> None:
        """Do what a hand does: perhaps set the value, and press."""
        if value is not None:
            self.value: Any = value
        for call in self.callbacks:
            call(None)

    def remove(self) -> None:
        """Take it off the page."""
        self.removed = True

    def __enter__(self) -> "Handle":
        """Begin to fill a folder."""
        return self

    def __exit__(self, *error: object) -> None:
        """End."""


class Gui:
    """Controls by label."""

    def __init__(self) -> None:
        """Begin empty."""
        self.items: dict[str, Handle] = {}
        self.folders: dict[str, Handle] = {}
        self.texts: list[Handle] = []
        self.plots: list[Handle] = []
        self.themes: list[bool] = []

    def __getitem__(self, label: str) -> Handle:
        """Element with a label."""
        return self.items[label]

    def _add(self, label: str, **values: Any) -> Handle:
        assert label not in self.items, label
        self.items[label] = Handle(label, **values)
        return self.items[label]

    def add_folder(self, label: str, **options: Any) -> Handle:
        """Add a folder, which may have the label of a button in it."""
        self.folders[label] = Handle(label, **options)
        return self.folders[label]

    def add_button(self, label: str, **options: Any) -> Handle:
        """Add a button."""
        return self._add(label, **options)

    def add_button_group(self, label: str, options: Any) -> Handle:
        """Add a row of buttons."""
        return self._add(label, options=options, value=options[0])

    def add_checkbox(self, label: str, value: bool) -> Handle:
        """Add a checkbox."""
        return self._add(label, value=value)

    def add_number(self, label: str, value: float, step: float) -> Handle:
        """Add a number."""
        return self._add(label, value=value, step=step)

    def add_slider(self, label: str, initial_value: float, **o: Any) -> Handle:
        """Add a slider."""
        return self._add(label, value=initial_value, **o)

    def add_dropdown(
        self, label: str, options: Any, initial_value: Any = None
    ) -> Handle:
        """Add a choice."""
        value = options[0] if initial_value is None else initial_value
        return self._add(label, options=tuple(options), value=value)

    def add_command(self, label: str, hotkey: str) -> Handle:
        """Add a command with a key."""
        return self._add(label, hotkey=hotkey)

    def add_markdown(self, content: str, visible: bool = True) -> Handle:
        """Add a text."""
        made = Handle("text", content=content)
        made.visible = visible
        self.texts.append(made)
        return made

    def add_uplot(self, data: Any, series: Any, **options: Any) -> Handle:
        """Add a plot."""
        made = Handle(options["title"], data=data, series=series)
        self.plots.append(made)
        return made

    def add_image(self, image: Any, label: str, format: str) -> Handle:
        """Add a picture."""
        return self._add(label, image=image)

    def configure_theme(
        self, *, dark_mode: bool, show_share_button: bool
    ) -> None:
        """Note whether the page is dark."""
        assert not show_share_button
        self.themes.append(dark_mode)


class Scene:
    """Things in the scene by name."""

    def __init__(self) -> None:
        """Begin empty."""
        self.items: dict[str, Handle] = {}
        self.drawn = 0
        self.up = ""

    def _add(self, name: str, **values: Any) -> Handle:
        self.drawn += 1
        self.items[name] = Handle(name, **values)
        return self.items[name]

    def set_up_direction(self, up: str) -> None:
        """Note which way is up."""
        self.up = up

    def add_grid(self, name: str, **options: Any) -> Handle:
        """Add a grid."""
        return self._add(name, **options)

    def add_frame(self, name: str, **options: Any) -> Handle:
        """Add a frame."""
        return self._add(name, **options)

    def add_mesh_simple(
        self, name: str, corners: Any, faces: Any, **options: Any
    ) -> Handle:
        """Add a mesh."""
        return self._add(name, corners=corners, faces=faces, **options)

    def add_line_segments(
        self, name: str, points: Any, **options: Any
    ) -> Handle:
        """Add lines."""
        return self._add(name, points=points, **options)

    def remove_by_name(self, name: str) -> None:
        """Take something off."""
        del self.items[name]


class Server:
    """A server that serves nobody."""

    def __init__(self, **options: Any) -> None:
        """Begin with an empty page."""
        self.options = options
        self.scene, self.gui = Scene(), Gui()
        self.initial_camera = SimpleNamespace()
        self.stopped = False

    @contextmanager
    def atomic(self) -> Iterator[None]:
        """Do several things at once."""
        yield

    def get_clients(self) -> dict[int, Any]:
        """Nobody looks."""
        return {}

    def stop(self) -> None:
        """Stop."""
        self.stopped = True


def open_fake(host: str, port: int) -> Any:
    """Open a server that serves nobody, behind no door."""
    server = Server(host=host, port=port)
    listener = SimpleNamespace(say=None)
    return SimpleNamespace(server=server, gate=None, listener=listener)
