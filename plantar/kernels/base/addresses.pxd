# C types of addresses.py. Without a compiler this file is not read.
cpdef at(address)
