"""A scene's `[sole_contact]` table: how sole and ground yield to each other, in MuJoCo's parameters."""

from plantar.common.settings.schema import Settings, choice, number, share


class Contact(Settings):
    """The contact of soles and ground; docs/simulation.md gives the reason that a real sole has each.

    Attributes:
        settling: Time constant of `solref`, in which a contact brings penetration to rest; two physics steps at least.
            Its damping ratio is the robot's, `[shoe] contact_damping`.
        least_impedance: Impedance of `solimp` at the surface.
        largest_impedance: The same at `rigid_depth` and deeper.
        rigid_depth: Penetration over which a contact becomes as stiff as it gets.
        listed_gap: Gap up to which a corner that hovers is listed as one that could carry; it has no force.
        cone: Of friction.
        impratio: Ratio of friction's impedance to the normal one's: larger ones creep less.
    """

    settling: float = number(0.005, "s", 1e-4, 0.2)
    least_impedance: float = number(0.95, "1", 0.01, 0.9999)
    largest_impedance: float = number(0.99, "1", 0.01, 0.9999)
    rigid_depth: float = share(1 / 600, "leg", 1e-6, 0.1)
    listed_gap: float = share(1 / 600, "leg", 0, 0.1)
    cone: str = choice("elliptic", "pyramidal")
    impratio: float = number(10.0, "1", 0.1, 1000)
