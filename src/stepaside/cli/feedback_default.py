"""Feedback by default, for commands that control robots over a link."""

from typing import TYPE_CHECKING

import click
from click.core import ParameterSource

if TYPE_CHECKING:
    from ..games.duel_settings import DuelSettings


def with_feedback(settings: "DuelSettings") -> "DuelSettings":
    """Enable feedback unless options or settings choose the control."""
    from dataclasses import replace

    from ..locomotion.zmp.control_settings import OPEN_LOOP, STABILISED

    source = click.get_current_context().get_parameter_source
    chosen = any(
        source(name) is not ParameterSource.DEFAULT
        for name in ("control__feedback", "control__method")
    )
    learns = settings.control.learn_turns
    if chosen or replace(settings.control, learn_turns=False) != OPEN_LOOP:
        return settings
    return replace(settings, control=replace(STABILISED, learn_turns=learns))
