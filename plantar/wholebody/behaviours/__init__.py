"""Changes of tasks and their order: reflexes, intentional contact, phases of contact."""
