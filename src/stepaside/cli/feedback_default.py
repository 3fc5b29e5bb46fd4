"""Feedback where a robot needs it, unless somebody said what is to be."""

from typing import TYPE_CHECKING

import click
from click.core import ParameterSource

if TYPE_CHECKING:
    from ..games.duel_settings import DuelSettings


def with_feedback(settings: "DuelSettings") -> "DuelSettings":
    """Settings with feedback, unless they say what control is to be."""
    from dataclasses import replace

    from ..locomotion.zmp.control_settings import OPEN_LOOP, STABILISED

    source = click.get_current_context().get_parameter_source
    asked = (source("control__feedback"), source("control__method"))
    said = any(one is not ParameterSource.DEFAULT for one in asked)
    learns = settings.control.learn_turns
    if said or replace(settings.control, learn_turns=False) != OPEN_LOOP:
        return settings
    return replace(settings, control=replace(STABILISED, learn_turns=learns))
