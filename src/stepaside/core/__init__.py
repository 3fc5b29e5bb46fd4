"""Values and checks that every package uses: errors, ranges, poses, output files."""
