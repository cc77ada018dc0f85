"""The solids: body, tray, pad, retention, lettering. The only room that builds with cadquery."""
