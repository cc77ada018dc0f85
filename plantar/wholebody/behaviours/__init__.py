"""What changes which tasks there are and in which order: reflexes, intentional contact, phases of contact."""
