"""Tables of settings that check themselves."""
