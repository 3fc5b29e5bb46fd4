"""Panel with all settings of the next game, made from their descriptions."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import is_dataclass, replace
from importlib.util import find_spec
from math import degrees, isfinite, radians
from operator import attrgetter
from typing import Any, NamedTuple

import viser

from ...arena import Room, RoomRecipe, generate_room
from ...core.errors import StepAsideError
from ...core.setting import Setting, descriptions_of
from ...games.game_settings import GameSettings, StartSettings, duel
from ...games.player_settings import EVADER, EVASION
from ...games.players import RobotPlayer
from ...planning import PRESETS as GAITS
from ...sim.person_settings import PersonSettings
from .live_session import LiveSession

UNUSED = {"duration", "game"}  # a live game has no end
AS_STARTED = "as started"
ROOM_SEED = 3  # of the room that is offered
PERSON_DISTANCE, PERSON_SPEED = 2.5, 0.3  # in [m], [m/s]


def presets_of(started: GameSettings) -> dict[str, GameSettings]:
    """Return the games that a page offers; that of its start comes first.

    Cameras are among them if the library that reads images is installed.
    """
    if started.game != "duel":
        return {AS_STARTED: started}
    seed = started.seed
    room = generate_room(RoomRecipe(discs=3), ROOM_SEED)
    found: dict[str, GameSettings] = {
        AS_STARTED: started,
        "duel": duel(seed=seed),
        "room": duel(seed=seed, room=room, evader={"strategy": "look-ahead"}),
        "person": duel(
            seed=seed,
            pursuer={"body": "person"},
            person=PersonSettings(speed=PERSON_SPEED),
            start=StartSettings(PERSON_DISTANCE),
            gait=GAITS["fast"],
        ),
    }
    if find_spec("cv2") is not None:
        found["cameras"] = duel(seed=seed, senses="cameras")
    return found


class Leaf(NamedTuple):
    """One value of settings."""

    path: str  # names from the root, with dots; players are counted from 0
    described: Setting
    value: Any  # None for one that is drawn or implied

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
        if shown in (self.shown, str(self.shown)):
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

    Their path from the root has a dot at its end; ``above`` are the settings
    that they are part of, from the root on.
    """
    if isinstance(settings, tuple):
        for number, each in enumerate(settings):
            yield from leaves_of(each, f"{path}{number}.", above)
        return
    above = (*above, settings)
    for name, described in descriptions_of(type(settings)).items():
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
        return value in (None, "") or bool(value == wanted)  # implied
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
    ) -> None:
        """Add the controls to a page; ``notify`` shows a message."""
        self._gui, self._session, self._notify = gui, session, notify
        self._presets = presets_of(session.settings)
        self._leaves: dict[str, Leaf] = {}
        self._controls: dict[str, Any] = {}
        self._folders: list[Any] = []
        self.preset = gui.add_dropdown(
            "Preset",
            tuple(self._presets),
            visible=len(self._presets) > 1,
        )
        gui.add_markdown(
            "Settings act at the next reset; those of the paper's evasion at "
            "the evader's next step. Angles are in [deg]; "
            "empty means drawn or implied."
        )
        self._box = gui.add_folder("Settings")
        self._show(session.settings)

    def _show(self, settings: GameSettings) -> None:
        """Show the values of settings, with other controls where needed."""
        leaves = {leaf.path: leaf for leaf in leaves_of(settings)}
        known, self._leaves = self._leaves, leaves
        if known.keys() == leaves.keys():
            for path, leaf in leaves.items():
                if self._controls[path].value != leaf.shown:
                    self._controls[path].value = leaf.shown
            return
        while self._folders:
            self._folders.pop().remove()
        sections: dict[str, list[Leaf]] = {}
        for leaf in leaves.values():
            sections.setdefault(leaf.path.rpartition(".")[0], []).append(leaf)
        for section, inside in sections.items():
            with self._box:
                folder = self._gui.add_folder(
                    section or "game", expand_by_default=not section
                )
            self._folders.append(folder)
            with folder:
                for leaf in inside:
                    self._controls[leaf.path] = self._control(leaf)

    def _control(self, leaf: Leaf) -> Any:
        """Add the control of a value; return its handle."""
        gui, value, names = self._gui, leaf.shown, leaf.described.names
        name = leaf.path.rpartition(".")[2].replace("_", " ")
        hint = f"{leaf.path}: {leaf.described.text}"
        unit = leaf.described.range and leaf.described.range.unit
        if unit and unit not in ("1", ""):
            name += f" [{'deg' if leaf.turns else unit}]"
        made: Any
        if isinstance(value, bool):
            made = gui.add_checkbox(name, value, hint=hint)
        elif value in names:
            made = gui.add_dropdown(
                name, names, initial_value=value, hint=hint
            )
        elif isinstance(value, str):
            made = gui.add_text(name, value, hint=hint)
        else:
            made = gui.add_number(name, value, hint=hint)
        if ".evasion." in leaf.path:
            made.on_update(lambda _: self._attempt(self._adopt))
        return made

    def values(self) -> GameSettings:
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
        settings: GameSettings = with_values(self._session.settings, changed)
        return settings

    def restart(self) -> bool:
        """Start a game with the settings of the controls, if they are valid.

        Returns:
            Whether they are.
        """
        return self._attempt(lambda: self._begin(self.values()))

    def play_preset(self) -> bool:
        """Start the chosen preset; return whether it is valid."""
        chosen = self._presets[self.preset.value]
        return self._attempt(lambda: self._begin(chosen))

    def _begin(self, settings: GameSettings) -> None:
        self._session.reset(settings)
        self._show(self._session.settings)

    def _attempt(self, change: Callable[[], None]) -> bool:
        """Change the game, or show what is wrong."""
        try:
            change()
        except (StepAsideError, ArithmeticError, ValueError) as error:
            self._notify(str(error))
            return False
        return True

    def _adopt(self) -> None:
        """Change the evader's strategy from its next plan on."""
        session, settings = self._session, self.values()
        now = session.settings
        if now.game != "duel":
            return
        strategy = settings.evader.evasion
        if strategy == now.evader.evasion:
            return
        played = session.played.evader.strategy
        if played != EVASION:
            self._notify(f"these are settings of evasion, not of {played}")
            return

        def change() -> None:
            evader = session.world.player(EVADER)
            if isinstance(evader, RobotPlayer):
                evader.scheme.decisions.adopt(strategy)
            session.adopt_settings(now.changed(evader={"evasion": strategy}))

        session.call(change)
        number = now.names.index(EVADER)
        for leaf in leaves_of(strategy, f"players.{number}.evasion."):
            self._leaves[leaf.path] = leaf
