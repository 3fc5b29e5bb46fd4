"""Learned strategies: a dense network in an ONNX file, with its contract."""

from .learned_strategy import LearnedStrategy, load_learned_strategy
from .network_graph import NetworkGraph, NetworkNode, dense_network
from .strategy_contract import StrategyContract

__all__ = [
    "LearnedStrategy",
    "NetworkGraph",
    "NetworkNode",
    "StrategyContract",
    "dense_network",
    "load_learned_strategy",
]
