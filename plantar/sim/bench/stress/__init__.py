"""The whole loop under odd circumstances: random short runs in which nothing may raise, and no command be nonsense."""
