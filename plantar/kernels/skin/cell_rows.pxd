cpdef ordered_rows(vertices, rings, starts, double tolerance)
