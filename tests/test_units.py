"""Quantities of pint at every door: in the right unit they are the plain numbers, in another they are refused."""

import inspect
import math
import re
import warnings

import numpy as np
import pint
import pytest

import kinetostatics as ks
from kinetostatics.machine.loads import Load
from kinetostatics.numbers import checks
from kinetostatics.numbers.checks import Checked
from support.every import every
from support.units import UNITS

TURN = np.linspace(0.0, 6.0, 12)
PUMP = ks.crank_slider(0.05, 0.2, coupler=ks.Link(1.0, 0.1, 0.01), slider=ks.Link(1.0))
SCENE = ks.Scene(PUMP, 100.0, loads=[ks.ProcessForce(-200.0), ks.Spring(1e3, 0.2)])
SOLVED = SCENE.solve(TURN)
BAR = ks.linkage.chain_unit(0.1, 1.0, 1.0)
MOTOR = ks.drive.Motor.kloss(750.0, 99.0, synchronous_speed=104.7, overload=2.5)
CAM = ks.cams.CosineLaw(0.25, 2.0)
SAW = ks.cam_crank_slider(CAM, CAM.coupler_length, slider=ks.Link(600.0))
SAWN = ks.solve(SAW, 0.5, crank_speed=10.0, loads=ks.Spring.balancing(600.0, 11.0, 2.0))
GUIDE = ks.Guide.at(0.0)
ANGLES = np.radians(np.arange(0.0, 360.0, 8.0))
NOISE = 1e-4 * np.random.default_rng(0).standard_normal(ANGLES.size)
PENDULUM = ks.Scene(ks.crank_slider(0.3, 1.0, crank=ks.Link(2.0, 0.15)), 1.0, loads=ks.Gravity())
RODDED = ks.Scene(ks.crank_slider(0.05, 0.2, coupler=ks.Link(1.2, 0.1, 0.004), slider=ks.Link(1.0)), 100.0)
RUN = ks.drive.steady(SCENE, MOTOR, flywheel=0.05)

SEGMENT = {"start": (0.25, "m"), "end": (0.5, "m"), "angle": (1.0, "rad")}
SHAPE = {"guide_angle": (0.5, "rad"), "guide_offset": (0.0625, "m")}
SHAFT = {"transmission": (4.0, "1"), "inertia": (0.5, "kg*m**2")}
DOORS = {
    "Link": (ks.Link, {"mass": (2.0, "kg"), "centre": ((0.5, 0.25), "m"), "inertia": (0.5, "kg*m**2")}, {}),
    "Crank": (
        ks.Crank,
        {"length": (0.5, "m"), "bearings": ((-0.5, 0.5), "m")},
        {},
    ),
    "Rotor": (
        ks.Rotor,
        {"mass": (2.0, "kg"), "centre": ((0.5, 0.25), "m"), "inertia": (0.5, "kg*m**2"), "plane": (0.125, "m")}
        | {"couple_unbalance": ((0.5, 0.25), "kg*m**2")},
        {},
    ),
    "Guide": (ks.Guide, {"angle": (0.5, "rad"), "guide_offset": (0.25, "m")}, {}),
    "Guide.exact": (ks.Guide, {"exact": ((0.6, 0.8), "1")}, {"angle": None}),
    "Guide.at": (ks.Guide.at, SHAPE, {}),
    "Guide.through": (ks.Guide.through, {"W1": ((0.0, 0.25), "m"), "W2": ((1.0, 0.5), "m")}, {}),
    "Roller": (
        ks.Roller,
        {"radius": (0.25, "m"), "width": (0.125, "m"), "youngs_modulus": (2e11, "Pa"), "poissons_ratio": (0.25, "1")}
        | {"cam_youngs_modulus": (1e11, "Pa"), "cam_poissons_ratio": (0.25, "1")},
        {},
    ),
    "Face": (
        ks.Face,
        {"width": (0.125, "m"), "youngs_modulus": (2e11, "Pa"), "poissons_ratio": (0.25, "1")}
        | {"cam_youngs_modulus": (1e11, "Pa"), "cam_poissons_ratio": (0.25, "1")},
        {},
    ),
    "SliderGroup": (ks.SliderGroup, {"coupler_length": (0.5, "m"), "plane": (0.125, "m")}, {"guide": GUIDE}),
    "RockerGroup": (
        ks.RockerGroup,
        {"coupler_length": (0.5, "m"), "rocker_length": (0.5, "m"), "pivot": ((0.5, 0.25), "m")}
        | {"plane": (0.125, "m")},
        {},
    ),
    "Dyad": (
        ks.Dyad,
        {"length1": (0.5, "m"), "length2": (0.25, "m"), "plane": (0.125, "m")},
        {"on": ("B", "C"), "pin": "D"},
    ),
    "LeverGroup": (ks.LeverGroup, {"pivot": ((0.5, 0.25), "m"), "offset": (0.125, "m"), "plane": (0.125, "m")}, {}),
    "CylinderGroup": (ks.CylinderGroup, {"pivot": ((0.5, 0.25), "m"), "plane": (0.125, "m")}, {}),
    "YokeGroup": (ks.YokeGroup, {"slot_angle": (1.0, "rad"), "plane": (0.125, "m")}, {"guide": GUIDE}),
    "PlanetaryCrank": (
        ks.PlanetaryCrank,
        {"radius": (0.25, "m"), "line_angle": (1.0, "rad"), "pressure_angle": (0.5, "rad"), "plane": (0.125, "m")},
        {},
    ),
    "Pin": (ks.Pin, {"at": ((0.5, 0.25), "m"), "plane": (0.125, "m")}, {"on": "coupler", "name": "C"}),
    "SwingingFollower": (
        ks.SwingingFollower,
        {"arm_length": (0.25, "m"), "pivot": ((0.5, 0.25), "m"), "plane": (0.125, "m")},
        {"cam": ks.laws.cosine(0.1, 1.0)},
    ),
    "RollerFollower": (ks.RollerFollower, {"plane": (0.125, "m")}, {"cam": ks.laws.cosine(0.1, 1.0)}),
    "FlatFollower": (ks.FlatFollower, {"plane": (0.125, "m")}, {"cam": ks.laws.cosine(0.1, 1.0)}),
    "CamRoller": (ks.CamRoller, {"plane": (0.125, "m")}, {"cam": ks.cams.Circle(0.5)}),
    "crank_slider": (ks.crank_slider, {"crank_length": (0.5, "m"), "coupler_length": (2.0, "m"), **SHAPE}, {}),
    "cam_crank_slider": (ks.cam_crank_slider, {"coupler_length": (2.0, "m"), **SHAPE}, {"cam": ks.cams.Circle(0.5)}),
    "four_bar": (
        ks.four_bar,
        {
            "crank_length": (0.5, "m"),
            "coupler_length": (2.0, "m"),
            "rocker_length": (2.0, "m"),
            "rocker_pivot": ((1.5, 0.25), "m"),
        },
        {},
    ),
    "slotted_lever": (
        ks.slotted_lever,
        {"crank_length": (0.5, "m"), "pivot": ((0.0, -2.0), "m"), "offset": (0.125, "m")},
        {},
    ),
    "scotch_yoke": (ks.scotch_yoke, {"crank_length": (0.5, "m"), "slot_angle": (1.0, "rad"), **SHAPE}, {}),
    "Gravity": (ks.Gravity, {"acceleration": (8.0, "m/s**2"), "direction": (-1.5, "rad")}, {}),
    "Spring": (
        ks.Spring,
        {"stiffness": (8.0, "N/m"), "free_position": (0.5, "m"), "cubic": (4.0, "N/m**3"), "mass": (2.0, "kg")},
        {},
    ),
    "Spring.balancing": (
        ks.Spring.balancing,
        {"mass": (8.0, "kg"), "crank_speed": (4.0, "rad/s"), "free_position": (0.5, "m"), "spring_mass": (2.0, "kg")},
        {},
    ),
    "BalanceShaft": (
        ks.BalanceShaft,
        {"unbalance": (0.5, "kg*m"), "ratio": (-2.0, "1"), "phase": (0.5, "rad"), "at": ((0.5, 0.25), "m")}
        | {"inertia": (0.25, "kg*m**2"), "mass": (2.0, "kg"), "plane": (0.125, "m")},
        {},
    ),
    "GasSpring": (
        ks.GasSpring,
        {
            "area": (0.5, "m**2"),
            "volume": (0.25, "m**3"),
            "pressure": (2.0**18, "Pa"),
            "at": (0.5, "m"),
            "exponent": (1.25, ""),
            "ambient": (2.0**16, "Pa"),
        },
        {},
    ),
    "ProcessForce": (ks.ProcessForce, {"force": (8.0, "N"), "period": (4 * math.pi, "rad")}, {}),
    "Force": (
        ks.Force,
        {"value": (8.0, "N"), "direction": (0.5, "rad"), "at": ((0.5, 0.25), "m")},
        {},
    ),
    "Sawing": (
        ks.Sawing,
        {"kerf": (0.5, "m"), "height": (0.25, "m"), "saws": (8.0, ""), "feed_per_stroke": (0.125, "m")}
        | {"resistance": (5e7, "Pa"), "thrust": (0.25, ""), "overhang": (0.5, "m")},
        {},
    ),
    "Sawing.pitch": (
        ks.Sawing,
        {"pitch": (0.03125, "m")},
        {"kerf": 0.5, "height": 0.25, "saws": 8, "feed_per_stroke": 0.125, "resistance": lambda chip: 5e7},
    ),
    "Mowing": (
        ks.Mowing,
        {"force": (8.0, "N"), "pitch": (0.5, "m"), "start": (0.125, "m"), "end": (0.25, "m")},
        {},
    ),
    "Torque": (ks.Torque, {"value": (8.0, "N*m")}, {"on": "crank"}),
    "PointForce": (ks.PointForce, {"value": (8.0, "N")}, {"between": ("A", "B")}),
    "PointSpring": (
        ks.PointSpring,
        {"stiffness": (8.0, "N/m"), "free_length": (0.5, "m")},
        {"between": ("A", "B")},
    ),
    "PointDamper": (ks.PointDamper, {"coefficient": (8.0, "N*s/m")}, {"between": ("A", "B")}),
    "TorsionSpring": (
        ks.TorsionSpring,
        {"stiffness": (8.0, "N*m/rad"), "free_angle": (0.5, "rad"), "moment": (2.0, "N*m")},
        {"on": "coupler"},
    ),
    "TorsionDamper": (ks.TorsionDamper, {"coefficient": (8.0, "N*m*s")}, {"on": "coupler"}),
    "Table": (
        ks.Table,
        {"x": (ANGLES, "rad"), "y": (np.cos(ANGLES), "N"), "period": (2 * math.pi, "rad"), "zero": (0.5, "rad")},
        {},
    ),
    "Table over travel": (
        ks.Table,
        {"x": ([0.25, 0.5, 1.0], "m"), "y": ([1.0, 2.0, 4.0], "N*m"), "back": ([2.0, 4.0, 8.0], "N*m")},
        {"over": "travel"},
    ),
    "PinFriction": (ks.PinFriction, {"mu": (0.125, "1"), "radius": (0.25, "m")}, {}),
    "GuideFriction": (ks.GuideFriction, {"mu": (0.125, "1"), "half_length": (0.25, "m")}, {}),
    "SlotFriction": (ks.SlotFriction, {"mu": (0.125, "1"), "half_length": (0.25, "m")}, {}),
    "RollerFriction": (
        ks.RollerFriction,
        {
            "mu": (0.125, "1"),
            "pin_radius": (0.25, "m"),
            "roller_radius": (0.5, "m"),
            "rolling_arm": (0.015625, "m"),
        },
        {},
    ),
    "Circle": (ks.cams.Circle, {"radius": (0.5, "m"), "centre": ((0.125, 0.0), "m")}, {}),
    "CosineLaw": (
        ks.cams.CosineLaw,
        {"amplitude": (0.25, "m"), "mean": (2.0, "m"), "guide_angle": (0.5, "rad")},
        {},
    ),
    "Harmonic": (
        ks.cams.Harmonic,
        {"cosine": ((0.5, 0.125), "m"), "sine": ((0.125,), "m"), "guide_angle": (0.5, "rad")},
        {},
    ),
    "Sampled": (
        ks.cams.Sampled,
        {"angle": (ANGLES, "rad"), "radius": (CAM.radius(ANGLES)[0] + NOISE, "m"), "noise": (1e-4, "m")},
        {},
    ),
    "from_law": (
        ks.cams.from_law,
        {"coupler_length": (CAM.coupler_length, "m"), "guide_angle": (0.5, "rad"), "guide_offset": (0.0, "m")},
        {"law": ks.laws.cosine(0.25, 2.0)},
    ),
    "cosine": (ks.laws.cosine, {"amplitude": (0.25, "m"), "mean": (2.0, "m"), "phase": (0.5, "rad")}, {}),
    **{name: (getattr(ks.laws, name), SEGMENT, {}) for name in ("cycloidal", "harmonic", "modified_sine")},
    "modified_trapezoid": (ks.laws.modified_trapezoid, SEGMENT, {}),
    "polynomial": (ks.laws.polynomial, SEGMENT, {}),
    "dwell": (ks.laws.dwell, {"position": (0.25, "m"), "angle": (0.5, "rad")}, {}),
    "table": (
        ks.laws.table,
        {"angle": (ANGLES, "rad"), "position": (2.0 + np.cos(ANGLES) + NOISE, "m"), "noise": (1e-4, "m")},
        {},
    ),
    "Motor.kloss": (
        ks.drive.Motor.kloss,
        {"power": (64.0, "W"), "speed": (8.0, "rad/s"), "synchronous_speed": (16.0, "rad/s"), "overload": (2.0, "1")}
        | SHAFT,
        {},
    ),
    "Motor.linear": (ks.drive.Motor.linear, {"torque": (8.0, "N*m"), "speed": (8.0, "rad/s")} | SHAFT, {}),
    "Motor.constant": (ks.drive.Motor.constant, {"torque": (8.0, "N*m")} | SHAFT, {}),
    "Motor.table": (
        ks.drive.Motor.table,
        {"speed": ([0.0, 8.0, 16.0], "rad/s"), "torque": ([4.0, 8.0, 0.0], "N*m")} | SHAFT,
        {},
    ),
    "Scene": (
        ks.Scene,
        {"crank_speed": (8.0, "rad/s"), "crank_acceleration": (2.0, "rad/s**2"), "sense": (1.0, "1")}
        | {"resolution": (1e-3, "rad")},
        {"mechanism": PUMP},
    ),
    "solve": (
        ks.solve,
        {"crank_angle": (TURN, "rad"), "crank_speed": (8.0, "rad/s"), "crank_acceleration": (2.0, "rad/s**2")}
        | {"sense": (1.0, "1"), "resolution": (1e-3, "rad")},
        {"mechanism": PUMP},
    ),
    "Scene.check_resolution": (SCENE.check_resolution, {"step": (1e-4, "rad")}, {}),
    "Scene.solve": (SCENE.solve, {"angles": (TURN, "rad")}, {}),
    "Solution.at": (SOLVED.at, {"crank_angle": (TURN, "rad")}, {}),
    "coast": (
        ks.drive.coast,
        {
            "flywheel": (0.0625, "kg*m**2"),
            "from_angle": (-1.0, "rad"),
            "from_speed": (0.5, "rad/s"),
            "until": (0.5, "s"),
        },
        {"scene": PENDULUM},
    ),
    "start": (
        ks.drive.start,
        {"flywheel": (0.0625, "kg*m**2"), "from_angle": (0.5, "rad"), "until": (0.125, "s")},
        {"scene": PENDULUM, "motor": MOTOR},
    ),
    "steady": (
        ks.drive.steady,
        {"flywheel": (0.5, "kg*m**2"), "angles": (TURN, "rad")},
        {"scene": SCENE, "motor": MOTOR},
    ),
    "flywheel": (ks.drive.flywheel, {"fluctuation": (0.125, "1")}, {"scene": SCENE}),
    "run.with_flywheel": (RUN.with_flywheel, {"inertia": (0.5, "kg*m**2")}, {}),
    "run.flywheel_for": (RUN.flywheel_for, {"fluctuation": (0.0625, "1")}, {}),
    "Bar": (
        ks.Bar,
        {
            "area": (0.0625, "m**2"),
            "modulus": (0.0625, "m**3"),
            "mass": (1.0, "kg"),
            "second_moment": (0.0625, "m**4"),
            "youngs_modulus": (2.0e11, "Pa"),
        },
        {},
    ),
    "bearing": (
        ks.sizing.bearing,
        {"capacity": (1e5, "N"), "static_capacity": (2e5, "N"), "exponent": (3.0, "1")},
        {"solution": SOLVED, "joint": "A"},
    ),
    "plain_bearing": (
        ks.sizing.plain_bearing,
        {"diameter": (0.0625, "m"), "width": (0.0625, "m")},
        {"solution": SOLVED, "joint": "A"},
    ),
    "equivalent_load": (ks.sizing.equivalent_load, {"exponent": (3.0, "1")}, {"loads": [1.0, 2.0], "shares": [1, 1]}),
    "pin_strength": (
        ks.sizing.pin_strength,
        {"diameter": (0.0625, "m"), "width": (0.125, "m"), "shear_planes": (2.0, "1")},
        {"solution": SOLVED, "joint": "B"},
    ),
    "mount": (
        ks.sizing.mount,
        {
            "mass": (1000.0, "kg"),
            "stiffness": (1e6, "N/m"),
            "damping": (0.125, "1"),
        },
        {"solution": SOLVED},
    ),
    "mount.turning": (
        ks.sizing.mount,
        {"inertia": (50.0, "kg*m**2"), "centre": ((0.0, 0.5), "m")},
        {"solution": SOLVED, "mass": 1000.0, "stiffness": [1e6, 1e6, 1e5], "damping": [0.1, 0.1, 0.1]},
    ),
    "bar_strength": (
        ks.sizing.bar_strength,
        {"ultimate": (6e8, "Pa"), "endurance": (2e8, "Pa"), "yield_strength": (3.5e8, "Pa")},
        {"solution": RODDED.solve(4), "link": "coupler", "bar": ks.Bar(6e-4, 3e-6, (), None, 6e-8, 2.06e11)},
    ),
    "contact_loss": (
        ks.sizing.contact_loss,
        {"clearance": (1e-4, "m"), "damping": (0.125, "1")},
        {"solution": RODDED.solve(4), "joint": "B"},
    ),
    "SpringMaterial": (
        ks.sizing.SpringMaterial,
        {
            "strength": (1.9e9, "Pa"),
            "exponent": (0.125, "1"),
            "thinnest": (0.0005, "m"),
            "thickest": (0.0625, "m"),
            "shear_modulus": (78.5e9, "Pa"),
            "youngs_modulus": (206e9, "Pa"),
            "set_share": (0.5, "1"),
            "density": (7850.0, "kg/m**3"),
            "unpeened": ((379e6, 241e6), "Pa"),
            "peened": ((534e6, 398e6), "Pa"),
        },
        {"name": "own"},
    ),
    "HelicalSpring": (
        ks.sizing.HelicalSpring,
        {
            "wire_diameter": (0.0078125, "m"),
            "coil_diameter": (0.0625, "m"),
            "active_turns": (6.0, "1"),
            "travel": (0.0625, "m"),
            "preload": (500.0, "N"),
            "crank_speed": (2.0, "rad/s"),
            "end_factor": (0.5, "1"),
        },
        {},
    ),
    "block_for": (
        ks.sizing.block_for,
        {"v_rms": (0.0625, "m/s"), "tuning": (0.5, "1"), "damping": (0.125, "1")},
        {"solution": SOLVED},
    ),
    "helical_spring": (
        ks.sizing.helical_spring,
        {
            "stiffness": (20e3, "N/m"),
            "travel": (0.0625, "m"),
            "preload": (800.0, "N"),
            "allowed_stress": (4e8, "Pa"),
            "safety": (1.5, "1"),
            "index": (8.0, "1"),
            "crank_speed": (2.0, "rad/s"),
            "end_factor": (0.5, "1"),
        },
        {},
    ),
    "contact": (
        ks.design.contact,
        {
            "roller_radius": (0.0625, "m"),
            "width": (0.0625, "m"),
            "youngs_modulus": (2.0e11, "Pa"),
            "poissons_ratio": (0.25, "1"),
            "roller_mass": (1.0, "kg"),
            "roller_inertia": (0.5, "kg*m**2"),
            "load_rating": (1e5, "N"),
            "life_exponent": (3.0, "1"),
        },
        {"solution": SAWN},
    ),
    "Spread": (
        ks.design.Spread,
        {"quantile": (0.5, "1"), "trim": (0.25, "1")},
        {"spreads": {"slider.mass": "1..2 kg"}},
    ),
    "spring_surge": (ks.design.spring_surge, {"spring_mass": (0.5, "kg")}, {"solution": SOLVED}),
    "pressure_from_hardness": (ks.design.pressure_from_hardness, {"brinell": (300.0, "1")}, {}),
    "hardness_from_pressure": (ks.design.hardness_from_pressure, {"pressure": (1e9, "Pa")}, {}),
    "Counterweight": (
        ks.balancing.Counterweight,
        {"mass": (2.0, "kg"), "largest_mass": (4.0, "kg"), "largest_arm": (0.5, "m"), "keep_out": (0.25, "m")},
        {},
    ),
    "Counterweight.arm": (ks.balancing.Counterweight, {"arm": (0.5, "m"), "plane": (0.125, "m")}, {}),
    "shafts": (
        ks.balancing.shafts,
        {"harmonics": ((1.0, 2.0), "1"), "at": ((0.5, 0.25), "m")},
        {"scene": SOLVED},
    ),
    "in_two_planes": (
        ks.balancing.in_two_planes,
        {"reciprocating": (0.5, "1")},
        {"mechanism": PUMP}
        | {name: ks.balancing.Counterweight(mass=2.0, plane=z) for name, z in (("left", -0.5), ("right", 0.5))},
    ),
    "counterweight": (
        ks.balancing.counterweight,
        {"unbalance": (0.5, "kg*m")},
        {"mechanism": PUMP, "link": "crank", "weight": ks.balancing.Counterweight(mass=2.0)},
    ),
    "partial": (
        ks.balancing.partial,
        {"ratio": (0.5, "1")},
        {"mechanism": PUMP, "crank": ks.balancing.Counterweight(mass=2.0)},
    ),
    "chain_unit": (
        ks.linkage.chain_unit,
        {
            "crank_length": (0.125, "m"),
            "coupler_length": (1.0, "m"),
            "rocker_length": (1.0, "m"),
            "pivot_x": (1.0, "m"),
        },
        {},
    ),
    "chain_unit_angle": (ks.linkage.chain_unit_angle, {"angle": (TURN, "rad")}, {}),
    "rocker_angle": (
        ks.linkage.rocker_angle,
        {"start": (1.5, "rad")},
        {"solution": ks.solve(BAR, TURN, crank_speed=1.0)},
    ),
    "swing": (ks.linkage.swing, {"start": (1.5, "rad")}, {"solution": ks.solve(BAR, TURN, crank_speed=1.0)}),
    "cam.radius": (CAM.radius, {"phi": (TURN, "rad")}, {}),
    "cam.profile": (CAM.profile, {"roller_radius": (0.0625, "m"), "angle": (TURN, "rad")}, {}),
    "cam.base_radius": (CAM.base_radius, {"pressure_angle": (0.5, "rad")}, {}),
    "profile.cutter_path": (CAM.profile(0.0625, 360).cutter_path, {"cutter_radius": (0.125, "m")}, {}),
    "profile.exceeded": (
        CAM.profile(0.0625, 360).exceeded,
        {"pressure_angle": (0.125, "rad"), "curvature_radius": (0.5, "m")},
        {},
    ),
    "law": (ks.laws.cosine(0.25, 2.0), {"phi": (TURN, "rad")}, {}),
    "law.shifted": (ks.laws.cosine(0.25, 2.0).shifted, {"phase": (0.5, "rad")}, {}),
}
"""By name: what is called, its numbers with their units, and what else it takes."""

SLOW = {
    "torque_free_cam": (
        ks.design.torque_free_cam,
        {
            "ends": ((1.75, 2.25), "m"),
            "guide_offset": (0.0, "m"),
            "coupler_spring": (1.5, "rad"),
            "counterweight": (8.0, "kg"),
            "shaft_radius": (0.0625, "m"),
        },
        {"source": SCENE},
    ),
    "weight_options": (ks.design.weight_options, {"counterweight": (8.0, "kg")}, {"source": SCENE}),
    "optimise": (
        lambda slider_mass: ks.design.optimise(SCENE, {"slider.mass": slider_mass}, "largest O"),
        {"slider_mass": ((1.0, 2.0), "kg")},
        {},
    ),
    "torque_balancing_cam": (
        ks.design.torque_balancing_cam,
        {
            "mass": (0.5, "kg"),
            "travel": (0.0625, "m"),
            "stiffness": (8.0, "N/m"),
            **SHAPE,
            "base_radius": (0.5, "m"),
            "pressure_angle": (0.5, "rad"),
            "roller_radius": (0.0625, "m"),
            "shaft_radius": (0.0625, "m"),
            "switches": ([0.5, 1.0], "rad"),
        },
        {"scene": SCENE},
    ),
    "optimal": (
        ks.balancing.optimal,
        {"about": ((0.25, 0.5), "m")},
        {"mechanism": PUMP, "norm": "largest moment", "angles": 12, "crank": ks.balancing.Counterweight(arm=0.03)},
    ),
    "pareto": (
        ks.balancing.pareto,
        {"about": ((0.25, 0.5), "m"), "crank_speed": (2.0, "rad/s")},
        {"mechanism": PUMP, "points": 2, "angles": 12, "crank": ks.balancing.Counterweight(arm=0.03)},
    ),
    "needs": (ks.needs, {"within": (0.5, "1")}, {"scene": SOLVED, "quantity": "O"}),
    "cam.export": (
        CAM.export,
        {"roller_radius": (0.0625, "m"), "cutter_radius": (0.125, "m")},
        {"path": "nowhere/cam.csv"},
    ),
    "plots.mechanism": (ks.plots.mechanism, {"angles": ([40.0, 50.0], "deg")}, {"solutions": SOLVED}),
    "plots.mass_centres": (ks.plots.mass_centres, {"angle": (40.0, "deg")}, {"solutions": SOLVED}),
    "plots.sketch": (ks.plots.sketch, {"angle": (40.0, "deg")}, {"machine": PUMP}),
    "plots.principal_points": (ks.plots.principal_points, {"angle": (40.0, "deg")}, {"mechanism": PUMP}),
    "plots.free_body": (ks.plots.free_body, {"angle": (40.0, "deg")}, {"solution": SOLVED, "link": "coupler"}),
    "plots.animation": (ks.plots.animation, {"interval": (40.0, "ms")}, {"solution": SOLVED}),
    "plots.hodograph": (ks.plots.hodograph, {"marks": (40.0, "deg")}, {"solutions": SOLVED}),
    "plots.hodographs": (ks.plots.hodographs, {"marks": (40.0, "deg")}, {"solutions": SOLVED}),
    "plots.rocking_moment": (
        ks.plots.rocking_moment,
        {"marks": (40.0, "deg")},
        {
            "solutions": ks.Scene(
                ks.Mechanism("pump", ks.Crank(0.05), (ks.SliderGroup(0.2, slider=ks.Link(2.0), plane=0.1),)), 10.0
            ).solve(8)
        },
    ),
    "plots.cam_curvature": (ks.plots.cam_curvature, {"roller_radius": (0.0625, "m")}, {"cams": CAM}),
    "plots.cam_pressure_angle": (ks.plots.cam_pressure_angle, {"largest": (0.5, "rad")}, {"cams": CAM}),
    "plots.cam_profile": (
        ks.plots.cam_profile,
        {"roller_radius": (0.0625, "m"), "angles": ([40.0], "deg"), "cutter_radius": (0.125, "m")},
        {"cam": CAM},
    ),
}
"""The same of what computes, draws or writes for long: tried with the wrong dimension alone."""


def measured(value, unit):
    """The number with its unit, as a quantity; of a pair by its parts."""
    units = UNITS.parse_units("" if unit == "1" else unit)
    if isinstance(value, tuple):
        return tuple(UNITS.Quantity(part, units) for part in value)
    return UNITS.Quantity(np.array(value) if isinstance(value, list) else value, units)


def seen(found):
    """What a call gives, in all digits."""
    if isinstance(found, ks.Solution | ks.Scene):
        scene = found if isinstance(found, ks.Scene) else ks.Scene(found.mechanism, found.crank_speed)
        angle = TURN if isinstance(found, ks.Scene) else found.crank_angle
        return [part.tobytes() for part in (angle, scene.solve(angle).balancing_torque)]
    if isinstance(found, ks.drive.Running | ks.drive.Trajectory):
        return found.speed.tobytes()
    if isinstance(found, ks.balancing.Balanced):
        return repr(found.counterweights)
    if type(found).__module__.startswith("scipy"):  # a spline, whatever else its versions keep
        return [np.asarray(getattr(found, part)).tobytes() for part in "ctx" if hasattr(found, part)]
    if hasattr(found, "__dict__") and not isinstance(found, type):
        return {name: seen(part) for name, part in vars(found).items() if name != "unit"}
    if isinstance(found, np.ndarray):
        return found.tobytes()
    return [seen(part) for part in found] if isinstance(found, list | tuple) else repr(found)


def numbers(*tables):
    """Each number of each door."""
    return [
        pytest.param(name, parameter, id=f"{name} {parameter}").values
        for table in tables
        for name, (_, given, _) in table.items()
        for parameter in given
    ]


@pytest.fixture(autouse=True)
def _in_peace():
    with warnings.catch_warnings(action="ignore"):
        yield


@pytest.mark.slow
@every(("name", "parameter"), numbers(DOORS))
def test_quantity_equals_the_plain_number(name, parameter):
    make, given, others = DOORS[name]
    plain = {key: value for key, (value, _) in given.items()}
    told = plain | {parameter: measured(*given[parameter])}
    assert seen(make(**told, **others)) == seen(make(**plain, **others))


@pytest.mark.slow
@every("name", DOORS)
def test_results_print_plain_numbers(name):
    make, given, others = DOORS[name]
    found = make(**{key: value for key, (value, _) in given.items()}, **others)
    if type(found).__module__.startswith("kinetostatics"):
        assert not re.search(r"np\.float|array\(", f"{found!r} {found}")


CALLED = {
    "run.with_flywheel inertia": "flywheel",
    "exact": "direction",
    "angles": "angle",
    "phi": "crank angle",
    "slider_mass": "slider.mass",
}
"""What errors call some parameters."""


@pytest.mark.slow
@every(("name", "parameter"), numbers(DOORS, SLOW))
def test_wrong_dimension_names_both(name, parameter):
    make, given, others = (DOORS | SLOW)[name]
    plain = {key: value for key, (value, _) in given.items()}
    told = plain | {parameter: measured(given[parameter][0], "cd")}
    with pytest.raises(ks.ParameterError, match=r"must measure .* which measures \[luminosity\]") as caught:
        make(**told, **others)
    assert CALLED.get(f"{name} {parameter}", CALLED.get(parameter, parameter)).split("_")[-1] in str(
        caught.value
    ).replace("_", " ")


NO_NUMBERS = {
    *("arm", "assembly", "along", "against", "block", "cam", "coupler", "crank", "cylinder", "crank", "dyad1", "dyad2"),
    *("dimensions", "machine"),
    *("engine", "follower", "friction", "groups", "guide", "group", "label", "law", "lever", "link", "links", "loads"),
    *("mechanism", "motor", "name", "on", "over", "pin", "pivot_name", "rod", "rocker", "slider", "scene", "between"),
    *("solution", "solutions", "spreads", "weight", "whole_link", "source", "case", "reference", "variant", "silent"),
    *("quantity", "quantities", "parameters", "path", "on_gap", "outputs", "minimise", "maximise", "robust", "vary"),
    *("begin", "progress", "ax", "joints", "joint", "by", "order", "like", "table", "output", "needs", "found", "cams"),
    *("precision", "device", "reaction", "before", "opposing", "cuts", "spring", "left", "right", "result", "marks"),
    *("planet", "numbers", "units"),
    *("bars", "shaft", "masses", "bar", "material", "arrangement", "correction", "peened", "kind", "shares", "raw"),
    *("laws", "contacts", "side", "segments", "smooth", "powers", "force", "norm", "balanced", "spread"),
    *(
        "executor",
        "folder",
        "options",
        "counterweights",
        "uniform",
        "gravity",
        "designs",
        "run",
        "runs",
        "only",
        "roller",
        "face",
        "counted",
        "labels",
        "title",
        "command",
        "pdf",
        "what",
    ),
    # whole numbers
    *("angles", "samples", "seed", "starts", "count", "chunk", "workers", "points", "frames", "cosine", "sine"),
    # texts, or a mapping of names to numbers with units of their own: see the tests below
    *("limits", "weights", "phase", "cubic"),
}
"""Parameters that take no number with a unit."""
RESULTS = {
    "Explanation",
    "Found",
    "Front",
    "SolutionNumber",  # texts and a function
    "Contact",
    "FollowerContact",
    "Surge",
    "TorqueBalancing",
    "Running",
    "Trajectory",
    "Event",
    "Flywheel",
    "Swing",
}
RESULTS |= {
    "Balanced",
    "WithShafts",
    "Grashof",
    "LawCam",
    "Segment",
    "Motion",
    "Solution",
    "Motor",
    "Profile",
    "Peak",
    "Case",
    "Variant",
}
RESULTS |= {"Comparison", "DrivenComparison", "EnergyFlow", "Extremes", "Losses", "Needs", "PrincipalPoints", "Program"}
RESULTS |= {
    "Sections",
    "Sized",
    "BalancingSpring",
    "ContactLoss",
    "Mount",
    "ResolutionCheck",
    "Shares",
    "Tolerances",
    "Uncertainty",
}
"""Classes that the library makes itself."""


def callables():
    """Every public function and class by name."""
    rooms = (ks, ks.cams, ks.laws, ks.drive, ks.design, ks.balancing, ks.linkage, ks.designs, ks.plots, ks.sizing)
    for room in rooms:
        for name in getattr(room, "__all__", dir(room)):
            item = getattr(room, name)
            own = hasattr(room, "__all__") or _room(getattr(item, "__module__", "")) == _room(room.__name__)
            own = own and not name.startswith("_")
            if own and callable(item) and name not in RESULTS and not (isinstance(item, type) and is_error(item)):
                yield name, item


def _room(module):
    return module.rpartition(".")[0]


def is_error(item):
    return issubclass(item, BaseException)


def test_every_public_number_has_a_dimension():
    tried: dict[str, set] = {}
    for name, (_, given, _) in (DOORS | SLOW).items():
        tried.setdefault(name.split(".")[-1] if name.startswith("plots") else name.split(".")[0], set()).update(given)
    tried["Table"] |= {"back", "sense"}
    missing = {
        f"{name}({parameter})"
        for name, item in callables()
        for parameter in inspect.signature(item).parameters
        if parameter not in NO_NUMBERS and parameter not in tried.get(name, ())
    }
    assert missing == set()


def rules_in(kind):
    """Rules of the numbers of a class by field."""
    for field, rule in kind.RULES.rules.items():
        rule = rule.rule if isinstance(rule, checks.Optional | checks.OrFunction) else rule
        if isinstance(rule, checks.Number | checks.Pair | checks.Series):
            yield field, rule


def test_every_number_declares_a_known_unit():
    kinds = [kind for _, kind in callables() if isinstance(kind, type) and hasattr(kind, "RULES")]
    assert len(kinds) > 25
    assert all(issubclass(kind, Checked | Load | object) for kind in kinds)
    for kind in kinds:
        for field, rule in rules_in(kind):
            assert rule.unit, (kind, field)
            UNITS.parse_units("" if rule.unit == "1" else rule.unit)


# What the doors cannot be asked one by one


@pytest.mark.slow
def test_programs_and_scenes_take_quantities():
    program = ks.compile(SCENE, "O", engine="numpy")
    same = program(UNITS.Quantity(90.0, "deg"), {"slider.mass": UNITS.Quantity(2000.0, "g")})["O"]
    assert np.array_equal(same, program(math.pi / 2, {"slider.mass": 2.0})["O"])
    assert SCENE.varied({"slider.mass": UNITS.Quantity(2000.0, "g")}).parameters["slider.mass"] == 2.0
    for call in (SCENE.varied, lambda values: program(0.5, values)):
        with pytest.raises(ks.ParameterError, match=r"mass must measure \[mass\], in kg, got 2 meter"):
            call({"slider.mass": UNITS.Quantity(2, "m")})
    case = ks.load_case("sawframe_2r63")
    named = case.variants["cam-circle"].varied({"spring.stiffness": UNITS.Quantity(700.0, "N/mm")})
    assert named.scene.parameters["spring.stiffness"] == 7e5
    with pytest.raises(ks.ParameterError, match=r"stiffness must measure \[mass\] / \[time\]\^2"):
        case.variants["cam-circle"].varied({"spring.stiffness": UNITS.Quantity(700.0, "N")})


def test_limits_of_a_contact_have_units_of_their_own():
    def made(**limits):
        return ks.design.contact(SAWN, 0.05, 0.04, 210e9, 0.3, load_rating=1e5, limits=limits).limits

    limits = {"pressure": (1.0, "GPa"), "pressure_angle": (30.0, "deg"), "life": (2.0, "day"), "pin_load": (1.0, "kN")}
    found = made(**{name: UNITS.Quantity(*pair) for name, pair in limits.items()})
    assert found == pytest.approx({"pressure": 1e9, "pressure_angle": math.pi / 6, "life": 48.0, "pin_load": 1e3})
    with pytest.raises(ks.ParameterError, match=r"limit 'life' must measure \[time\], in h"):
        made(life=UNITS.Quantity(1.0, "m"))


def test_force_and_moment_weights_have_units():
    bounded = {"crank": ks.balancing.Counterweight(arm=0.03)}
    with pytest.raises(ks.ParameterError, match=r"weights moment must measure"):
        ks.balancing.optimal(PUMP, "weighted", weights=(1.0, UNITS.Quantity(1.0, "1/N")), **bounded)


def test_uncertainties_of_inputs_have_their_units():
    told = SOLVED.uncertainty("O", {"crank_length": UNITS.Quantity(0.25, "mm")})
    assert np.array_equal(told.total, SOLVED.uncertainty("O", {"crank_length": 0.25e-3}).total)
    with pytest.raises(ks.ParameterError, match=r"crank_length must measure \[length\], in m, got 1 second"):
        SOLVED.uncertainty("O", {"crank_length": UNITS.Quantity(1, "s")})


def test_bounds_and_begins_of_a_search_are_converted():
    vary = {"slider.mass": (UNITS.Quantity(500, "g"), 2.0)}
    found = ks.design.optimise(SCENE, vary, "largest O", begin={"slider.mass": UNITS.Quantity(1500, "g")}, angles=36)
    assert found.values["slider.mass"] >= 0.5


MASS = {unit: tuple(UNITS.Quantity(value, unit) for value in (0.5, 1.0, 2.0)) for unit in ("kg", "lb")}


def test_grids_take_quantities():
    table = ks.designs.grid(
        {
            "spring.stiffness": UNITS.Quantity(np.array([600.0, 900.0]), "kN/m"),
            "crank_length": [UNITS.Quantity(0.0625, "m"), UNITS.Quantity(50.0, "mm")],
            "crank_speed": UNITS.Quantity(320.0, "rpm"),
        }
    )
    assert list(table.columns) == ["spring.stiffness [kN/m]", "crank_length [m]", "crank_speed [rpm]"]
    assert table.to_numpy().tolist() == [[k, r, 320.0] for k in (600.0, 900.0) for r in (0.0625, 0.05)]
    swept = ks.sweep(SCENE, table.iloc[:1, 1:], "largest O", angles=36, progress=False)
    plain = SCENE.varied({"crank_length": 0.0625, "crank_speed": 320.0 * math.pi / 30.0})
    assert swept["largest O [N]"][0] == pytest.approx(ks.extremes(plain.solve(36), "O").largest, rel=1e-6)


@pytest.mark.parametrize(("given", "text"), [
    (MASS["kg"][:2], "0.5..1 kg"),
    (("uniform", *MASS["kg"][:2]), "0.5..1 kg"),
    (("normal", UNITS.Quantity(1.0, "kg"), UNITS.Quantity(10.0, "g")), "normal 1 kg +- 10 g"),
    (("triangular", *MASS["lb"]), "triangular 0.5..1..2 lb"),
])  # fmt: skip
def test_quantity_samples_equal_their_text(given, text):
    for sample in (ks.designs.sobol, ks.designs.random, ks.designs.latin_hypercube):
        found, wanted = (sample({"slider.mass": spread}, 8) for spread in (given, text))
        assert found.equals(wanted)


def test_tolerances_take_quantities():
    options = {"count": 8, "angles": 36, "progress": False}
    given, text = ((MASS["kg"][0], MASS["kg"][2]), "0.5..2 kg")
    found, wanted = (
        ks.tolerances(SCENE, ["largest O"], {"slider.mass": spread}, **options) for spread in (given, text)
    )
    assert found.table.equals(wanted.table)


FOREIGN = pint.UnitRegistry(None)
FOREIGN.define("meter = [length]")
FOREIGN.define("inch = 0.03 * meter = in")
NO_SPREADS = [
    (UNITS.kg, "quantities of pint"), ([], "quantities of pint"), ((MASS["kg"][0], 2.0), "each with its unit"),
    ((MASS["kg"][0], UNITS.Quantity(2.0, "m")), r"must measure \[mass\], in kg, got 2.0 meter"),
    (UNITS.Quantity(math.nan, "kg"), "must be finite"), (UNITS.Quantity(np.ones((2, 2)), "kg"), "row"),
    (UNITS.Quantity(np.array([]), "kg"), "row"), (UNITS.Quantity(1j, "kg"), "real"),
    (UNITS.Quantity(1.0, "degC"), "\"°C\" has its own zero point"),
    (FOREIGN.Quantity(1.0, "inch"), "is another in the registry"),
]  # fmt: skip
NO_DISTRIBUTIONS = [
    (MASS["kg"], "uniform takes 2 quantities, got 3"), (MASS["kg"][1::-1], "must rise"),
    (("norml", *MASS["kg"][:2]), "did you mean 'normal'"), (("normal", MASS["kg"][0]), "takes 2 quantities, got 1"),
    (("normal", MASS["kg"][0], -MASS["kg"][1]), "must be greater than 0"),
    (("triangular", *MASS["kg"][:2]), "takes 3 quantities, got 2"),
]  # fmt: skip


@every(("read", "given", "message"), [
    (read, *wrong) for read in (ks.designs.grid, ks.designs.distributions) for wrong in NO_SPREADS
] + [(ks.designs.distributions, *wrong) for wrong in NO_DISTRIBUTIONS])  # fmt: skip
def test_wrong_quantity_spreads_are_refused(read, given, message):
    with pytest.raises(ks.ParameterError, match=f"slider.mass: .*{message}"):
        read({"slider.mass": given})


def test_tables_are_forces_or_torques():
    torque = ks.Table(ANGLES, UNITS.Quantity(np.cos(ANGLES), "N*m"))
    assert torque.unit == "N*m"
    assert torque != ks.Table(ANGLES, np.cos(ANGLES))
    ks.solve(PUMP, TURN, crank_speed=1.0, loads=ks.Torque(torque, on="crank"))
    with pytest.raises(ks.ParameterError, match=r"its value is in N, but that of its table in N\*m"):
        ks.solve(PUMP, TURN, crank_speed=1.0, loads=ks.ProcessForce(torque))


def test_csv_table_keeps_its_unit(tmp_path):
    path = tmp_path / "torque.csv"
    path.write_text("crank_angle [deg], torque [N m]\n0, 1\n120, 2\n240, 3\n")
    torque = ks.Table.from_csv(path, "N m")
    assert torque.unit == "N*m"
    with pytest.raises(ks.ParameterError, match=r"its value is in N, but that of its table in N\*m"):
        ks.solve(PUMP, TURN, crank_speed=1.0, loads=ks.Force(torque, at="B"))


@pytest.mark.parametrize("engine", ["numpy", pytest.param("compiled", marks=pytest.mark.slow)])
def test_load_functions_may_return_quantities(engine):
    if engine == "compiled":
        pytest.importorskip("numba")

    def torque(force):
        return ks.solve(PUMP, TURN, crank_speed=1.0, loads=ks.ProcessForce(force), engine=engine).balancing_torque

    kilo = torque(lambda motion: UNITS.Quantity(4.0 * np.cos(motion.crank_angle), "kN"))
    plain = torque(lambda motion: 4000.0 * np.cos(motion.crank_angle))
    np.testing.assert_allclose(kilo, plain, rtol=0.0, atol=1e-15 * np.abs(plain).max())
    with pytest.raises(ks.ParameterError, match=r"function returns must measure .* in N, got an array in kilogram"):
        torque(lambda motion: UNITS.Quantity(np.cos(motion.crank_angle), "kg"))


def test_function_with_a_registry_is_opaque():
    Quantity = UNITS.Quantity
    load = ks.ProcessForce(lambda motion: Quantity(4.0, "kN"))
    assert ks.solve(PUMP, 0.5, crank_speed=1.0, loads=load).balancing_torque != 0


def test_a_law_that_returns_quantities_is_refused():
    law = ks.laws.cosine(300.0, 2000.0)
    with pytest.raises(ks.ParameterError, match="law must give plain numbers"):
        ks.cams.from_law(lambda phi: tuple(UNITS.Quantity(part, "mm") for part in law(phi)))


def test_case_numbers_take_quantities():
    variant = ks.load_case("sawframe_2r63").variants["cam-circle"]
    numbers = {path: value for path, value in variant.parameters.items() if isinstance(value, float)}
    assert len(numbers) > 20
    for path, value in list(numbers.items())[::3]:
        told = variant.varied({path: measured(value, variant.units[path])})
        assert told.scene.parameters == variant.varied({path: value}).scene.parameters, path
        with pytest.raises(ks.ParameterError, match=r"which measures \[luminosity\]"):
            variant.varied({path: measured(value, "cd")})
