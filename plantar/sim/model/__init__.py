"""MuJoCo models from robots and ground, the kinematics of the legs, and what MuJoCo says of contacts."""
