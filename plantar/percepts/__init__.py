"""What one sole or both perceive in a reading, computed on demand."""
