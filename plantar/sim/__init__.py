"""MuJoCo simulation of robots, terrain, skin and scenes, and its truth."""
