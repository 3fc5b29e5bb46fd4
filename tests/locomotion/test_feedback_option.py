"""Test the default of the feedback option."""

from dataclasses import replace

import click
import pytest

from stepaside.cli.connection_settings import with_feedback
from stepaside.cli.options.settings_options import GIVEN
from stepaside.games.duel_settings import DuelSettings
from stepaside.locomotion.zmp.control_settings import (
    OPEN_LOOP,
    STABILISED,
    ControlSettings,
)

LEARNS = replace(OPEN_LOOP, learn_turns=True)


def chosen(control: ControlSettings, *said: str) -> ControlSettings:
    """Control of settings after an option of the command was or was not."""
    with click.Context(click.Command("serve")) as context:
        context.meta[GIVEN] = frozenset(said)
        return with_feedback(DuelSettings(control=control)).control


@pytest.mark.parametrize("name", ["control.feedback", "control.method"])
def test_an_explicit_feedback_option_holds(name: str) -> None:
    assert chosen(OPEN_LOOP, name) == OPEN_LOOP


def test_feedback_is_the_default() -> None:
    assert chosen(OPEN_LOOP) == STABILISED
    mpc = ControlSettings("mpc", feedback=True)
    assert chosen(mpc) == mpc


def test_to_learn_turns_takes_no_feedback_away() -> None:
    """A real robot's joints would walk in open loop."""
    assert chosen(LEARNS) == replace(STABILISED, learn_turns=True)
    assert chosen(LEARNS, "control.feedback") == LEARNS
