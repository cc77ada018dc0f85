"""MuJoCo models from robots and ground, and MuJoCo's contacts."""
