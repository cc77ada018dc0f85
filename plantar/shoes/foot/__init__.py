"""Reading a foot: mesh, robot model or outline, and orientation."""
