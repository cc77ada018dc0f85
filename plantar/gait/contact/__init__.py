"""What feet stand on, and the ground ahead."""
