"""What a robot's model says of how it stands and walks: found, written into a robot file, and checked."""
