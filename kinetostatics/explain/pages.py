"""How a hand calculation is set: as text for the terminal, LaTeX, and HTML with MathML."""

from html import escape
from itertools import groupby
from math import atan2, degrees
from textwrap import wrap

from .formats import format_number

WIDTH = 80
NOTE = (
    "A prime is a derivative by the crank angle phi: velocities are first derivatives times the crank speed omega, "
    "accelerations second ones times omega squared, and first ones times the crank acceleration alpha. Moments on a "
    "link are about its reference joint. Values stand to 6 digits, rounding as 0."
)
STYLE = (
    "<style>.explanation math{font-size:1.05em}.explanation p{margin:.5em 0 0 .75em;color:#555}"
    ".explanation .step{margin:.15em 0 .15em 1.5em;padding:.3em 0;overflow:auto hidden}"
    ".explanation h4{margin:1.2em 0 .2em}.explanation td{padding:0 1.2em 0 0}"
    ".explanation table{margin-left:1.5em;border-collapse:collapse}</style>"
)


def text(made):
    """Lines of 80 characters."""
    found = [*wrap(made.title, WIDTH), "", *wrap(NOTE, WIDTH)]
    for title, steps in _sections(made):
        found += ["", title]
        if not steps[0].formula:
            found += _table(steps)
            continue
        for words, alike in _alike(steps):
            head = _head(words, alike)
            found += wrap(head, WIDTH, initial_indent="  ", subsequent_indent="    ") if head else []
            for step in alike:
                found += _set(step)
    return "\n".join([*found, "", *wrap(made.conclusion, WIDTH)])


def _sections(made):
    """Headings, each with its steps."""
    return [(title, list(steps)) for title, steps in groupby(made.steps, key=lambda step: step.title)]


def _alike(steps):
    """Words, each with the steps that they stand over."""
    return [(words, list(alike)) for words, alike in groupby(steps, key=lambda step: step.words)]


def _head(words, steps):
    """What some steps have in common, and of a unit vector where it points to."""
    if words.startswith("unit vector") and len(steps) == 2:
        return f"{words}, at {format_number(degrees(atan2(steps[1].value, steps[0].value)))} deg"
    return words


def _value(step):
    unit = "" if step.unit == "1" else f" {step.unit}"
    angle = f" = {format_number(degrees(step.value))} deg" if step.unit == "rad" else ""
    return f"{step.shown}{unit}{angle}"


def _table(steps):
    rows = [(step.symbol, _value(step), step.words) for step in steps]
    first, second = (max(len(row[place]) for row in rows) for place in (0, 1))
    indent = " " * min(first + second + 7, WIDTH // 2)
    return [
        line
        for symbol, value, words in rows
        for line in wrap(f"  {symbol:{first}} = {value:{second}}  {words}", WIDTH, subsequent_indent=indent)
    ]


def _set(step):
    """Lines of a step: one if it fits."""
    parts = _parts(step, step.formula, step.numbers, _value(step))
    whole = f"    {step.symbol} = {' = '.join(parts)}"
    if len(whole) <= WIDTH:
        return [whole]
    indent = " " * min(len(step.symbol) + 5, 24)
    found = []
    for place, part in enumerate(parts):
        start = f"    {step.symbol} = " if place == 0 else f"{indent}= "
        found += _broken(start + part, indent + "    ")
    return found


def _parts(step, formula, numbers, value):
    """What stands behind the signs of equality: numbers are left out where they say no more than the value."""
    return [formula, value] if step.numbers.strip("()") == step.shown else [formula, numbers, value]


def _broken(line, indent):
    """A formula over as many lines as it takes, broken where it is held together least."""
    while len(line) > WIDTH:
        place = _break(line, len(indent))
        if not place:
            break
        yield line[:place].rstrip()
        line = indent + line[place:].lstrip()
    yield line


def _break(line, start):
    """Where to break a line: before a sum's sign or after a product's, outside of as many brackets as possible."""
    found, depth = (0, 0), 0
    for place, sign in enumerate(line[: WIDTH + 1]):
        depth += (sign == "(") - (sign == ")")
        if place <= start + 4:
            continue
        if line[place : place + 3] in (" + ", " - "):
            found = max(found, (-2 * depth, place)) if found[1] else (-2 * depth, place)
        elif sign in "*/" and place < WIDTH:
            found = max(found, (-2 * depth - 1, place + 1)) if found[1] else (-2 * depth - 1, place + 1)
    return found[1]


def latex(made):
    """Paragraphs and aligned equations."""
    found = [rf"\section*{{{_plain(made.title)}}}", _plain(NOTE)]
    for title, steps in _sections(made):
        found.append(rf"\paragraph{{{_plain(title)}}}")
        found.append(r"\begin{align*}")
        rows = []
        for step in steps:
            symbol, formula, numbers, value = step.latex
            unit = "" if step.unit == "1" else rf"\,\mathrm{{{_latex_unit(step.unit)}}}"
            parts = _parts(step, formula, numbers, value + unit) if formula else [value + unit]
            rows.append(f"{symbol} &= {' = '.join(parts)}")
        found += [" \\\\\n".join(rows), r"\end{align*}"]
    return "\n".join([*found, _plain(made.conclusion)])


def _plain(words):
    for sign in "\\&%$#_{}":
        words = words.replace(sign, f"\\{sign}")
    return words


def _latex_unit(unit):
    return _with_powers(unit, "^{{{}}}").replace(" ", r"\,")


def _with_powers(unit, form):
    """A unit such as m/s2 with its powers set in a form."""
    found = ""
    for place, sign in enumerate(unit):
        raised = sign.isdigit() and place and unit[place - 1].isalpha()
        found += form.format(sign) if raised else sign
    return found


def html(made):
    """A heading, and sections of words and formulas."""
    found = [f'<div class="explanation">{STYLE}<h3>{escape(made.title)}</h3>', f"<p>{escape(NOTE)}</p>"]
    for title, steps in _sections(made):
        found.append(f"<h4>{escape(title)}</h4>")
        if not steps[0].formula:
            found.append("<table>")
            found += [
                f"<tr><td>{_math(step.mathml[0])}</td><td>{_math(f'<mo>=</mo>{_mathml_value(step)}')}</td>"
                f"<td>{escape(step.words)}</td></tr>"
                for step in steps
            ]
            found.append("</table>")
            continue
        for words, alike in _alike(steps):
            head = _head(words, alike)
            found += [f"<p>{escape(head)}</p>"] if head else []
            for step in alike:
                symbol, formula, numbers, _ = step.mathml
                parts = _parts(step, formula, numbers, _mathml_value(step))
                sides = " ".join(_math(f"<mo>=</mo>{part}") for part in parts)
                found.append(f'<div class="step">{_math(symbol)} {sides}</div>')
    return "\n".join([*found, f"<p><strong>{escape(made.conclusion)}</strong></p></div>"])


def whole_page(made):
    """A whole page of HTML."""
    head = f'<meta charset="utf-8"><title>{escape(made.title)}</title>'
    return f'<!DOCTYPE html>\n<html lang="en"><head>{head}</head><body>\n{html(made)}\n</body></html>'


def _math(inner):
    return f'<math displaystyle="true"><mrow>{inner}</mrow></math>'


def _mathml_value(step):
    unit = "" if step.unit == "1" else f'<mspace width="0.25em"/><mtext>{_unit_text(step.unit)}</mtext>'
    angle = f"<mo>=</mo><mn>{format_number(degrees(step.value))}</mn><mtext>°</mtext>" if step.unit == "rad" else ""
    return f"{step.mathml[3]}{unit}{angle}"


POWERS = str.maketrans("23456789", "²³⁴⁵⁶⁷⁸⁹")


def _unit_text(unit):
    return escape(
        "".join(
            sign.translate(POWERS) if place and unit[place - 1].isalpha() else sign for place, sign in enumerate(unit)
        )
    )
