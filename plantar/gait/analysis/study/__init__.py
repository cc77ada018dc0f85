"""Study: a folder of recordings, its participants, and condition differences."""
