"""How a robot stands and walks, found in its model."""
