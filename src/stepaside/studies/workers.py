"""Processes that work on a study; see :mod:`stepaside.workers`."""

from ..workers import WorkerPool, give_up, worker_pool

__all__ = ["WorkerPool", "give_up", "worker_pool"]
