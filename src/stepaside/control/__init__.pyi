from .scheme import ControlScheme as ControlScheme

__all__ = [
    "ControlScheme",
]
