"""Gait: walking on plantar feedback, and the analysis of recorded gait."""
