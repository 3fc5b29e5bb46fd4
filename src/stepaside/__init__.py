"""Real-time pursuit and evasion for humanoid robots.

What most people need stands at this door; it is imported when it is first
used, so that ``import stepaside`` itself costs nothing.
"""

import lazy_loader

__version__ = "0.1.0"
__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
__all__ = ["__version__", *__all__]
