"""What simulated sensors read: IMU, encoders, taxels, rays, and the noise in them."""
