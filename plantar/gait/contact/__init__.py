"""What the feet stand on, and what the ground ahead of them is."""
