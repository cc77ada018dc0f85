"""Blind footholds: how any controller or policy walks where a foot finds less, or other, ground than planned."""
