"""Mutation testing: automatic faults in the package, to check the tests.

``python -m tools.mutation`` draws faults by a seed, runs the tests that reach
each one in a scratch copy of the tree, and writes the score and the survivors.
See ``docs/mutation.md``.
"""
