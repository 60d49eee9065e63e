"""Contact pressure of a solution, by name."""

from typing import Any

from ..mechanics.quantities import of_scene
from ..numbers import checks


class Contacts:
    """Pressures of line contacts, of a cam that has a `Roller` or a follower that has a `Face`."""

    dynamics: Any
    _found: Any

    def pressure(self, name="contact_pressure"):
        """Largest Hertz pressure of a contact by name, (..., N), Pa; NaN where there is no such contact.

        Of a second follower the name ends with its label.
        """
        checks.require("pressure", checks.quantity(name))
        known = of_scene(self)
        return self._found(name) if name in known and known[name].kind == "contact" else self.dynamics.pressure(name)

    @property
    def contact_pressure(self):
        """Largest Hertz pressure between cam and roller, Pa, of a cam that has a `Roller`."""
        return self.pressure()
