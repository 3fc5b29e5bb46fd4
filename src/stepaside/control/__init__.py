"""Control of one robot (paper, Fig. 4): perception, planning, motion."""

from ..core.lazy_exports import lazy_exports

__getattr__, __dir__, __all__ = lazy_exports(__name__, __file__)
