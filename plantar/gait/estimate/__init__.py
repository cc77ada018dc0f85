"""How the body is: floating base, loads, and the frame that joints are solved in."""
