"""From tasks to joints: inverse kinematics, whole-body torque, static loads, set-points of servos."""
