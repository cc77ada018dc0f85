"""Arms of a walking robot, and how they yield to contact."""
