"""The plan: footsteps, phases, VRPs."""
