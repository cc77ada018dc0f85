"""A hand that works on surfaces: controller, actors, record."""
