"""What the taxels of a sole say: sums, areas and extents of one reading or of many, and the ground they see."""
