"""Games on a grid: the distance that a robot can keep from an opponent."""

from ...core.lazy_exports import lazy_exports

__getattr__, __dir__, __all__ = lazy_exports(__name__, __file__)
