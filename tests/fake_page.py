"""Fake viser page: records its contents; its buttons can be pressed."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import SimpleNamespace
from typing import Any

import numpy as np


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

    on_update = on_trigger = on_drag = on_click

    def press(self, value: Any = None, client: Any = None) -> None:
        """Do what a hand does: perhaps set the value, and press."""
        if value is not None:
            self.value: Any = value
        for call in self.callbacks:
            call(SimpleNamespace(client=client))

    def remove(self) -> None:
        """Take it off the page."""
        self.removed = True

    def __enter__(self) -> "Handle":
        """Begin to fill a folder."""
        return self

    def __exit__(self, *error: object) -> None:
        """End."""


class Panel(Handle):
    """A panel, with its place and its tabs."""

    def __init__(self) -> None:
        """Begin without a place."""
        super().__init__("panel", place="", width=0.0)
        self.minimized = False
        self.tabs: list[Handle] = []

    def dock_left(self) -> None:
        """Lie to the left of the scene."""
        self.place = "left"

    def dock_right(self) -> None:
        """Lie to the right of it."""
        self.place = "right"

    def set_width(self, width: float) -> None:
        """Be so wide."""
        self.width = width

    def float(self, **place: float) -> None:
        """Lie over the scene."""
        self.place, self.width = "over", place["width"]

    def minimize(self) -> None:
        """Show the title only."""
        self.minimized = True

    def add_tab(self, label: str) -> Handle:
        """Add a tab, to be filled."""
        self.tabs.append(Handle(label))
        return self.tabs[-1]


class Gui:
    """Controls by label."""

    def __init__(self) -> None:
        """Begin empty."""
        self.items: dict[str, Handle] = {}
        self.folders: dict[str, Handle] = {}
        self.texts: list[Handle] = []
        self.html: list[Handle] = []
        self.plots: list[Handle] = []
        self.themes: list[bool] = []
        self.main_panel = Panel()
        self.panels: list[Panel] = []

    def __getitem__(self, label: str) -> Handle:
        """Element with a label."""
        return self.items[label]

    def _add(self, label: str, **values: Any) -> Handle:
        assert label not in self.items, label
        self.items[label] = Handle(label, **values)
        return self.items[label]

    def set_panel_label(self, label: str) -> None:
        """Name the page."""
        self.name = label

    def add_panel(self) -> Panel:
        """Add a panel."""
        self.panels.append(Panel())
        return self.panels[-1]

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
        self,
        label: str,
        options: Any,
        initial_value: Any = None,
        visible: bool = True,
        order: float | None = None,
    ) -> Handle:
        """Add a choice."""
        value = options[0] if initial_value is None else initial_value
        values = {"value": value, "visible": visible}
        return self._add(label, options=tuple(options), **values)

    def add_command(self, label: str, hotkey: str) -> Handle:
        """Add a command with a key."""
        return self._add(label, hotkey=hotkey)

    def add_markdown(self, content: str, visible: bool = True) -> Handle:
        """Add a text."""
        made = Handle("text", content=content)
        made.visible = visible
        self.texts.append(made)
        return made

    def add_html(self, content: str) -> Handle:
        """Add a text with tags."""
        self.html.append(Handle("html", content=content))
        return self.html[-1]

    def add_uplot(self, data: Any, series: Any, **options: Any) -> Handle:
        """Add a plot."""
        made = Handle(
            options["title"], data=data, series=series, options=options
        )
        self.plots.append(made)
        return made

    def add_image(self, image: Any, label: str, format: str) -> Handle:
        """Add a picture."""
        return self._add(label, image=image)

    def configure_theme(
        self, *, dark_mode: bool, show_share_button: bool, **options: Any
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

    def configure_default_lights(self, *, cast_shadow: bool) -> None:
        """Note whether there are shadows."""
        self.shadows = cast_shadow

    def add_label(self, name: str, text: str, **options: Any) -> Handle:
        """Add a word."""
        return self._add(name, text=text, **options)

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

    def add_arrows(
        self, name: str, points: Any, colour: Any, **options: Any
    ) -> Handle:
        """Add arrows."""
        return self._add(name, points=points, colour=colour, **options)

    def remove_by_name(self, name: str) -> None:
        """Take something off, and all below it."""
        del self.items[name]
        for below in [n for n in self.items if n.startswith(f"{name}/")]:
            del self.items[below]


class Client:
    """Client of the page."""

    def __init__(self, number: int, aspect: float = 1.8) -> None:
        """Come with a page of one's own."""
        self.client_id = number
        self.gui, self.scene = Gui(), Scene()
        self.camera = SimpleNamespace(
            position=np.zeros(3),
            look_at=np.zeros(3),
            aspect=aspect,
            fov=1.309,
        )
        self.notices: list[Any] = []

    def add_notification(
        self, title: str, body: str, *, auto_close_seconds: float
    ) -> Handle:
        """Show a message that goes away by itself."""
        made = Handle(title, body=body, seconds=auto_close_seconds)
        self.notices.append(made)
        return made

    @contextmanager
    def atomic(self) -> Iterator[None]:
        """Do several things at once."""
        yield


class Server:
    """Server with given clients."""

    def __init__(self, **options: Any) -> None:
        """Begin with an empty page."""
        self.options = options
        self.scene, self.gui = Scene(), Gui()
        self.initial_camera = SimpleNamespace()
        self.stopped = False
        self.clients: dict[int, Any] = {}
        self.coming: list[Callable[[Any], None]] = []
        self.going: list[Callable[[Any], None]] = []

    def on_client_connect(self, call: Callable[[Any], None]) -> None:
        """Be told who comes."""
        self.coming.append(call)

    def on_client_disconnect(self, call: Callable[[Any], None]) -> None:
        """Be told who goes."""
        self.going.append(call)

    def welcome(self, client: Any) -> None:
        """Connect a client."""
        self.clients[client.client_id] = client
        for call in self.coming:
            call(client)

    @contextmanager
    def atomic(self) -> Iterator[None]:
        """Do several things at once."""
        yield

    def get_clients(self) -> dict[int, Any]:
        """Connected clients."""
        return dict(self.clients)

    def stop(self) -> None:
        """Stop."""
        self.stopped = True


def open_fake(port: int) -> Any:
    """Return a fake server."""
    return Server(port=port)
