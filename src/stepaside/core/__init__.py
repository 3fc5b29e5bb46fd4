"""Basis of all packages: errors, ranges, poses, output, processes."""
