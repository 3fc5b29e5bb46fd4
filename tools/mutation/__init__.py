"""Faults put into the package by hand of a machine, to see the tests fail.

``python -m tools.mutation`` draws faults by a seed, runs the tests that
reach each one in a scratch copy of the tree, and writes the score and the
faults that no test noticed. ``docs/mutation.md`` says more.
"""
