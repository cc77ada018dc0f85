"""Task changes: reflexes, intentional contact, contact phases."""
