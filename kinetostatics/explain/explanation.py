"""A hand calculation as data, text for the terminal, LaTeX, and HTML with MathML."""

import re
from dataclasses import dataclass
from html import escape
from itertools import groupby
from math import atan2, degrees, hypot, inf
from textwrap import wrap
from typing import Any, NamedTuple

import numpy as np

from ..numbers.lazy import cached_property
from .formats import format_number

WIDTH = 80
"""Number of characters in a line of text."""
NOTE = (
    "A prime is a derivative by the crank angle phi. Velocities are first derivatives times the crank speed omega, "
    "accelerations second ones times omega squared, and first ones times the crank acceleration alpha. Moments on a "
    "link are about its reference joint. Values stand to 6 digits, rounding as 0."
)
STYLE = (
    "<style>.explanation math{font-size:1.05em}.explanation p{margin:.5em 0 0 .75em;color:#555}"
    ".explanation .step{margin:.15em 0 .15em 1.5em;padding:.3em 0;overflow:auto hidden}"
    ".explanation h4{margin:1.2em 0 .2em}.explanation td{padding:0 1.2em 0 0}"
    ".explanation table{margin-left:1.5em;border-collapse:collapse}</style>"
)
POWERS = str.maketrans("23456789", "²³⁴⁵⁶⁷⁸⁹")
RAISED = r"(?<=[^\W\d_])\d"
"""Power in a unit such as "m/s2"."""


class Step(NamedTuple):
    """A step of a hand calculation.

    Attributes
    ----------
    title : str
        Heading: a link, a load, the forces on a part.
    words : str
        Description of the number; a given number has its path.
    symbol : str
    formula, numbers : str
        Formula in symbols of earlier steps, and with their values; "" for a given number.
    value : float
    unit : str
    shown : str
        The printed value: 6 digits, 0 where it is rounding.
    latex, mathml : tuple of str
        Symbol, formula, numbers and value.
    """

    title: str
    words: str
    symbol: str
    formula: str
    numbers: str
    value: float
    unit: str
    shown: str
    latex: tuple[str, ...]
    mathml: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class Explanation:
    """A hand calculation from `Solution.explain`; ``print`` shows it as text, notebooks as a page.

    Attributes
    ----------
    mechanism, quantity, label : str
        Names; `label` describes the quantity in words.
    angle : float
        Crank angle, rad.
    steps : tuple of Step
    results : tuple of Step
        The last steps, which give the quantity or its components.
    value : float or array (2,)
        The quantity of the solution, to rounding.
    unit : str

    Examples
    --------
    >>> import kinetostatics as ks
    >>> s = ks.Scene(ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0)), 100.0).solve(4)
    >>> explanation = s.explain("balancing_torque", 0.5)
    >>> round(float(explanation.value), 6), explanation.unit
    (14.875291, 'N m')
    """

    mechanism: str
    quantity: str
    label: str
    angle: float
    steps: tuple[Step, ...]
    results: tuple[Step, ...]
    value: Any
    unit: str

    @property
    def title(self):
        """Mechanism, quantity and crank angle."""
        angle = f"{format_number(self.angle)} rad = {format_number(degrees(self.angle))} deg"
        return f"{self.mechanism}: {self.label} at crank angle {angle}"

    @property
    def conclusion(self):
        """The quantity and its value, for a vector also the magnitude."""
        values = [step.shown for step in self.results] or [format_number(float(part)) for part in np.ravel(self.value)]
        if np.ndim(self.value):
            unit = "" if self.unit == "1" else f" {self.unit}"
            size = format_number(hypot(*self.value))
            return f"{self.quantity} = ({', '.join(values)}){unit}, magnitude {size}{unit}"
        return f"{self.quantity} = {_with_unit(values[-1], self.value, self.unit)}"

    @cached_property
    def text(self):
        """The calculation in lines of 80 characters."""
        found = [*wrap(self.title, WIDTH), "", *wrap(NOTE, WIDTH)]
        for title, steps, groups in self._sections:
            found += ["", title]
            if not steps[0].formula:
                rows = [(step.symbol, _with_unit(step.shown, step.value, step.unit), step.words) for step in steps]
                first, second = (max(len(row[place]) for row in rows) for place in (0, 1))
                indent = " " * min(first + second + 7, WIDTH // 2)
                for symbol, value, words in rows:
                    row = f"  {symbol:{first}} = {value:{second}}  {words}"
                    found += wrap(row, WIDTH, subsequent_indent=indent)
                continue
            for head, group in groups:
                found += wrap(head, WIDTH, initial_indent="  ", subsequent_indent="    ") if head else []
                for step in group:
                    found += _text_lines(step)
        return "\n".join([*found, "", *wrap(self.conclusion, WIDTH)])

    @cached_property
    def latex(self):
        """The calculation for a LaTeX document with amsmath: paragraphs and aligned equations."""
        found = [rf"\section*{{{_latex_words(self.title)}}}", _latex_words(NOTE)]
        for title, steps, _ in self._sections:
            found += [rf"\paragraph{{{_latex_words(title)}}}", r"\begin{align*}"]
            rows = []
            for step in steps:
                symbol, formula, numbers, value = step.latex
                if step.unit != "1":
                    unit = re.sub(RAISED, r"^{\g<0>}", step.unit).replace(" ", r"\,")
                    value += rf"\,\mathrm{{{unit}}}"
                parts = _right_sides(step, formula, numbers, value) if formula else [value]
                rows.append(f"{symbol} &= {' = '.join(parts)}")
            found += [" \\\\\n".join(rows), r"\end{align*}"]
        return "\n".join([*found, _latex_words(self.conclusion)])

    @cached_property
    def html(self):
        """The calculation as a piece of HTML, formulas as MathML; it needs no other files."""
        found = [f'<div class="explanation">{STYLE}<h3>{escape(self.title)}</h3>', f"<p>{escape(NOTE)}</p>"]
        for title, steps, groups in self._sections:
            found.append(f"<h4>{escape(title)}</h4>")
            if not steps[0].formula:
                found.append("<table>")
                for step in steps:
                    cells = _math(step.mathml[0]), _math(f"<mo>=</mo>{_mathml_value(step)}"), escape(step.words)
                    found.append(f"<tr>{''.join(f'<td>{cell}</td>' for cell in cells)}</tr>")
                found.append("</table>")
                continue
            for head, group in groups:
                found += [f"<p>{escape(head)}</p>"] if head else []
                for step in group:
                    symbol, formula, numbers, _ = step.mathml
                    parts = _right_sides(step, formula, numbers, _mathml_value(step))
                    sides = " ".join(_math(f"<mo>=</mo>{part}") for part in parts)
                    found.append(f'<div class="step">{_math(symbol)} {sides}</div>')
        return "\n".join([*found, f"<p><strong>{escape(self.conclusion)}</strong></p></div>"])

    @property
    def page(self):
        """The calculation as a complete HTML page."""
        head = f'<meta charset="utf-8"><title>{escape(self.title)}</title>'
        return f'<!DOCTYPE html>\n<html lang="en"><head>{head}</head><body>\n{self.html}\n</body></html>'

    @property
    def _sections(self):
        """Headings, each with its steps, and with pairs of words and the steps that share them."""
        for title, found in groupby(self.steps, key=lambda step: step.title):
            steps, groups = list(found), []
            for words, alike in groupby(steps, key=lambda step: step.words):
                group = list(alike)
                if words.startswith("unit vector") and len(group) == 2:
                    words += f", at {format_number(degrees(atan2(group[1].value, group[0].value)))} deg"
                groups.append((words, group))
            yield title, steps, groups

    def __str__(self):
        return self.text

    def __repr__(self):
        return f"<Explanation: {self.title}, {len(self.steps)} steps; print it>"

    def _repr_html_(self):
        return self.html

    def _repr_latex_(self):
        return self.latex


def _right_sides(step, formula, numbers, value):
    """Parts after the equality signs; numbers that repeat the value are left out."""
    return [formula, value] if step.numbers.strip("()") == step.shown else [formula, numbers, value]


# Text


def _with_unit(shown, value, unit):
    angle = f" = {format_number(degrees(value))} deg" if unit == "rad" else ""
    return f"{shown}{'' if unit == '1' else f' {unit}'}{angle}"


def _text_lines(step):
    """Lines of a step: one if it fits."""
    value = _with_unit(step.shown, step.value, step.unit)
    parts = _right_sides(step, step.formula, step.numbers, value)
    whole = f"    {step.symbol} = {' = '.join(parts)}"
    if len(whole) <= WIDTH:
        return [whole]
    indent = " " * min(len(step.symbol) + 5, 24)
    found = []
    for place, part in enumerate(parts):
        line = (f"    {step.symbol} = " if place == 0 else f"{indent}= ") + part
        while len(line) > WIDTH and (end := _break(line, len(indent) + 4)):
            found.append(line[:end].rstrip())
            line = f"{indent}    {line[end:].lstrip()}"
        found.append(line)
    return found


def _break(line, start):
    """Place of a line break: before a sum's sign or after a product's, outside as many brackets as possible."""
    found, depth = [(-inf, 0)], 0
    for place, sign in enumerate(line[: WIDTH + 1]):
        depth += (sign == "(") - (sign == ")")
        if place > start + 4 and line[place : place + 3] in (" + ", " - "):
            found.append((-2 * depth, place))
        elif place > start + 4 and sign in "*/" and place < WIDTH:
            found.append((-2 * depth - 1, place + 1))
    return max(found)[1]


# LaTeX


def _latex_words(words):
    for sign in "\\&%$#_{}":
        words = words.replace(sign, f"\\{sign}")
    return words


# HTML


def _math(inner):
    return f'<math displaystyle="true"><mrow>{inner}</mrow></math>'


def _mathml_value(step):
    raised = escape(re.sub(RAISED, lambda digit: digit[0].translate(POWERS), step.unit))
    unit = "" if step.unit == "1" else f'<mspace width="0.25em"/><mtext>{raised}</mtext>'
    angle = f"<mo>=</mo><mn>{format_number(degrees(step.value))}</mn><mtext>°</mtext>" if step.unit == "rad" else ""
    return f"{step.mathml[3]}{unit}{angle}"
