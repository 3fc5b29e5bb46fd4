from .body import Body as Body
from .phase import Phase as Phase
from .scheme import ControlScheme as ControlScheme

__all__ = [
    "Body",
    "ControlScheme",
    "Phase",
]
