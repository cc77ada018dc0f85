"""Moving bodies that push on a walking robot's upper body skin."""
