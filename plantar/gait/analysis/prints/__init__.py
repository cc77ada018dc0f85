"""The footprint: its shape and regions, and which cells of a platform are one."""
