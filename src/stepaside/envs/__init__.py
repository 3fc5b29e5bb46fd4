"""Learning environments; importing the package registers the Gymnasium ids.

``stepaside/Evade-v0`` and ``stepaside/Pursue-v0`` are environments of one
player; :class:`ParallelDuel` is that of both, and :class:`ParallelGame` that
of any number.
"""

from ..core.extras import install_hint

try:
    import gymnasium
    import pettingzoo as _pettingzoo  # noqa: F401
except ModuleNotFoundError as error:
    hint = install_hint(error)
    raise ModuleNotFoundError(hint, name=error.name) from error

from .duel_env import DuelEnv, VectorDuel
from .environment_settings import EnvironmentSettings
from .parallel_games import ParallelDuel, ParallelGame

IDS = {"stepaside/Evade-v0": "evader", "stepaside/Pursue-v0": "pursuer"}
for _id, _role in IDS.items():
    gymnasium.register(
        _id,
        entry_point="stepaside.envs:DuelEnv",
        vector_entry_point="stepaside.envs:VectorDuel",
        kwargs={"role": _role},
    )

__all__ = [
    "DuelEnv",
    "EnvironmentSettings",
    "ParallelDuel",
    "ParallelGame",
    "VectorDuel",
]
