"""Measuring the perception: run time against error next to other libraries, and a stress run over a million readings.

Nothing else imports this package; `plantar bench kernels` loads it. scipy, shapely and cv2 are loaded inside functions.
"""
