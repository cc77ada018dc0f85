"""What taxels measure, and what one of their signals tells: force, proximity, temperature, health."""
