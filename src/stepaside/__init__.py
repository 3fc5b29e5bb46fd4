"""Real-time pursuit and evasion for humanoid robots.

Names of the public interface; each is imported on first use, which keeps
``import stepaside`` fast.
"""

import lazy_loader

__version__ = "0.1.0"
__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
__all__ = ["__version__", *__all__]
