"""Simulated contacts as forces on a sole and its taxels."""
