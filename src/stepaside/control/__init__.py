"""Control of one robot (paper, Fig. 4): perceive, plan, move."""

from typing import TYPE_CHECKING

from ..doors import door

if TYPE_CHECKING:
    from .body import Body
    from .phase import Phase
    from .scheme import ControlScheme
else:
    __getattr__ = door(
        __name__,
        {
            "Body": "body",
            "Phase": "phase",
            "ControlScheme": "scheme",
        },
    )

__all__ = ["Body", "ControlScheme", "Phase"]
