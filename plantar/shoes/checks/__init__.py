"""Whether the shoe prints, holds and mounts."""
