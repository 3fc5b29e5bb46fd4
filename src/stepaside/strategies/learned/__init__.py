"""Learned strategies: a network in an ONNX file, with its contract."""

from .learned_strategy import (
    LearnedStrategy,
    dense_network,
    load_learned_strategy,
)
from .strategy_contract import StrategyContract

__all__ = [
    "LearnedStrategy",
    "StrategyContract",
    "dense_network",
    "load_learned_strategy",
]
