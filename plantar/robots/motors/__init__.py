"""How a command becomes targets and torques of the leg joints' own motors."""
