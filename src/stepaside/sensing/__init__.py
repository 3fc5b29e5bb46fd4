"""From images to where the other is (paper, Sec. II)."""
