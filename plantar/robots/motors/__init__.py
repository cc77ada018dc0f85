"""How a command becomes targets and torques of the leg motors."""
