"""Better machines: counterweights, four-bar classes, contact of cams, optimisation under limits, torque-free cams.

May import all rooms above: numbers to drive.

balancing       full, partial, optimal counterweights
linkage         four-bars: swing, transmission, the chain unit
grashof         their classes
cam_contact     contact of a roller with its cam: side, curvature, Hertz pressure, limits
contact_asked   what it is asked with: the roller, both materials, limits
cam_rollers     the roller itself: spin and sliding, load and life of its pin
hardness        the pressure that steel bears
followers       lift-off, surge of springs, torque to start
demands         what is asked of a design, read from texts
derived         what follows from the numbers that vary
measures        outputs with their derivatives
problem         outputs of a scene as functions of the numbers that vary
progress        bars that count its steps
search          the search by SciPy's optimisers
found           its result: the machine, what binds, what it costs
case_text       scenes as case files
spread          how numbers spread, and which quantile counts
robust          quantiles over spreads as what is made least or greatest
optimisation    any machine under limits
fronts          the best of one output for each value of another
cam_start       the cam-balanced crank-slider that a search for its cam begins with
torque_free     cams that need no torque
weights         what carries weight where a symmetric cam cannot
torque_balancing  spring-loaded follower on a cam on the crank that leaves the mean torque alone
torque_balanced what it gives and costs
spring_follower how far its spring is stretched at each crank angle
"""


def __getattr__(name):
    """A public name, loaded when first used; `__init__.pyi` lists them."""
    from ..numbers.lazy import public_name

    return public_name(__name__, name)


def __dir__():
    return __getattr__("__all__")
