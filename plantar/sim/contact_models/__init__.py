"""How a simulated sole can touch and measure ground (`plantar bench contact`)."""
