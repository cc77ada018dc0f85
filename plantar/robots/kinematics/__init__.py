"""Kinematics of the legs: joint angles for CoM, torso and soles, how large the body is, what its ankles carry."""
