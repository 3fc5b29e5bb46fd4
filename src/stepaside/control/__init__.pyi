from .body import Body as Body
from .scheme import ControlScheme as ControlScheme

__all__ = [
    "Body",
    "ControlScheme",
]
