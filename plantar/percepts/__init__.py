"""Everything that a sole, or both, perceive of one reading, each computed when it is asked for."""
