"""Reaching a goal among obstacles that may be touched: layouts of obstacles, the controller, and what happened."""
