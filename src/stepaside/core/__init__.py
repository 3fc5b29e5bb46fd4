"""Values and checks of every package: errors, ranges, poses, output."""
