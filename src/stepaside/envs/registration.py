"""Registration of the environments with Gymnasium."""

import gymnasium

IDS = {"stepaside/Evade-v0": "evader", "stepaside/Pursue-v0": "pursuer"}


def register_environments() -> None:
    """Register all environment ids that are not registered yet."""
    for name, role in IDS.items():
        if name not in gymnasium.registry:
            gymnasium.register(
                name,
                entry_point="stepaside.envs.duel_env:DuelEnv",
                vector_entry_point="stepaside.envs.vector_physics:make_vector_env",
                kwargs={"role": role},
            )
