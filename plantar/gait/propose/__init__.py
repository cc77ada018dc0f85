"""What changes the plan: footholds found or refused, the shape of the ground, pushes and commands."""
