"""Readings of simulated IMU, encoders, taxels and rays, and their noise."""
