"""Every dimension of the shoe decided: block, heel, wiring."""
