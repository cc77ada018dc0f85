"""A hand that works on surfaces: its controller, who acts on the machine, and what is noted of it."""
