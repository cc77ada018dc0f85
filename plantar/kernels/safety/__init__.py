"""What the safety shell checks each tick."""
