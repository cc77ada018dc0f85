"""Whether the shoe prints, holds and can be mounted."""
