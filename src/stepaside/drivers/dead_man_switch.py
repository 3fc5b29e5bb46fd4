"""Dead-man switch: the robot walks only while an operator holds it."""

import os
import select
import struct
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from time import monotonic
from typing import Protocol, TextIO

from ..core.errors import ConfigurationError

FIRST = 0.8  # a key counts as held after its first press: keyboards repeat
# after 0.25 to 0.66 s, in [s]
REPEAT = 0.4  # after each further press, in [s]; keyboards repeat at 10-30 Hz
GAMEPAD = "/dev/input/js0"
_EVENT = struct.Struct("<IhBB")  # time [ms], value, type, number; of Linux
_BUTTON, _INITIAL = 0x01, 0x80  # types of events


class DeadManSwitch(Protocol):
    """Switch that an operator holds."""

    def released(self) -> str:
        """Return why the robot must stand; empty while the switch is held."""

    def close(self) -> None:
        """Release the device."""


class HeldKey:
    """Any key of the terminal, held or pressed again and again."""

    def __init__(
        self, terminal: TextIO, clock: Callable[[], float] = monotonic
    ) -> None:
        """Read single keys, without echo."""
        import termios
        import tty

        if not terminal.isatty():
            raise ConfigurationError(
                "--dead-man key requires a terminal on standard input"
            )
        self._file, self._clock = terminal.fileno(), clock
        self._before = termios.tcgetattr(self._file)
        tty.setcbreak(self._file)  # Ctrl-C still interrupts
        self._held_until = -1.0

    def released(self) -> str:
        """Return why the robot must stand; empty while a key is held."""
        now = self._clock()
        if select.select([self._file], [], [], 0.0)[0]:
            if os.read(self._file, 4096):
                held = now <= self._held_until
                self._held_until = now + (REPEAT if held else FIRST)
        if now <= self._held_until:
            return ""
        return "dead-man switch: hold any key to walk"

    def close(self) -> None:
        """Restore the terminal."""
        import termios

        with suppress(termios.error, OSError):
            termios.tcsetattr(self._file, termios.TCSADRAIN, self._before)


class GamepadButton:
    """Any button of a gamepad, by the joystick interface of Linux."""

    def __init__(self, device: str = GAMEPAD) -> None:
        """Open the gamepad."""
        try:
            flags = os.O_RDONLY | os.O_NONBLOCK
            self._file: int | None = os.open(Path(device), flags)
        except OSError as error:
            raise ConfigurationError(
                f"no gamepad at {device}: {error.strerror}"
            ) from error
        self._name = device
        self._pressed: set[int] = set()

    def released(self) -> str:
        """Return why the robot must stand; empty while a button is held."""
        self._read()
        if self._file is None:
            return f"dead-man switch: gamepad {self._name} is gone"
        if not self._pressed:
            return "dead-man switch: hold a button of the gamepad to walk"
        return ""

    def close(self) -> None:
        """Close the gamepad."""
        if self._file is not None:
            os.close(self._file)
            self._file = None

    def _read(self) -> None:
        """Read the events that have arrived."""
        while self._file is not None:
            try:
                data = os.read(self._file, _EVENT.size)
            except BlockingIOError:
                return
            except OSError:
                data = b""
            if len(data) < _EVENT.size:
                self.close()
                return
            _, value, kind, number = _EVENT.unpack(data)
            if kind & ~_INITIAL != _BUTTON:
                continue
            if value:
                self._pressed.add(number)
            else:
                self._pressed.discard(number)
