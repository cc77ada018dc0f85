"""Everything that one sole or both perceive in one reading, computed on demand."""
