"""Reading a foot: mesh, robot model or outline, and which way it points."""
