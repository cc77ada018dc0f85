"""In what the true robot, its sensors and the ground differ from what the controller takes them for."""
