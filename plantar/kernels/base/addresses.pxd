cpdef at(address)
