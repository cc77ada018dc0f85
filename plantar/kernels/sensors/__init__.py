"""Readings of simulated IMU, encoders, taxels, rays, and their noise."""
