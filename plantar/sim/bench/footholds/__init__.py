"""How controllers or policies walk blindly on less, or other, ground than planned."""
