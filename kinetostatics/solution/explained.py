"""What a solution tells of how it comes to its numbers."""


class Explained:
    """The door to hand calculations."""

    def explain(self, quantity, angle, design=None):
        """The hand calculation of a quantity at one crank angle: formula, numbers with units, result, link by link.

        The steps are the kernels' own arithmetic. Friction, which is found by iteration, is told by the law that it
        satisfies.

        Parameters
        ----------
        quantity : str
            Any that the solution has: "balancing_torque", a joint (its reaction), "slider_acceleration" ...;
            ``"|O|"`` for the magnitude of a vector.
        angle : float
            Crank angle, rad; it need not be one of those solved.
        design : int or tuple of int, optional
            Which one of several designs.

        Returns
        -------
        Explanation
            ``print`` it, or show it in a notebook; `.text`, `.latex`, `.html`, and `.steps` as data.

        Raises
        ------
        QuantityError
            There is no such quantity; the message lists those there are.
        AssemblyError
            The mechanism does not close at that crank angle.
        ParameterError
            Several designs and none said, several crank angles, or one between those of a table.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> pump = ks.crank_slider(0.05, 0.2, slider=ks.Link(mass=1.0))
        >>> told = ks.solve(pump, 0.0, crank_speed=100.0).explain("slider_velocity", 0.7)
        >>> print(told.steps[-1].formula, "=", told.steps[-1].numbers, "=", told.steps[-1].shown, told.steps[-1].unit)
        omega*s_slider' = 100*(-0.0384514) = -3.84514 m/s
        """
        from .explanation import explain

        return explain(self, quantity, angle, design)
