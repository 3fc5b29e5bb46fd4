"""Panel with all settings of the next game, made from their descriptions."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import is_dataclass, replace
from math import degrees, isfinite, radians
from operator import attrgetter
from typing import Any, NamedTuple

import viser

from ...arena import Room
from ...core.errors import StepAsideError
from ...core.setting import Setting, settings_of
from ...games.duel_settings import EVADER, DuelSettings
from ...games.implied_settings import EVASION
from ...games.walker import RobotPlayer
from .live_session import LiveSession, LiveSettings

OWN_VALUES = "own values"  # of a section that is no preset
UNUSED = {"duration"}  # a live game has no end


class Leaf(NamedTuple):
    """One value of settings.

    Attributes:
        path: Names from the root, with dots; players are counted from 0.
        described: Description of the setting.
        value: The value; None for one that is drawn or implied.
    """

    path: str
    described: Setting
    value: Any

    @property
    def shown(self) -> Any:
        """The value as a control has it; angles in [deg]."""
        if self.value is None or self.value != self.value:
            return ""
        if isinstance(self.value, float) and not isfinite(self.value):
            return str(self.value)
        return round(degrees(self.value), 6) if self.turns else self.value

    @property
    def turns(self) -> bool:
        """Whether the value is in [rad]."""
        return self.described.range is not None and (
            self.described.range.unit == "rad"
        )

    def read(self, shown: Any) -> Any:
        """Return the value of what a control has.

        Raises:
            ValueError: If a text is not a number.
        """
        if shown == self.shown:
            return self.value
        if self.described.range is None:
            return shown
        if isinstance(shown, str):
            shown = float(shown) if shown.strip() else None
        if shown is None or self.described.range.whole:
            return shown if shown is None else int(shown)
        return radians(shown) if self.turns else float(shown)


def leaves_of(
    settings: Any, path: str = "", above: tuple[Any, ...] = ()
) -> Iterator[Leaf]:
    """Yield the values of settings that one control can show.

    Args:
        settings: The settings.
        path: Their path from the root, with a dot at its end.
        above: The settings that they are part of, from the root on.
    """
    if isinstance(settings, tuple):
        for number, each in enumerate(settings):
            yield from leaves_of(each, f"{path}{number}.", above)
        return
    above = (*above, settings)
    for name, described in settings_of(type(settings)).items():
        value, own = getattr(settings, name), f"{path}{name}"
        if own in UNUSED or isinstance(value, Room):
            continue
        if not _has_effect(above, name, described):
            continue
        if is_dataclass(value) or (
            isinstance(value, tuple) and all(map(is_dataclass, value))
        ):
            yield from leaves_of(value, f"{own}.", above)
        elif isinstance(value, bool | int | float | str) or (
            value is None and described.range is not None
        ):
            yield Leaf(own, described, value)


def _has_effect(above: tuple[Any, ...], name: str, described: Setting) -> bool:
    """Return whether the other setting that this one needs has its value."""
    if described.needs is None:
        return True
    path, wanted = described.needs
    if path.partition(".")[0] == name:
        return True  # a part of it decides
    for owner in above[::-1]:
        try:
            value = attrgetter(path)(owner)
        except AttributeError:
            continue
        if wanted == "":
            return value is not None and value is not False
        return value is None or bool(value == wanted)  # None is implied
    return True


def with_values(settings: Any, values: Mapping[str, Any]) -> Any:
    """Return settings with other values, by path.

    Raises:
        StepAsideError: If they are invalid.
    """
    parts: dict[str, dict[str, Any]] = {}
    for path, value in values.items():
        name, _, rest = path.partition(".")
        parts.setdefault(name, {})[rest] = value
    if isinstance(settings, tuple):
        return tuple(
            with_values(each, parts.get(str(number), {}))
            for number, each in enumerate(settings)
        )
    changes = {
        name: own[""]
        if "" in own
        else with_values(getattr(settings, name), own)
        for name, own in parts.items()
    }
    return replace(settings, **changes) if changes else settings


class SettingsPanel:
    """Controls of all settings of the next game.

    Attributes:
        preset: Choice of a game by name.
    """

    def __init__(
        self,
        gui: viser.GuiApi,
        session: LiveSession,
        notify: Callable[[str], None],
        presets: Mapping[str, LiveSettings],
    ) -> None:
        """Add the controls to a page.

        Args:
            gui: Controls of the page.
            session: Session whose settings are changed.
            notify: Function that shows a message.
            presets: Games by name; the first is played.
        """
        self._gui, self._session, self._notify = gui, session, notify
        self._presets = presets
        self._leaves: dict[str, Leaf] = {}
        self.preset = gui.add_dropdown(
            "Preset", tuple(presets), visible=len(presets) > 1
        )
        gui.add_markdown(
            "Settings act at the next reset; those of the paper's evasion, "
            "`strategy`, at the evader's next step. Angles are in [deg]; "
            "empty means drawn or implied."
        )
        self._box = gui.add_folder("Settings")
        with self._box:
            self._inner = gui.add_folder(None)
        self._show(session.settings)

    def _show(self, settings: LiveSettings) -> None:
        """Show the values of settings, with other controls where needed."""
        leaves = {leaf.path: leaf for leaf in leaves_of(settings)}
        known, self._leaves = self._leaves, leaves
        if known.keys() == leaves.keys():
            for path, leaf in leaves.items():
                if self._controls[path].value != leaf.shown:
                    self._controls[path].value = leaf.shown
            return
        self._inner.remove()
        with self._box:
            self._inner = self._gui.add_folder(None)
        self._controls: dict[str, Any] = {}
        folders = {"": self._inner}
        for path, leaf in leaves.items():
            place = path.rpartition(".")[0]
            with self._folder(folders, settings, place):
                self._controls[path] = self._control(leaf)
            if place == "strategy":
                self._controls[path].on_update(lambda _: self._adopt())

    def _folder(
        self, folders: dict[str, Any], settings: Any, path: str
    ) -> Any:
        """Return the folder of a section, after adding it if needed."""
        if path not in folders:
            above, _, name = path.rpartition(".")
            parent = settings
            for part in filter(None, above.split(".")):
                parent = _part(parent, part)
            own = _part(parent, name)
            with self._folder(folders, settings, above):
                folders[path] = self._gui.add_folder(
                    getattr(own, "name", name), expand_by_default=False
                )
            players = isinstance(parent, tuple)
            described = {} if players else settings_of(type(parent))
            presets = described[name].presets if name in described else None
            if presets:
                with folders[path]:
                    self._add_presets(path, presets, own)
        return folders[path]

    def _add_presets(
        self, path: str, presets: Mapping[str, Any], own: Any
    ) -> None:
        """Add a choice that fills in the values of a section."""
        chosen = [name for name, each in presets.items() if each == own]
        choice = self._gui.add_dropdown(
            f"{path} preset",
            (OWN_VALUES, *presets),
            initial_value=(chosen or [OWN_VALUES])[0],
        )

        @choice.on_update
        def _(_: object) -> None:
            if choice.value in presets:
                for leaf in leaves_of(presets[choice.value], f"{path}."):
                    if leaf.path in self._controls:
                        self._controls[leaf.path].value = leaf.shown

    def _control(self, leaf: Leaf) -> Any:
        """Add the control of a value; return its handle."""
        gui, value = self._gui, leaf.shown
        name = leaf.path.rpartition(".")[2].replace("_", " ")
        hint = f"{leaf.path}: {leaf.described.text}"
        unit = leaf.described.range and leaf.described.range.unit
        if unit and unit not in ("1", ""):
            name += f" [{'deg' if leaf.turns else unit}]"
        if isinstance(value, bool):
            return gui.add_checkbox(name, value, hint=hint)
        if value in leaf.described.names:
            names = leaf.described.names
            return gui.add_dropdown(
                name, names, initial_value=value, hint=hint
            )
        if isinstance(value, str):
            return gui.add_text(name, value, hint=hint)
        return gui.add_number(name, value, hint=hint)

    def values(self) -> LiveSettings:
        """Return the settings of the controls.

        Raises:
            StepAsideError: If they are invalid.
            ValueError: If a text is not a number.
        """
        changed = {}
        for path, leaf in self._leaves.items():
            value = leaf.read(self._controls[path].value)
            if value != leaf.value and not (value != value):
                changed[path] = value
        settings: LiveSettings = with_values(self._session.settings, changed)
        return settings

    def restart(self) -> bool:
        """Start a game with the settings of the controls.

        Returns:
            Whether the settings were valid.
        """
        return self._attempt(lambda: self._session.reset(self.values()))

    def play_preset(self) -> bool:
        """Start the chosen preset; return whether it is valid."""
        settings = self._presets[self.preset.value]
        return self._attempt(lambda: self._session.reset(settings))

    def _attempt(self, change: Callable[[], None]) -> bool:
        """Change the game, and show its settings or what is wrong."""
        try:
            change()
        except (StepAsideError, ArithmeticError, ValueError) as error:
            self._notify(str(error))
            return False
        self._notify("")
        self._show(self._session.settings)
        return True

    def _adopt(self) -> None:
        """Change the evader's strategy from its next plan on."""
        session = self._session
        try:
            settings = self.values()
        except (StepAsideError, ArithmeticError, ValueError) as error:
            self._notify(str(error))
            return
        if not isinstance(settings, DuelSettings) or not isinstance(
            session.settings, DuelSettings
        ):
            return
        strategy = settings.strategy
        if strategy == session.settings.strategy:
            return
        played = session.settings.resolved_evader
        if played != EVASION:
            self._notify(f"these are settings of evasion, not of {played}")
            return

        def change() -> None:
            evader = session.world.player(EVADER)
            if isinstance(evader, RobotPlayer):
                evader.scheme.decisions.adopt(strategy)
            now = session.settings
            assert isinstance(now, DuelSettings)
            session.adopt_settings(replace(now, strategy=strategy))

        session.call(change)
        self._notify("")
        for leaf in leaves_of(strategy, "strategy."):
            self._leaves[leaf.path] = leaf


def _part(settings: Any, name: str) -> Any:
    """Return a field, or an entry of an array by its number."""
    if isinstance(settings, tuple):
        return settings[int(name)]
    return getattr(settings, name)
