"""Values of settings that are left open, from gait, body and opponent.

The settings of a walk, a duel and a game leave open what was not chosen.
Their ``resolved()`` decides it by these functions, wherever the settings come
from: command line, file, study or Python.
"""

from dataclasses import replace

from ..locomotion.control_settings import ControlSettings, LegsSettings
from ..planning import GaitSettings
from ..sim.body_settings import BodySettings
from ..strategies import Evasion

EVASION = "evasion"
STEP_ASIDE = "step-aside"
IDEAL = BodySettings()


def implied_control(
    control: ControlSettings, gait: GaitSettings, body: BodySettings
) -> ControlSettings:
    """Return walking control with a method and a choice of feedback.

    Feedback is needed on every body but the ideal one, for plans from the
    measured state, and for fast gaits.

    Args:
        control: Control; a method or feedback of None is open.
        gait: Gait of the robot.
        body: Deviations of its body.
    """
    feedback, method = control.feedback, control.method
    if feedback is None:
        planned = method in (None, "closed-form")
        feedback = gait.is_fast or body != IDEAL or not planned
    if method is None:
        measures = feedback and not gait.is_fast
        method = "measured" if measures else "closed-form"
    return replace(control, method=method, feedback=feedback)


def implied_evader(legs: LegsSettings, *, person: bool) -> str:
    """Return the strategy of an evader for which none is chosen.

    Learned legs step to every side, so they step aside for a person.

    Args:
        legs: Legs of the robot; all learned ones step sideways.
        person: Whether it evades a person.
    """
    return STEP_ASIDE if person and legs.walks else EVASION


def implied_trigger(
    evasion: Evasion, gait: GaitSettings, *, person: bool
) -> Evasion:
    """Return the paper's evasion with a trigger.

    People walk at any speed, and a trigger distance suits only one. So a
    robot that walks fast enough evades them by time to contact.

    Args:
        evasion: Evasion; a trigger of None is open.
        gait: Gait of the robot.
        person: Whether it evades a person.
    """
    if evasion.trigger is not None:
        return evasion
    return replace(
        evasion, trigger="time" if person and gait.is_fast else "distance"
    )
