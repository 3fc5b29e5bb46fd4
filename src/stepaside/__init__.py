"""Real-time pursuit and evasion for humanoid robots.

The public names most users need. Each is imported when it is first used, so
that ``import stepaside`` itself loads no library.
"""

from .core.lazy_exports import lazy_exports

__version__ = "0.2.0"
__getattr__, __dir__, __all__ = lazy_exports(__name__, __file__)
__all__.insert(0, "__version__")
