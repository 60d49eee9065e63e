"""Results that a change of the package's internals must keep: how they are computed, written, read and compared.

Public names and commands only, so that this module need not change with the internals.
`tests/references/make_kept.py` writes what `SUBJECTS` compute into `tests/data/kept`; `test_kept.py` computes it again.

A subject's results are a flat mapping from a path to an array, a number, a text, or a list of texts. The first part of
the path is the variant or the study, the second says how the result is compared (`RULES`), the rest what it is.
"""

import contextlib
import io
import json
import math
import os
import re
import shlex
import warnings
from functools import partial
from pathlib import Path
from typing import NamedTuple
from unittest import mock

import numpy as np
import pandas as pd

import kinetostatics as ks
from kinetostatics.cli import main

FOLDER = Path(__file__).parents[1] / "data" / "kept"
ANGLES, BOUNDED_ANGLES = 720, 36
SMALL = 32
"""Arrays of fewer numbers are written as text."""
SEP = "/"
ENERGIES = "reduced_inertia", "reduced_inertia_slope", "kinetic_energy", "potential_energy", "load_torque"
MEANS = "mean", "mean_absolute", "rms"
ULPS = 4
FLOOR = 1e-3
"""Share of a quantity's scale below which 4 ulp of a component are no longer asked for, but 4 ulp of this share."""
TABLE_LOADS, OTHER_PROCESSOR = 1e-13, 1e-14
"""Tolerances of values relative to the quantity's scale: with table loads, and where sines have other last bits."""
EXTREMES, SEARCHES, TRAJECTORIES = 1e-12, 1e-9, 1e-9
BESIDE = 1e-5
"""Tolerance of what a search neither aims at nor limits. Where the goal is flat, roundings of another processor move
the goal by 1e-9 and the rest by the root of that.
"""
SEARCHED = {"mower_drive": {"optimal"}, "comparisons": {"mower_drive optimal"}}
"""Variants whose counterweights a search finds: all their results are known as closely as that."""
NEAR, ANGLE = 1e-9, 1e-6
"""Relative difference of extrema that count as equally high, and difference of their crank angles, rad."""
LARGER_BOUND, TABLE_BOUND = 3.2, 1e-12
"""Factor on kept bounds, and with table loads the share of the largest value that a bound may be as well: the kept
ones are of a travel with more digits, whose rounding is now covered by the bound of its flank.
"""
ROUNDING = 1e-12
"""Size of printed and reduced numbers that are rounding errors only."""


# what is computed


def of_case(name, kinds=None):
    """Results of every variant of a shipped case, by default of all kinds."""
    found = {}
    for variant, made in ks.load_case(name).variants.items():
        for kind in kinds or (values, extremes, bounds):
            found |= _below(variant, kind(made.scene))
    return found


def values(scene, engine=None):
    """Quantities at even crank angles over the period, and their scales."""
    solution = scene.solve(ANGLES, engine=engine)
    frame = _quietly(solution.frame)
    columns = {column: frame[column].to_numpy() for column in frame if not column.startswith("crank_angle")}
    for joint in solution.mechanism.joints:
        columns |= _by_axis(f"{joint} acceleration", "m/s2", solution.acceleration(joint))
    for name in ENERGIES:
        columns[name] = np.broadcast_to(getattr(solution, name), solution.shape)
    moving = {column: row for column, row in columns.items() if np.any(row != row[0])}
    found = {f"values/{column}": row for column, row in moving.items()}
    found |= {f"still/{column}": float(row[0]) for column, row in columns.items() if column not in moving}
    return found | {f"scales/{unit}": size for unit, size in _scales(scene, solution).items()}


def _scales(scene, solution):
    """Sizes of what forces, moments and powers are sums of, by unit, and the period that rows are spread over.

    Where terms cancel, as in a balanced machine, the last bits of a sum are those of its terms.
    """
    arm = max(float(np.max(np.abs(solution.position(joint)))) for joint in solution.mechanism.joints)
    force, torque = float(solution.largest_force_term), float(solution.largest_torque_term)
    power = torque * abs(float(scene.crank_speed))
    return {"N": force, "N m": force * arm, "torque": torque, "W": power, "period": float(solution.period)}


def has_table_loads(scene):
    """Whether a load is given by the rows of a table."""
    return any(isinstance(value, ks.Table) for load in scene.loads for value in vars(load).values())


def extremes(scene):
    """Smallest and largest value over the period with their crank angles, and means."""
    solution = scene.solve(ANGLES)
    names = [*solution.scalars, *solution.reactions, "shaking_force", "shaking_moment", "kinetic_energy"]
    names += [f"slider{label}_{what}" for label in _sliders(solution) for what in ("position", "acceleration")]
    found, scales = {}, _scales(scene, solution)
    for name in names:
        turn = _quietly(ks.extremes, solution, name)
        size = max(map(abs, turn.range))
        scale = max(size, scales.get(_unit(solution, name), 0.0))
        found[f"sizes/{name}"] = float(scale)
        for which, end in zip(("smallest", "largest"), turn.range, strict=True):
            found[f"extremes/{which} {name}"] = float(end)
            near = np.abs(turn.value - end) <= NEAR * size
            if near.any() and size > ROUNDING * scale:
                found[f"angles/{which} {name}"] = turn.angle[near]
    found["extremes/energy_per_turn"] = float(solution.energy_per_turn)
    found["sizes/energy_per_turn"] = float(solution.largest_torque_term) * scales["period"]
    outputs = [f"{mean} {name}" for mean in MEANS for name in solution.scalars]
    design = pd.DataFrame({"crank_speed": [float(scene.crank_speed)]})
    table = _quietly(ks.sweep, scene, design, outputs, progress=False)
    columns = [column for column in table if column != "failed"][-len(outputs) :]
    found |= {f"extremes/{output}": float(table[column][0]) for output, column in zip(outputs, columns, strict=True)}
    return found


def _unit(solution, name):
    if name in solution.reactions or name == "shaking_force":
        return "N"
    if name in solution.scalars or name == "shaking_moment":
        return "torque" if "torque" in name else "N m" if "moment" in name else "N"
    return None


def bounds(scene):
    """Proven bounds on rounding errors, plain and tight, of torque and reactions, with the values enclosed by arb."""
    import flint

    solution = scene.solve(bounded_angles(scene))
    found = {f"bounds/{name} {way}": bound for name, way, _, bound in bounded_values(scene)}
    for name in ("balancing_torque", *solution.reactions):
        read = _read(solution, name)
        with flint.ctx.workprec(300):
            exact = ks.precision.enclosure(solution, name).exact
            high = np.array([[float(value) for value in row] for row in exact])
            low = [[float(value - float(value)) for value in row] for row in exact]
        found[f"exact/{name}"] = np.broadcast_to(high, read.shape)
        found[f"exact/{name} rest"] = np.broadcast_to(np.array(low), read.shape)
    return found


def bounded_angles(scene):
    """Crank angles at which bounds are kept: even, and away from those at which a link or a slider turns back."""
    period = float(scene.solve(1.0).period)
    return period * (np.arange(BOUNDED_ANGLES) + 0.37) / BOUNDED_ANGLES


def bounded_values(scene):
    """Values and bounds by name and way, to be compared with the enclosed ones that are kept."""
    solution = scene.solve(bounded_angles(scene))
    for name in ("balancing_torque", *solution.reactions):
        read = _read(solution, name)
        for way, tight in (("plain", False), ("tight", True)):
            yield name, way, read, np.reshape(solution.error_bound(name, tight=tight), read.shape)


def sweeps():
    """Tables of three sweeps: of a cam's machine, with friction, and with a load by a table."""
    asked = {
        "cam": (
            ("sawframe_2r63", "cam-circle"),
            {"spring.stiffness": "600..800 kN/m:4", "cam.centre.x": "-25..-15 mm:3"},
            ["ratio mean_absolute balancing_torque", "range cam_force", "largest O"],
        ),
        "friction": (
            ("sawframe_2r63_friction", "cam-cosine"),
            {"spring.stiffness": "650..750 kN/m:4"},
            ["mean balancing_torque", "largest O", "smallest cam_force", "mean friction_loss"],
        ),
        "table load": (
            ("compressor", "loaded"),
            {"crank_speed": "500..1500 rpm:5"},
            [
                "largest O",
                "largest_at O",
                "smallest guide_force",
                "harmonic_2 balancing_torque",
                "swing balancing_torque",
            ],
        ),
    }
    found = {}
    for study, ((case, variant), spreads, outputs) in asked.items():
        designs = ks.designs.grid(spreads)
        table = _quietly(ks.sweep, ks.load_case(case), designs, outputs, variant=variant, progress=False)
        found |= _of_table(study, "table", table)
    return found


def drives():
    """Runs under the motor of a case, flywheels, a start and a coast."""
    found, case = {}, ks.load_case("sawframe_2r63")
    numbers = (
        "mean_speed",
        "fluctuation",
        "fluctuation_arithmetic",
        "energy_per_turn",
        "mean_power",
        "rms_power",
        "peak_power",
    )
    for variant, made in case.variants.items():
        run = _quietly(ks.drive.steady, made.scene, made.motor, made.flywheel)
        found |= {f"{variant}/extremes/{name}": float(getattr(run, name)) for name in numbers}
        found |= {
            f"{variant}/extremes/{end}": float(value)
            for end, value in zip(("slowest", "fastest"), run.speed_range, strict=True)
        }
        found |= {f"{variant}/curves/{name}": getattr(run, name) for name in ("speed", "acceleration", "motor_torque")}
    made = case.variants["plain"]
    for motor in (None, made.motor):
        sized = ks.drive.flywheel(made.scene, 0.02, motor)
        found[f"flywheel {'of textbooks' if motor is None else 'under the motor'}/searched/inertia"] = float(
            sized.inertia
        )
    start = ks.drive.start(made.scene, made.motor, made.flywheel, from_angle=1.0)
    coast = ks.drive.coast(made.scene, made.flywheel, from_angle=0.5, from_speed=2.0, until=3.0)
    for study, motion in (("start", start), ("coast", coast)):
        times = np.linspace(0.0, motion.time[-1] * (1.0 - 1e-9), 50)
        found |= {f"{study}/motion/{name}": getattr(motion.at(times), name) for name in ("crank_angle", "speed")}
        found[f"{study}/texts/events"] = [event.name for event in motion.events]
        found[f"{study}/motion/times of events"] = np.array([event.time for event in motion.events])
    return found


def cams():
    """Working curves of three cams."""
    made = {
        "circle": ks.cams.Circle(0.3, (-0.02, 0.0)),
        "cosine law": ks.cams.CosineLaw(amplitude=0.3, mean=2.0),
        "harmonic": ks.cams.Harmonic(cosine=(0.3, -0.02, 0.003), sine=(0.001,)),
    }
    found = {}
    for name, cam in made.items():
        profile = cam.profile(0.05, 360)
        for curve in ("pitch", "surface", "normal", "pressure_angle", "curvature_radius"):
            rows = np.atleast_2d(getattr(profile, curve))
            found |= {
                f"{name}/curves/{curve} {axis}".rstrip(): row for axis, row in zip(_axes(rows), rows, strict=True)
            }
    return found


def designs():
    """Goals and active limits of small searches."""
    saw, mower = ks.load_case("sawframe_2r63"), ks.load_case("mower_drive").variants["unbalanced"].scene
    weight = ks.Counterweight(arm=-0.035)
    found = {}
    for norm in ("largest", "mean"):
        least = ks.balancing.optimal(mower.mechanism, norm, crank=weight)
        force = ks.extremes(ks.Scene(least.mechanism, mower.crank_speed).solve(360), "shaking_force")
        found[f"optimal counterweight, {norm}/searched/largest shaking force"] = float(force.largest)
        found[f"optimal counterweight, {norm}/searched/added mass"] = float(least.added_mass)
    optimised = _quietly(
        ks.design.optimise,
        saw,
        {"spring.stiffness": ("600 kN/m", "900 kN/m"), "cam.centre.x": ("-30 mm", "-10 mm")},
        maximise="ratio mean_absolute balancing_torque",
        limits=["smallest cam_force >= 8 kN"],
        variant="cam-circle",
    )
    free = _quietly(ks.design.torque_free_cam, saw, cosine=3)
    for study, design in (("optimise", optimised), ("torque-free cam", free)):
        report = design.report()
        for output, value in report["after"].items():
            named = output.partition(" [")[0].removeprefix("ratio ")
            kind = "searched" if any(named in text for text in (design.goal, *design.active)) else "beside"
            found[f"{study}/{kind}/{output}"] = float(value)
        found |= {f"{study}/texts/active": list(design.active), f"{study}/texts/goal": design.goal}
    return found


def certainty():
    """Standard uncertainties, and tolerances of a small sample."""
    found = {}
    for case, variant in (("sawframe_2r63", "cam-circle"), ("chain_unit", "rho-0.5"), ("compressor", "loaded")):
        solution = ks.load_case(case).variants[variant].scene.solve(ANGLES)
        for name in ("balancing_torque", "|O|"):
            sure = _quietly(solution.uncertainty, name, {"crank_speed": 0.01, "coupler.mass": 0.1})
            found[f"{case} {variant}/curves/{name}"] = np.asarray(sure.tolerance, dtype=float)
    study = ks.tolerances(
        ks.load_case("sawframe_2r63"),
        ["ratio mean_absolute balancing_torque"],
        {"spring.stiffness": "normal 673.8 kN/m +- 7 kN/m", "cam.centre.x": "normal -21.9 mm +- 0.5 mm"},
        variant="cam-circle",
        count=64,
        progress=False,
    )
    return found | _of_table("tolerances", "quantiles", study.quantiles())


def comparisons():
    """Tables that compare variants with the reference."""
    found = {}
    for name in ("sawframe_2r63", "sawframe_2r63_friction", "mower_drive", "pumpjack"):
        case = ks.load_case(name)
        for variant in case.variants:
            if variant != (reference := case.reference_of(variant)):
                solved = (case.solve(one) for one in (reference, variant))
                table = _quietly(lambda solved=solved: ks.compare(*solved).frame())
                found |= _of_table(f"{name} {variant}", "comparison", table)
    return found


COMMANDS = {
    "list": "list",
    "run_chain_unit": "run chain_unit",
    "run_compressor": "run compressor --variant loaded",
    "run_friction": "run sawframe_2r63_friction --variant cam-cosine",
    "run_v_twin": "run v_twin --variant firing",
    "compare_mower": "compare mower_drive",
    "compare_saw": "compare sawframe_2r63",
    "explain_saw": "explain sawframe_2r63 --variant cam-cosine --angle 39.3deg",
    "explain_shaper": "explain shaper --angle 70deg --quantity |O|",
    "drive_saw": "drive sawframe_2r63 --variant plain",
    "sweep_saw": "sweep sawframe_2r63 --variant cam-circle "
    "--vary 'spring.stiffness=600..800 kN/m:3' --output 'largest O'",
    "refused": "run sawframe_2r63 --variant plane",
}


def printed():
    """What commands print, 80 letters wide."""
    return {f"{name}/printed/": run_command(shlex.split(command)) for name, command in COMMANDS.items()}


def run_command(words):
    """What a command prints, then errors and the exit status, without the folder of the cases."""
    printed, errors = io.StringIO(), io.StringIO()
    with (
        mock.patch.dict(os.environ, {"COLUMNS": "80", "NO_COLOR": "1"}),
        contextlib.redirect_stdout(printed),
        contextlib.redirect_stderr(errors),
    ):
        status = main(words)
    folder = next(iter(ks.shipped_cases().values())).parent
    return f"{printed.getvalue()}{errors.getvalue()}exit status {status}\n".replace(f"{folder}{os.sep}", "")


def arithmetic():
    """Elementary functions, whose last bits are another processor's or NumPy's own."""
    angle = 2.0 * np.pi * np.arange(ANGLES) / ANGLES
    functions = {"sin": np.sin, "cos": np.cos, "arctan": np.arctan}
    return {f"functions/exactly/{name}": function(angle) for name, function in functions.items()}


def has_other_arithmetic():
    """Whether elementary functions here have other last bits than where results were kept."""
    kept = read("arithmetic")
    return any(not np.array_equal(kept[path], found) for path, found in arithmetic().items())


STUDIES = {
    "sweeps": sweeps,
    "drives": drives,
    "cams": cams,
    "designs": designs,
    "certainty": certainty,
    "comparisons": comparisons,
    "printed": printed,
}
LEFT_OUT = {"sawframe_2r63_ways", "sawframe_2r63_cutting", "mower_drives"}
"""Cases that came after the results were kept."""
CASES = [name for name in ks.shipped_cases() if name not in LEFT_OUT]
"""Cases whose results are kept; variants of those are built as those of others, or have tests by hand calculation."""
SUBJECTS = {name: partial(of_case, name) for name in CASES} | STUDIES | {"arithmetic": arithmetic}
"""By the name of its files, what computes the results of a subject."""


def _below(head, found):
    return {f"{head}{SEP}{path}": result for path, result in found.items()}


def _quietly(function, *given, **options):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return function(*given, **options)


def _axes(rows):
    return ("x", "y") if len(rows) == 2 else ("",)


def _by_axis(name, unit, vector):
    return {f"{name}_{axis} [{unit}]": row for axis, row in zip("xy", np.asarray(vector), strict=True)}


def _read(solution, name):
    return np.atleast_2d(solution.scalar(name) if name in solution.scalars else solution.reaction(name))


def _sliders(solution):
    return [link.removeprefix("slider") for link in solution.mechanism.links if link.startswith("slider")]


def _of_table(study, name, table):
    found = {}
    for column in table.columns:
        path = f"{name} {column}"
        if table[column].dtype.kind in "fi":
            found[f"{study}/table/{path}"] = table[column].to_numpy(float)
        else:
            found[f"{study}/texts/{path}"] = [str(cell) for cell in table[column]]
    return found | {f"{study}/texts/{name} rows": [str(row) for row in table.index]}


# files


def write(name, found):
    """Files of a subject: arrays, what is no array, and printed text; returns their paths."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    arrays = {path: result for path, result in found.items() if isinstance(result, np.ndarray) and result.size >= SMALL}
    texts = {path: result for path, result in found.items() if _kind(path) == "printed"}
    others = {path: result for path, result in found.items() if path not in arrays and path not in texts}
    others = {path: result.tolist() if isinstance(result, np.ndarray) else result for path, result in others.items()}
    written = []
    if arrays:
        written.append(FOLDER / f"{name}.npz")
        np.savez_compressed(written[-1], **arrays)
    if others:
        written.append(FOLDER / f"{name}.json")
        written[-1].write_text(json.dumps(others, indent=0, ensure_ascii=False) + "\n", encoding="utf-8")
    for path, text in texts.items():
        written.append(FOLDER / f"{path.split(SEP)[0]}.txt")
        written[-1].write_text(text, encoding="utf-8")
    return written


def read(name):
    """Kept results of a subject."""
    if name == "printed":
        texts = {one: (FOLDER / f"{one}.txt").read_text(encoding="utf-8") for one in COMMANDS}
        return {f"{one}/printed/": text for one, text in texts.items()}
    found = {}
    if (arrays := FOLDER / f"{name}.npz").exists():
        with np.load(arrays) as kept:
            found |= dict(kept)
    if (others := FOLDER / f"{name}.json").exists():
        found |= json.loads(others.read_text(encoding="utf-8"))
    return found


# comparison


class Difference(NamedTuple):
    """A result that is not as it was kept."""

    path: str
    place: str
    kept: object
    now: object
    allowed: object

    def __str__(self):
        variant, _, name = self.path.split(SEP, 2)
        kept, now = (f"{value!r}" if isinstance(value, str) else str(value) for value in (self.kept, self.now))
        return f"{variant}: {name or 'printed'}{self.place}: kept {kept}, now {now} (allowed: {self.allowed})"


def differences(kept, now, context):
    """All differences of results from kept ones, each with its place and both numbers."""
    kept = {path: result for path, result in kept.items() if _kind(path) not in ("exact", "bounds")}
    now = {path: result for path, result in now.items() if _kind(path) not in ("exact", "bounds")}
    for path in sorted(kept.keys() ^ now.keys()):
        here, there = path in kept, path in now
        yield Difference(path, "", "there" if here else "none", "there" if there else "none", "the same quantities")
    for path in sorted(kept.keys() & now.keys()):
        yield from RULES[_kind(path)](path, kept[path], now[path], context)


class Context(NamedTuple):
    """What tolerances depend on: all kept results of the subject, variants with table loads, and `SEARCHED` ones."""

    kept: dict
    tables: frozenset = frozenset()
    other_arithmetic: bool = False
    searched: frozenset = frozenset()

    def share(self, path, share):
        """Relative tolerance of a result."""
        return max(share, SEARCHES) if path.split(SEP)[0] in self.searched else share

    def scale(self, path, kept):
        """Size of what a quantity is a sum of: its own largest value, or for forces and moments the largest load."""
        variant, _, name = path.split(SEP, 2)
        unit = re.search(r"\[(.*)\]", name)
        own = float(np.nanmax(np.abs(kept), initial=0.0))
        known = "torque" if "torque" in name else unit[1] if unit else ""
        return max(own, self.kept.get(f"{variant}/scales/{known}", 0.0))


def _values(path, kept, now, context):
    scale = context.scale(path, kept)
    if path.split(SEP)[0] in context.tables:
        allowed, told = np.full(kept.shape, TABLE_LOADS * scale), f"{TABLE_LOADS:g} of {scale:.4g}"
    else:
        allowed = ULPS * np.spacing(np.maximum(np.abs(kept), FLOOR * scale))
        told = f"{ULPS} ulp, or of {FLOOR:g} of {scale:.4g}"
    share = context.share(path, OTHER_PROCESSOR if context.other_arithmetic else 0.0)
    if share:
        allowed, told = np.maximum(allowed, share * scale), f"{share:g} of {scale:.4g}"
    period = context.kept[f"{path.split(SEP)[0]}/scales/period"]
    yield from _within(path, kept, now, allowed, told, period)


def _within(path, kept, now, allowed, told, period=None):
    kept, now = np.asarray(kept, dtype=float), np.asarray(now, dtype=float)
    if kept.shape != now.shape:
        yield Difference(path, "", f"shape {kept.shape}", f"shape {now.shape}", "the same shape")
        return
    with np.errstate(invalid="ignore"):
        off = np.abs(now - kept)
        excess = np.where(
            (kept == now) | (np.isnan(kept) & np.isnan(now)), -np.inf, np.nan_to_num(off - allowed, nan=np.inf)
        )
    wrong = np.count_nonzero(excess > 0.0)
    if wrong:
        worst = np.unravel_index(np.argmax(excess), excess.shape)
        place = (
            f" at {np.degrees(worst[0] * period / kept.size):.6g} deg"
            if period
            else f" row {worst[0]}"
            if worst
            else ""
        )
        more = f", the worst of {wrong} of {kept.size}" if wrong > 1 else ""
        yield Difference(path, place + more, repr(float(kept[worst])), repr(float(now[worst])), told)


def _relative(share, path, kept, now, context):
    variant, _, name = path.split(SEP, 2)
    known = context.kept.get(f"{variant}/sizes/{name.split()[-1]}", 0.0)
    scale = max(known, float(np.nanmax(np.abs(kept), initial=0.0)))
    share = context.share(path, share)
    allowed = ANGLE if "_at " in name else share * scale
    yield from _within(path, kept, now, allowed, f"{share:g} of {scale:.4g}")


def _angles(path, kept, now, context):
    kept, now = np.atleast_1d(kept), np.atleast_1d(now)
    if (
        len(now) == 0
        or any(np.min(np.abs(np.sin((one - now) / 2))) > ANGLE / 2 for one in kept)
        or len(kept) != len(now)
    ):
        yield Difference(path, " at crank angles in rad", kept.tolist(), now.tolist(), f"{ANGLE:g} rad")


def _texts(path, kept, now, context):
    if kept != now:
        yield Difference(path, "", kept, now, "the same")


def _printed(path, kept, now, context):
    kept, now = kept.splitlines(), now.splitlines()
    if len(kept) != len(now):
        yield Difference(path, "", f"{len(kept)} lines", f"{len(now)} lines", "the same lines")
    for number, (one, other) in enumerate(zip(kept, now, strict=False), 1):
        if not same_text(one, other):
            yield Difference(
                path, f" line {number}", one, other, "the same words, numbers within one unit of the last place"
            )


RULES = {
    "values": _values,
    "still": partial(_relative, TABLE_LOADS),
    "scales": partial(_relative, TABLE_LOADS),
    "sizes": partial(_relative, EXTREMES),
    "extremes": partial(_relative, EXTREMES),
    "table": partial(_relative, EXTREMES),
    "curves": partial(_relative, EXTREMES),
    "searched": partial(_relative, SEARCHES),
    "beside": partial(_relative, BESIDE),
    "motion": partial(_relative, TRAJECTORIES),
    "angles": _angles,
    "texts": _texts,
    "printed": _printed,
}
"""How results of each kind are compared."""

NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?(?![\w])")


def same_text(kept, now):
    """Whether two lines have the same words, and numbers within one unit of the last place printed.

    Numbers of more than six digits are compared by six; rounding errors, which are below 1e-12, are equal. Spaces and
    rules may be of another length, as a number that ends in 0 is shorter by a letter.
    """
    words, others = (re.sub(r"([-=─ ])\1+", r"\1", NUMBER.sub("#", line)).strip() for line in (kept, now))
    numbers = [NUMBER.findall(line) for line in (kept, now)]
    return words == others and all(map(same_number, *numbers))


def same_number(kept, now):
    """Whether two printed numbers are within one unit of the last place of the longer one, as zeros at the end go."""
    one, other = float(kept), float(now)
    if max(abs(one), abs(other)) < ROUNDING:
        return True
    size = max(abs(one), abs(other))
    unit = max(10.0 ** (math.floor(math.log10(size)) - 5), min(_last_place(kept), _last_place(now)))
    return abs(one - other) <= 1.0000001 * unit


def _last_place(text):
    mantissa, _, power = text.lower().partition("e")
    return 10.0 ** (int(power or 0) - len(mantissa.partition(".")[2]))


def bound_problems(kept, variant, scene):
    """Bounds that are below the true error, or more than `LARGER_BOUND` times the kept ones."""
    angles, tables = np.degrees(bounded_angles(scene)), has_table_loads(scene)
    for name, way, value, bound in bounded_values(scene):
        exact, rest = (np.asarray(kept[f"{variant}/exact/{name}{end}"]) for end in ("", " rest"))
        error = np.abs((value - exact) - rest)
        before = np.asarray(kept[f"{variant}/bounds/{name} {way}"])
        most = np.maximum(LARGER_BOUND * before, TABLE_BOUND * np.abs(exact).max() if tables else 0.0)
        checks = {"the true error": error > bound, f"{LARGER_BOUND} times the kept bound": bound > most}
        for (meant, wrong), limit in zip(checks.items(), (error, most), strict=True):
            if not wrong.any():
                continue
            row, place = np.argwhere(wrong)[0]
            side = "below" if limit is error else "above"
            yield (
                f"{variant}: {way} bound of {name} (component {row}) at {angles[place]:.6g} deg: {bound[row, place]} "
                f"is {side} {meant}, {limit[row, place]}"
            )


def _kind(path):
    return path.split(SEP, 2)[1]
