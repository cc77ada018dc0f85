"""MuJoCo models from robots and ground, the kinematics of the legs, and MuJoCo's contacts."""
