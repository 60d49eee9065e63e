"""Motion and forces of a mechanism at its crank angles; made by `solve` and `Scene.solve`.

Every result is computed when first read, and kept; none can be written to. SI and radians throughout; angles count
counter-clockwise from +x. Arrays end with the crank angles, N of them; batch axes of designs come before: (..., N). A
vector has (x, y) as its first axis: (2, ..., N).

A group's `label` ends the names of its links and forces: "coupler2", "slider2", "guide_force2" of a `SliderGroup` with
``label="2"``; its `pin` and `pivot_name` name its joints. `reactions` and `scalars` list all names. Where the mechanism
does not close, `solve` raises, or with ``on_gap="nan"`` gives NaN for the open group, groups attached to it, and forces
of groups that carry it.

Attributes
----------
mechanism : Mechanism
crank_angle : array (..., N)
    phi, rad.
crank_speed, crank_acceleration : float or array
    omega, rad/s, and alpha, rad/s2, counter-clockwise positive.
sense : None, float or array
    Way that a crank at rest is about to turn, as given: +1 counter-clockwise, -1 clockwise.
crank_sense : float or array
    `sense` if given, else the sign of the crank speed, at rest of the crank acceleration; +1 where both are 0.
loads : tuple
friction : mapping of joint to friction
engine, silent
    Engine that computes it; whether it warns no more.
shape : tuple
    (..., N) of a scalar result.
period : float
    Crank angle after which motion and loads repeat, rad: a turn unless loads, or passed change points, take more.
closed : array (..., N) of bool
    Whether the mechanism closes.
closure : tuple of array (..., N)
    Margin of each group: negative where it cannot be assembled, 0 at a limit position.
slider_position, slider_velocity, slider_acceleration : array (..., N)
    Of the slider's pin along its guide, m, m/s, m/s2, positive in the guide's direction; of the only slider, or the one
    without a label. `travel` gives the others.
pressure_angle : array (..., N)
    Of the cam pair, atan(r'/r), rad, positive where the radius grows with the crank angle.
reactions, scalars : tuple of str
    Names for `reaction` and for `scalar`.
balancing_torque : array (..., N)
    M, N m: the torque that the drive must give, on the crank, counter-clockwise positive, to keep the prescribed
    motion. Its power is M omega, whichever way the crank turns: with omega > 0 the drive pushes where M > 0 and brakes
    where M < 0; with omega < 0 it pushes where M < 0 and brakes where M > 0. M = J alpha + J' omega^2 / 2 + load
    torque.
balancing_torque_by_power : array (..., N)
    The same from the balance of powers, without any reaction.
power_residual : float or array
    Largest difference of the two over the turn, relative to the largest single power that flows: a check, about 1e-16.
load_torque : array (..., N)
    Torque on the crank that holds weight and loads at their speed, without any inertia, N m.
energy_per_turn : float
    Work of the balancing torque in a turn of the crank, J; of one design.
guide_force, guide_moment : array (..., N)
    Guide on slider: force along the guide's left normal, N, and moment about the slider's pin, N m.
guide_friction : array (..., N)
    Guide on slider, along the guide, N; against its velocity.
cam_force : array (..., N)
    Cam on roller along the normal, N: positive toward the inside of the pitch curve, as a ring around it pushes;
    negative outward, as a disk does.
slot_force : array (..., N)
    N; of a slotted crank on the block across the ray, positive with growing crank angle; of a lever on its block and of
    a yoke's slider on its block along the left normal of the slot.
contact_pressure : array (..., N)
    Largest Hertz pressure between cam and roller, Pa, of a cam that has a `Roller`.
shaking_force, shaking_moment : array (2, ..., N), array (..., N)
    Of the inertia of all moving masses on the frame, N; about O, N m.
reduced_inertia, reduced_inertia_slope : array (..., N)
    J: inertia of all links as the crank feels it, and J' = dJ/dphi, kg m2.
kinetic_energy, potential_energy : array (..., N)
    Of all links; of weight and springs, J. Weight has none at the height of O.
friction_loss, friction_torque : array (..., N)
    Power lost at all joints, W, not negative; this power over the crank speed, N m.
friction_margin, friction_residual : array (..., N)
    Distance of friction from jamming: 1 without friction, positive where exactly one state of forces exists; relative
    change of the forces by one more pass.
converged : array (..., N) of bool
    Whether friction and reactions agree to rounding.
losses : Losses
    Mean powers over the period by joint and load, W; of one design.
efficiency : float
    Work taken by loads over work taken by loads and lost at joints.
condition : array (..., N)
    Largest magnification of relative errors of lengths in rates and forces: 16 - log10 of it digits are left.
largest_force_term, largest_torque_term : float or array
    Largest single load that a reaction, N, or the torque, N m, is a sum of.

Methods
-------
reaction(joint)
    Reaction at a joint, (2, ..., N), N, components along +x and +y; the bodies that they act on are in the notes.
scalar(name)
    A force or moment by name, (..., N): those above, "slot_moment", "cylinder_force", "cylinder_moment",
    "contact_force" ...
pressure(name)
    Hertz pressure of a contact by name, (..., N), Pa: "contact_pressure" with the label of its follower.
pin_load(joint)
    Force on a pin by all rods on it together, (2, ..., N), N; on the link that owns the joint.
inertia_force(link)
    Minus mass times acceleration of the mass centre, (2, ..., N), N.
friction_at(joint), friction_loss_at(joint)
    Moment of a pin, N m, or force along a pair, N, on the link that moves there; power lost there, W; (..., N).
position(point), velocity(point), acceleration(point)
    (2, ..., N), m, m/s, m/s2, of a joint "B", a mass centre "coupler", a place on a link ("coupler", along, across).
rate(link), angular_acceleration(link)
    Of a link, (..., N), rad/s, rad/s2, counter-clockwise positive.
travel(slider), travel_velocity(slider), travel_acceleration(slider)
    As `slider_position` and so on, of any slider.
elongation(free_position, slider)
    Slider position less a free position, m, without cancellation.
measure(name)
    Another quantity of motion of a group, as "pressure_angle", "cylinder_length", (..., N).
at(crank_angle)
    The same mechanism, speed and loads at other crank angles.
condition_of(quantity)
    Condition of one quantity, cancellation of its terms counted in.
error_bound(quantity, tight)
    Proven bound on the rounding error of each value, in the quantity's shape and unit; ``"|O|"`` for a magnitude.
uncertainty(quantity, inputs)
    `Uncertainty` of each value from standard uncertainties of inputs, by path, and from rounding.
explain(quantity, angle, design)
    The hand calculation of a quantity at one crank angle, link by link: formula, numbers with units, result.
frame()
    All results as a pandas DataFrame, units in the headings.

Notes
-----
A reaction acts on the body named last, on the other body the other way round:

- "O": ground on crank.
- "A": on the coupler (rod, block of a lever or yoke, first link of a dyad), from what carries A: the crank, or the
  block of a cam roller. Of a group hung on another joint, "C": on its coupler, from what carries C.
- "B", pin of a slider: coupler on slider; pin of a rocker: coupler on rocker; pin of a dyad: dyad1 on dyad2.
- "O2", a fixed pivot: ground on rocker, on lever, on cylinder, on arm.
- "guide": ground on slider, or on follower; friction included.

For groups and loads of one's own there are `placement` (joints and links as kinematic coefficients), `spot`,
`as_vector`, `accelerating`; inside the library `dynamics`, `sampled`, `sampled_for_forces`, `apart`, `kind`,
`places`, `PATHS`, `RULES`, `first_look`, `with_doubt`, `proportion`, `farthest`, `loads_are_given`, `is_given`, `check`
and `warn`.

Examples
--------
>>> import kinetostatics as ks
>>> saw = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))
>>> s = ks.Scene(saw, 33.5, loads=[ks.Gravity()]).solve(360)
>>> s.reactions, s.scalars
(('A', 'B', 'guide', 'O'), ('guide_force', 'guide_moment', 'balancing_torque'))
>>> print(f"{s.balancing_torque[30] * s.crank_speed / 1e3:.0f} kW from the drive at 30 deg")
1269 kW from the drive at 30 deg
>>> back = ks.Scene(saw, -33.5, loads=[ks.Gravity()]).solve(360)  # the other way round: the same forces
>>> bool(abs(back.balancing_torque - s.balancing_torque).max() < 1e-9)
True
"""
