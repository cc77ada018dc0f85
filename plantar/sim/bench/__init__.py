"""What a scene's time goes to, and what is skipped."""
