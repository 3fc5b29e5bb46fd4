"""Maneuver planning in closed form (paper, Sec. III); imports numpy only."""

from ..core.lazy_exports import lazy_exports

__getattr__, __dir__, __all__ = lazy_exports(__name__, __file__)
