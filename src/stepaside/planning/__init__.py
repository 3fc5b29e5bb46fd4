"""Maneuver planning in closed form (paper, Sec. III); imports numpy only."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
