"""What the safety shell checks at every tick."""
