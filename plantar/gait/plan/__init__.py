"""Where to step, when, and where the CoM goes: footsteps, phases, VRPs."""
