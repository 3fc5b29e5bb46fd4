"""Games in physics: players, the one loop, and the run that it leaves."""

from ..core.lazy_exports import lazy_exports

__getattr__, __dir__, __all__ = lazy_exports(__name__, __file__)
