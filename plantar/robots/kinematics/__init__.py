"""Kinematics of the legs: joint angles for CoM, torso and soles, size of the body, limits of the ankles."""
