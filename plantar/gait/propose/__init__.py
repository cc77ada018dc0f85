"""What wants to change the plan: footholds found, footholds refused, the shape of the ground."""
