"""Variant of a case file: its scene, the numbers of its table by path, its drive.

`NamedItems` are the variants or designs of a case by name, with an error for unknown names.
"""

import typing
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, is_dataclass
from operator import attrgetter
from pathlib import Path

import numpy as np

from ..design import balancing
from ..drive.motor import Motor
from ..errors import CaseError, DriveError
from ..numbers import checks
from ..numbers.files import find_on_disk
from ..numbers.formatting import normalise
from ..numbers.lazy import cached_property
from ..solution.scene import Scene
from ..solution.solution import Solution
from . import build
from .schema.variants import MechanismVariant


@dataclass(frozen=True, eq=False)
class Variant:
    """A scene of a case file with its table and its balancing: ``case.variants["plain"]``.

    Attributes
    ----------
    scene : Scene
    table : pydantic model
        Validated table from the file.
    balanced : Balanced or None
        Result of balancing by the counterweights of the file.
    folder : Path
        Folder of the case file.
    tabulated : mapping of keys to contents
        Contents of the files next to the case file: cams, tables. They are not read again.
    sizing : mapping of name to Part
        Parts of the case file, for limits and outputs such as "main_bearing.life_hours".

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.load_case("sawframe_2r63").variants["cam-circle"]
    >>> saw.parameters["slider.mass"], saw.units["slider.mass"]
    (600.0, 'kg')
    >>> heavier = saw.varied({"slider.mass": 620.0})  # its spring balances the slider, so it follows
    >>> round(heavier.loads[1].stiffness / saw.loads[1].stiffness, 6)
    1.033333
    """

    scene: Scene
    table: MechanismVariant = field(repr=False)
    balanced: balancing.Balanced | None = None
    folder: Path = field(default=Path(), repr=False)
    tabulated: Mapping[tuple[str | int, ...], typing.Any] = field(default_factory=dict, repr=False)
    sizing: Mapping[str, typing.Any] = field(default_factory=dict, repr=False)

    mechanism = property(attrgetter("scene.mechanism"), doc="Crank and groups.")
    loads = property(attrgetter("scene.loads"), doc="Loads, a tuple.")
    friction = property(attrgetter("scene.friction"), doc="Friction by joint.")
    crank_speed = property(attrgetter("scene.crank_speed"), doc="rad/s.")
    crank_acceleration = property(attrgetter("scene.crank_acceleration"), doc="rad/s2.")

    @cached_property
    def motor(self) -> Motor | None:
        """Motor of its drive, None if the file gives none."""
        if self.table.drive is None:
            return None
        return self.tabulated.get(("drive", "motor")) or self.table.drive.motor.motor

    @property
    def flywheel(self):
        """Flywheel of its drive, on the crank, kg m2; 0 if the file gives none."""
        return 0.0 if self.table.drive is None else self.table.drive.flywheel

    @property
    def raw_drive(self):
        """Table of its drive as in the file, with the whole path of a motor's file; None without a drive."""
        if self.table.drive is None:
            return None
        motor = self.table.drive.raw["motor"]
        if "file" in motor:
            motor = motor | {"file": str(self.folder / motor["file"])}
        return self.table.drive.raw | {"motor": motor}

    @cached_property
    def _places(self):
        return build.places_by_path(self.table)

    @property
    def units(self):
        """SI unit by path of every number in the file, defaults included: "slider.mass", "cam.centre.x".

        Numbers of the drive are excluded: solutions of a variant are at its crank speed.
        """
        return {path: place.unit for path, place in self._places.items()}

    @property
    def parameters(self):
        """Value in the file by path: a number in SI, or the word for a derived one, "mid-length"."""
        return {path: build.value_at(self.table, place.steps) for path, place in self._places.items()}

    @property
    def content(self):
        """Bytes of its table and files, the same in every session; without parts that do not affect solutions."""
        return self.table.model_dump_json(exclude={"drive", "reference"}).encode() + b"".join(
            _bytes(part) for keys, part in self.tabulated.items() if keys[0] != "drive"
        )

    def varied(self, values) -> "Variant":
        """Variant with other values at some paths of its file, in SI.

        Derived numbers follow: a centre at mid-length, a spring that balances the slider, the coupler of a cosine law,
        counterweights. Use ``scene.varied`` to vary a number and keep all others constant.

        Parameters
        ----------
        values : dict of path to float or array (designs, 1)
        """
        known = self._places
        checks.require("parameters", checks.mapping("values", values))
        checks.require("parameters", *(checks.choice("parameter", path, tuple(known)) for path in values))
        varied = build.with_values(self.table, {known[path].steps: value for path, value in values.items()})
        return make_variant(varied, self.folder, self.tabulated)

    @property
    def files(self):
        """Paths of the files it reads besides the case file, a list."""
        return [find_on_disk(self.folder / name) for _, _, name in build.named_files(self.table)]

    def solve(self, angles=720) -> Solution:
        """Solution at a number of even crank angles over the period of the loads, end excluded."""
        checks.require("solve", checks.count("angles", angles, size=checks.BYTES_PER_ANGLE))
        return self.scene.solve(angles)


def _bytes(item):
    """Bytes of the content of a file: arrays, and dataclasses of arrays."""
    if is_dataclass(item):
        return b"".join(_bytes(getattr(item, column.name)) for column in fields(item))
    return np.asarray(item).tobytes() if isinstance(item, np.ndarray) else repr(item).encode()


def run_under_motors(variants, from_angle=0.0, progress=iter):
    """Periodic running and start-up by the name of the variant, each under its own motor, and reasons for failures."""
    from ..drive.savings import speed_hint
    from ..drive.steady_running import steady
    from ..drive.transient import start_to

    runs: dict[str, typing.Any] = {}
    starts: dict[str, typing.Any] = {}
    reasons: dict[str, list[str]] = {}
    for name in progress(variants):
        variant = variants[name]
        system = variant.scene, variant.motor, variant.flywheel
        try:
            runs[name], starts[name] = steady(*system), None
            starts[name] = start_to(runs[name], *system, from_angle)
        except DriveError as error:
            reasons[name] = [str(error)]
        if name in runs and (doubt := speed_hint(runs[name], variant.scene)):
            reasons[name] = [doubt, *reasons.get(name, ())]
    return runs, starts, reasons


def make_variant(table, folder, tabulated):
    """Variant of a validated table."""
    scene, balanced = build.build_scene(table, tabulated)
    return Variant(scene, table, balanced, folder, tabulated)


class NamedItems(Mapping):
    """Items of a case by name, in any Unicode form; errors name their kind, "variant", and the path of the case."""

    def __init__(self, kind, path, items):
        self.kind, self.path, self._items = kind, path, dict(items)

    def __getitem__(self, name):
        problem = checks.choice(self.kind, normalise(name), tuple(self))
        if problem:
            raise NoSuchNameError(self.path, [problem])
        return self._items[normalise(name)]

    def __iter__(self):
        return iter(self._items)

    def __len__(self):
        return len(self._items)

    def __repr__(self):
        return repr(self._items)


class NoSuchNameError(CaseError, KeyError):
    """A case has no item of this name; it is a `KeyError` too."""

    __str__ = Exception.__str__
