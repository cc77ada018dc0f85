"""How a simulated sole can touch the ground and measure it: a study, which `plantar bench contact` runs."""
