"""Which everyday mechanism it is, read off its bars, joints and guides: four-bar, crank-slider, or neither."""

from typing import Any, NamedTuple

from ..machine.group import FRAME, Bar


class FourBar(NamedTuple):
    """Crank and coupler in a row, rocker from its fixed pivot (x, y) to where the coupler ends."""

    crank: Bar
    coupler: Bar
    rocker: Bar
    pivot: tuple[Any, Any]


class CrankSlider(NamedTuple):
    """Crank and coupler in a row to a slider on a guide."""

    crank: Bar
    coupler: Bar
    slider: str


def four_bar(mechanism) -> FourBar | None:
    """The bars of a four-bar; None for any other mechanism."""
    bars = mechanism.bars
    if len(mechanism.groups) != 1 or len(bars) != 3 or mechanism.guides:
        return None
    crank, coupler, rocker = bars
    start = mechanism.joints[rocker.start]
    if coupler.start != crank.end or rocker.end != coupler.end or start.link != FRAME:
        return None
    return FourBar(crank, coupler, rocker, (start.along, start.across))


def crank_sliders(mechanism) -> tuple[CrankSlider, ...]:
    """Chains of crank, coupler and slider in a mechanism, as many as couplers lead from the crank to sliders."""
    joints, bars = mechanism.joints, mechanism.crank.bars
    return tuple(
        CrankSlider(crank, bar, joints[bar.end].link)
        for crank in bars
        for bar in mechanism.couplers
        if bar.start == crank.end and joints[bar.end].link in mechanism.guides
    )
