"""Errors raised by this package, and the checks that raise them."""

from math import isfinite


class StepAsideError(Exception):
    """Base class of every error that this package raises."""


class PlanError(StepAsideError, ValueError):
    """A plan was asked for with values that no plan can satisfy."""


class ConfigurationError(StepAsideError, ValueError):
    """A setting is unknown, of the wrong type or out of its range."""


class ReachError(StepAsideError, ValueError):
    """A body was asked for a posture that it cannot take."""


class StrategyError(StepAsideError, RuntimeError):
    """A strategy failed when it was asked, or gave no intent."""


class ModelError(StepAsideError, ValueError):
    """A robot description does not fit its model."""


class OutputError(StepAsideError, OSError):
    """The system did not let a result be written."""


def check_finite(
    value: float,
    name: str,
    unit: str,
    error: type[StepAsideError] = PlanError,
) -> None:
    """Raise ``error`` unless ``value`` is a finite number."""
    _check_type(value, name, unit, error)
    if not isfinite(value):
        raise error(f"{name} must be finite [{unit}], got {value}")


def check_positive(
    value: float,
    name: str,
    unit: str,
    error: type[StepAsideError] = PlanError,
) -> None:
    """Raise ``error`` unless ``value`` is finite and above zero."""
    _check_type(value, name, unit, error)
    if not 0.0 < value < float("inf"):
        raise error(f"{name} must be finite and > 0 [{unit}], got {value}")


def check_not_negative(
    value: float,
    name: str,
    unit: str,
    error: type[StepAsideError] = PlanError,
) -> None:
    """Raise ``error`` unless ``value`` is finite and at least zero."""
    _check_type(value, name, unit, error)
    if not 0.0 <= value < float("inf"):
        raise error(f"{name} must be finite and >= 0 [{unit}], got {value}")


def check_within(
    value: float,
    low: float,
    high: float,
    name: str,
    unit: str,
    error: type[StepAsideError] = PlanError,
) -> None:
    """Raise ``error`` unless ``low <= value <= high``."""
    _check_type(value, name, unit, error)
    if not low <= value <= high:
        raise error(
            f"{name} must lie in [{low:g}, {high:g}] [{unit}], got {value}"
        )


def _check_type(
    value: object, name: str, unit: str, error: type[StepAsideError]
) -> None:
    """Refuse true and false, which Python takes for one and zero."""
    if isinstance(value, bool):
        raise error(f"{name} must be a number [{unit}], got {value}")
