"""How the demands of many tasks become one torque: weighted, projected, in strict order, or within limits."""
