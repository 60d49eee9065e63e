"""Better machines: counterweights, four-bar classes, contact of cams, optimisation under limits, torque-free cams.

May import all rooms above: numbers to drive.

balancing         full, partial, optimal counterweights
counterweights    counterweights on links and their effect
least_shaking     counterweights of the least shaking force
linkage           four-bars: Grashof's class, swing, transmission, the chain unit
cam_contact       contact of a roller with its cam: side, curvature, Hertz pressure, life, limits
follower_speed    lift-off, surge of springs, torque to start
constraints       limits of outputs, parsed from texts
measures          outputs with their derivatives
parted_curves     curves on pieces between kinks
problem           outputs of a scene as functions of the varied numbers
search            the search by SciPy's optimisers
result            its result: the machine, active limits and their prices
case_text         scenes as case files
robust            quantiles over spreads of numbers
optimise          any machine under limits
pareto            the best of one output for each value of another
cam_start         start of the search for a torque-free cam
torque_free       cams that need no torque, and ways to carry weight
torque_balancing  a spring-loaded follower on a cam on the crank that leaves the mean torque alone
spring_follower   stretch of its spring over the crank angle
"""


def __getattr__(name):
    """A public name, loaded when first used; `__init__.pyi` lists them."""
    from ..numbers.lazy import public_name

    return public_name(__name__, name)


def __dir__():
    return __getattr__("__all__")
