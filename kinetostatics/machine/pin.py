"""Pin: a further joint fixed to a link, where more may hang: ternary links, second throws, articulated rods."""

from dataclasses import dataclass
from typing import Any, ClassVar

from ..numbers import checks
from ..numbers.planar import added
from .group import FRAME, Group, Point, Resolved
from .links import Joint, Link, LinkMotion, arm, first_at, present, second_at
from .placement import Course, Throw


def place(link: LinkMotion, along, across):
    """Joint of a link at so far along its direction and across it, to the left (kernel); None is zero."""
    lever = arm(link.direction, along, across)
    return Joint(added(link.joint.position, lever), first_at(link, lever), second_at(link, lever))


@dataclass(frozen=True, eq=False)
class Pin(checks.Checked, Group):
    """Joint `name` fixed to the link `on`: what hangs on it asks its force of that link, and its couple.

    It adds no link, no reaction and no condition of closure. Several groups may hang on one pin, each with a label of
    its own; each has its reaction there, and what they demand of the link adds up.

    Parameters
    ----------
    on : str
        Name of the link: the crank, or one that a group before it adds, as it is called with that group's label;
        "frame" for a fixed point.
    at : (along, across)
        From the link's reference joint (see `Link`) along its direction and across it, a quarter turn
        counter-clockwise, m; on the frame (x, y) from O.
    name : str

    Raises
    ------
    ParameterError
        A place that is not finite; the mechanism raises it where no part before the pin adds the link.

    Examples
    --------
    A connecting rod on the middle of the coupler of a four-bar:

    >>> import kinetostatics as ks
    >>> rod = ks.SliderGroup(0.5, ks.Guide.at(0.0, 0.1), on="C", pin="D", label="2")
    >>> bars = ks.RockerGroup(0.4, 0.3, (0.35, 0.1))
    >>> six_bar = ks.Mechanism("six-bar", ks.Crank(0.1), (bars, ks.Pin(on="coupler", at=(0.2, 0.05)), rod))
    >>> ks.solve(six_bar, 0.0, crank_speed=10.0).position("C").shape
    (2,)
    """

    on: str
    at: Any
    name: str = "C"

    TRUSTED = True
    PATHS: ClassVar = {"at": "pin_"}
    RULES = checks.Rules(
        "pin",
        on=checks.Name(),
        at=checks.Pair("m", parts=("along", "across")),
        name=checks.Name(),
    )

    @property
    def label(self):
        """Its name, so that paths of its numbers are its own: "pin_C.along"."""
        return self.name

    @property
    def hangs_on(self):
        return ()

    @property
    def links(self) -> dict[str, Link]:
        return {}

    @property
    def references(self) -> dict[str, str]:
        return {}

    @property
    def outputs(self):
        return {}

    @property
    def joints(self):
        return {self.name: Point(self.on, *self.at)}

    @property
    def throws(self):
        """Itself, if it is on the crank and not at O."""
        away = self.on == "crank" and any(present(part) is not None for part in self.at)
        return {self.name: Throw(self.at)} if away else {}

    @property
    def lengths(self):
        return self.at

    def place(self, placement):
        fixed = self.on == FRAME
        at = Joint(self.at, None, None) if fixed else place(placement.links[self.on], *map(present, self.at))
        placement.joints[self.name] = at
        placement.courses.update({name: Course(throw=throw) for name, throw in self.throws.items()})

    def follow(self, placement, joints):
        """Keep a joint that moves as it was found in another way."""
        if self.on == FRAME:
            self.place(placement)
        else:
            placement.joints[self.name] = joints[self.name]

    def closure(self, placement):
        return 1.0

    def requirement(self, placement):
        return "a pin closes wherever its link is"

    def resolve(self, placement, loads, along) -> Resolved:
        return Resolved({}, {}, {})
