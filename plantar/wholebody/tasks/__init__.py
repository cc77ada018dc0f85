"""What a robot shall do, one task a file: each says its Jacobian and the force or acceleration that it asks for."""
