"""Checks of a robot that stands, leans and unloads each foot, before its first step."""
