"""Who touches a robot that walks: moving bodies that push on the skin of its upper body."""
