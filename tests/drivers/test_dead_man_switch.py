"""Test that a robot walks only while an operator holds a switch."""

import os
import select
import struct
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from stepaside.drivers.dead_man_switch import (
    FIRST,
    REPEAT,
    GamepadButton,
    HeldKey,
)


class FakeClock:
    """Clock that a test sets."""

    now = 0.0

    def __call__(self) -> float:
        """Time, in [s]."""
        return self.now


@pytest.fixture
def keyboard() -> Iterator[tuple[HeldKey, Callable[[], object], FakeClock]]:
    """Key of a terminal, a function that presses it, and the clock."""
    pty = pytest.importorskip("pty")
    near, far = pty.openpty()
    clock = FakeClock()
    with os.fdopen(far, "r") as terminal:
        key = HeldKey(terminal, clock)

        def press() -> None:
            os.write(near, b" ")
            assert select.select([terminal], [], [], 60.0)[0]

        yield key, press, clock
        key.close()
    os.close(near)


def test_a_held_key_lets_the_robot_walk_until_it_is_released(
    keyboard: tuple[HeldKey, Callable[[], object], FakeClock],
) -> None:
    key, press, clock = keyboard
    assert "hold any key" in key.released()
    press()
    assert not key.released()
    clock.now = 0.9 * FIRST  # a keyboard begins to repeat
    assert not key.released()
    press()
    assert not key.released()
    clock.now += 0.9 * REPEAT
    assert not key.released()
    clock.now += 0.2 * REPEAT
    assert "hold any key" in key.released()


def event(value: int, kind: int, number: int = 4) -> bytes:
    return struct.pack("<IhBB", 1000, value, kind, number)


def test_a_gamepad_lets_the_robot_walk_while_a_button_is_held(
    tmp_path: Path,
) -> None:
    device = tmp_path / "js0"
    os.mkfifo(device)
    writer = os.open(device, os.O_RDWR)
    pad = GamepadButton(str(device))
    os.write(writer, event(0, 0x81) + event(30000, 0x02))  # at first; a stick
    assert "hold a button" in pad.released()
    os.write(writer, event(1, 0x01))
    assert not pad.released()
    os.write(writer, event(1, 0x01, 7) + event(0, 0x01))
    assert not pad.released()
    os.write(writer, event(0, 0x01, 7))
    assert "hold a button" in pad.released()
    os.write(writer, event(1, 0x01))
    assert not pad.released()
    os.close(writer)
    assert "is gone" in pad.released()
    pad.close()
