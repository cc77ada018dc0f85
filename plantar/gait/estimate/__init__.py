"""State of the body: floating base, loads, and the frame that joints are solved in."""
