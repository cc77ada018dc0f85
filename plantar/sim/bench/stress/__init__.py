"""Random short runs that must raise no error and give sane commands."""
