"""`compile`: what a scene computes made ready once, and called with other numbers as often as one likes."""

import numpy as np

from ..engines.error_bounds import PRECISIONS
from ..engines.jax_backend import Backend
from ..engines.numba_backend import numba_available, require_numba
from ..machine.loads import is_given
from ..mechanics.load_values import require_pure
from ..numbers import checks
from .program import Program
from .scene import scene_problem, unchecked

ANGLES = np.array([0.3, 2.0])
"""Crank angles at which functions of loads are called before they are recorded."""


def compile(  # noqa: A001 - the contract's name
    scene, quantities, parameters=(), engine=None, *, precision="double", device=None
) -> Program:
    """Program of some quantities of a scene, to be called with other crank angles and other numbers.

    Parameters
    ----------
    scene : Scene
    quantities : str or sequence of str
        "balancing_torque", a joint (its reaction), "slider_acceleration", "coupler_rate" ...
    parameters : str or sequence of str
        Paths of numbers that are zero in the scene and shall be given other values. What is zero is otherwise absent,
        and costs nothing.
    engine : "compiled", "numpy" or "jax"
        Unless told, compiled if numba is installed; "jax" (extra `grad`) runs on the accelerator that JAX finds.
    precision : "double" or "single"
        Of what is computed at each crank angle, and of the results. Sines of crank angles, tables and all that a design
        fixes are computed in double even then, and rounded once; `Program.error_bound` says what single costs.
    device : str, optional
        For JAX: "cpu", "gpu" or another platform instead of the first that it has.

    Returns
    -------
    Program

    Raises
    ------
    ParameterError
        The scene has no such parameter, JAX no such device, or a function of a load is not pure.
    QuantityError
        The mechanism has no such quantity; the message lists those it has.
    NotGivenError
        A group or load of your own does more than arithmetic with sin, cos and sqrt, so it cannot be recorded.
    MissingLibraryError
        ``engine="compiled"`` without numba, or ``engine="jax"`` without JAX.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> pump = ks.crank_slider(0.05, 0.2, slider=ks.Link(mass=1.0))
    >>> program = ks.compile(ks.Scene(pump, crank_speed=100.0), "balancing_torque", engine="numpy")
    >>> round(float(program(0.5)["balancing_torque"]), 6)
    14.875291
    >>> round(float(program(0.5, {"slider.mass": 2.0})["balancing_torque"]), 6)
    29.750582
    >>> ks.compile(program.scene, "balancing_torque", engine="numpy", precision="single")(0.5)["balancing_torque"].dtype
    dtype('float32')
    """
    checks.require("compile", checks.names("quantities", quantities), checks.names("parameters", parameters))
    names = (quantities,) if isinstance(quantities, str) else tuple(quantities)
    checks.require(
        "compile",
        scene_problem(scene),
        None if names else "no quantities are asked for",
        *(checks.quantity(name) for name in names),
        None if engine is None else checks.choice("engine", engine, ("compiled", "numpy", "jax")),
        checks.choice("precision", precision, tuple(PRECISIONS)),
        None if device is None else _device_problem(device, engine),
    )
    if engine == "compiled":
        require_numba()
    if not all(map(is_given, scene.loads)) and np.size(scene.crank_speed) == np.size(scene.crank_acceleration) == 1:
        require_pure(unchecked(scene, ANGLES))
    kept = (parameters,) if isinstance(parameters, str) else tuple(parameters)
    backend = Backend(engine or ("compiled" if numba_available() else "numpy"), precision, device)
    backend.device  # noqa: B018  refuses one that is not there
    return Program(scene, names, kept, backend)


def _device_problem(device, engine):
    """What is wrong with a device that is asked for, but that it is not there; or None."""
    if engine != "jax":
        return 'device is for engine="jax"; all others run on the processor'
    return None if isinstance(device, str) else f'device must be a text as "gpu", got {checks.shown(device)}'
