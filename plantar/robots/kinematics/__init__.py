"""Kinematics of the legs, size of the body, limits of the ankles."""
