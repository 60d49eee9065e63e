"""The drawings of the theory: python docs/draw_theory.py [NAME ...]. Without names all are drawn, into docs/theory."""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from pictures import as_svg, look

import kinetostatics as ks
from kinetostatics.machine.friction import Sliding, Turning
from kinetostatics.mechanics.motion import Motion
from kinetostatics.views import strokes
from kinetostatics.views.canvas import ACCENT, INK, LOAD, STEEL
from kinetostatics.views.drawings import LINES, PIVOT, PLATES
from kinetostatics.views.sizing import draw_spring
from kinetostatics.views.strokes import Shape

FOLDER = Path(__file__).parent / "theory"
TURN = np.radians(np.arange(720) / 2)
SHAFT = {"arrowstyle": "-|>", "shrinkA": 0, "shrinkB": 0, "mutation_scale": 11, "lw": 1.4}


# Bodies apart, with what acts on each


def forces(solution):
    """By link: what acts on it, each (text, point, vector, whether it is the library's own value or its opposite)."""
    made, found = solution.mechanism, {name: [] for name in solution.mechanism.links}
    for name, pair in made.pairs.items():
        point, against = solution.position(pair.joint)[:, 0], getattr(pair, "against", "frame")
        if isinstance(pair, Turning) or (name in made.outputs and made.outputs[name].vector):
            force = solution.reaction(name)[:, 0]
            text = name
        else:
            text = pair.force
            force = solution.scalar(text)[0] * _along(solution, pair)
            if text == "cylinder_force":
                point = solution.position(made.references[against])[:, 0]
        found[pair.link].append((text, point, force, True))
        if against != "frame":
            found[against].append(("-" + text, point, -force, False))
    return found


def _along(solution, pair):
    """Unit vector along which the force of a pair counts."""
    if not isinstance(pair, Sliding):  # a roller: inward normal of its path
        velocity = solution.velocity(pair.joint)[:, 0]
        return strokes.left(velocity / np.hypot(*velocity))
    if pair.against in solution.mechanism.guides:  # a yoke: left normal of its slot
        return strokes.left(np.array(solution.placement.links[pair.link].direction, dtype=float).reshape(2))
    return strokes.left(np.array(solution.placement.links[pair.against].direction, dtype=float).reshape(2))


def lines(solution, shape, name):
    """One link as it is drawn in a mechanism: each (style, points)."""
    made = solution.mechanism
    place, turn = solution.position(made.references[name])[:, 0], np.ravel(solution.placement.links[name].direction)

    def put(points):
        return place[:, None] + np.outer(turn, points[0]) + np.outer(strokes.left(turn), points[1])

    corners = shape.corners[name]
    if corners.shape[1] > 1 and name != "cylinder":
        yield LINES["bar"], put(corners[:, np.argsort(corners[0])[[0, -1]]])
    for slot, ends in shape.slots:
        if slot.link == name and not slot.rod:
            yield LINES["slotted"], put(ends)
            yield LINES["slot"], put(ends)
    if name in ("rod", "cylinder"):
        reach = solution.measure("cylinder_length")[0]
        yield LINES["bar" if name == "rod" else "slotted"], put(np.array([[0.0, 0.7 * reach], [0.0, 0.0]]))
    if name in made.guides or name == "block":
        size = shape.half_block * (1.0 if name in made.guides else 0.8)
        yield PLATES["block"], place[:, None] + _box(turn, size)


def _box(turn, size):
    return size * (np.outer(turn, strokes.RECTANGLE[:, 0]) + np.outer(strokes.left(turn), strokes.RECTANGLE[:, 1]))


def arrow(ax, start, tip, text, colour=ACCENT, own=True, tail=False):
    """A force, its name at the tip or the tail: whole for what the library calls so, dashed for its opposite."""
    line = {**SHAFT, "color": colour, "ls": "-" if own else (0, (3, 2))}
    ax.annotate("", tip, start, arrowprops=line, zorder=6)
    ax.update_datalim([start, tip])
    away = np.subtract(start, tip) if tail else np.subtract(tip, start)
    ax.annotate(
        text.replace("-", "\N{MINUS SIGN}"),
        start if tail else tip,
        (9.0 + 1.6 * len(text) * abs(away[0]) / np.hypot(*away)) * away / np.hypot(*away),
        textcoords="offset points",
        ha="center",
        va="center",
        color=colour,
        fontsize="small",
        zorder=7,
    )


def apart(solution, link, place, degrees, gap=0.36):
    """Bodies of a mechanism side by side, each with the forces on it; the load on a link at a place of it."""
    acting, made = forces(solution), solution.mechanism
    shape = Shape(Motion(made, TURN, 0.0, 0.0))
    largest = max(np.hypot(*force) for some in acting.values() for _, _, force, _ in some)
    scale = 0.35 * shape.size / largest
    figure, ax = plt.subplots()
    reached = top = 0.0
    names: list = []
    for name, some in acting.items():
        drawn = list(lines(solution, shape, name))
        middle = np.mean(np.concatenate([points for _, points in drawn], axis=1), axis=1)
        arrows = []
        for text, point, force, own in some:
            vector = scale * force
            pushes = vector @ (middle - point) > 1e-3 * shape.size * np.hypot(*vector)
            if np.hypot(*force) > 1e-9 * largest:
                arrows.append((point - vector * pushes, point + vector * (not pushes), text, ACCENT, own, pushes))
        if name == link:
            point = solution.position((link, *place))[:, 0]
            arrows.append((point, point + 0.25 * shape.size * _unit(degrees), "load", LOAD, True, False))
        if name == "crank":
            sense = np.sign(solution.balancing_torque[0])
            level = np.array([[1.0], [0.0]])
            ring = strokes.place_symbol(strokes.COUPLE, np.zeros((2, 1)), level, 1.8 * shape.half_block, sense)[..., 0]
            drawn.append(({"color": LOAD, "lw": 1.4}, ring))
        corners = [points for _, points in drawn] + [np.column_stack(item[:2]) for item in arrows]
        low, high = (np.nanmax(np.sign(way) * np.concatenate(corners, axis=1), axis=1) for way in (-1, 1))
        shift = np.array([reached + low[0], (low[1] - high[1]) / 2])
        reached += low[0] + high[0] + gap * shape.size
        names.append((shift[0] + (high[0] - low[0]) / 2, name))
        top = max(top, (low[1] + high[1]) / 2)
        for style, points in drawn:
            points = points + shift[:, None]
            ax.fill(*points, **style) if "fc" in style else ax.plot(*points, **style)
        for start, tip, *rest in arrows:
            arrow(ax, start + shift, tip + shift, *rest)
        for _, point, *_ in some:
            ax.plot(*(point + shift), "o", ms=4, mfc="white", mec=INK, zorder=8)
        if name == "crank":
            ax.annotate("M", shift, (-18, 8), textcoords="offset points", color=LOAD, fontsize="small", ha="right")
    for place, name in names:
        ax.annotate(name, (place, top), (0, 16), textcoords="offset points", ha="center", style="italic")
    ax.set_aspect("equal", adjustable="datalim")
    ax.autoscale_view()
    ax.margins(0.08)
    ax.axis("off")
    return figure


POSE = np.radians([50.0])


def _unit(degrees):
    return np.array([np.cos(np.radians(degrees)), np.sin(np.radians(degrees))])


def crank_slider():
    """Crank-slider on an inclined guide."""
    machine = ks.crank_slider(0.1, 0.25, guide_angle=np.radians(10))
    s = ks.solve(machine, POSE, crank_speed=1.0, loads=[ks.ProcessForce(-500.0)])
    return apart(s, "slider", (0.0, 0.0), 190, gap=0.45)


def four_bar():
    """Four-bar with a force on its rocker."""
    machine = ks.four_bar(0.1, 0.25, 0.18, rocker_pivot=(0.25, -0.02))
    s = ks.solve(
        machine, POSE, crank_speed=1.0, loads=[ks.Force(300.0, at=("rocker", 0.1, 0.0), direction=np.radians(200))]
    )
    return apart(s, "rocker", (0.1, 0.0), 200)


def lever():
    """Slotted lever with a force on it."""
    machine = ks.slotted_lever(0.1, pivot=(0.0, -0.2))
    s = ks.solve(machine, POSE, crank_speed=1.0, loads=[ks.Force(-300.0, at=("lever", 0.12, 0.0))])
    return apart(s, "lever", (0.12, 0.0), 180)


def cylinder():
    """Swinging cylinder with a force on it."""
    machine = ks.Mechanism("swinging cylinder", ks.Crank(0.1), (ks.CylinderGroup((0.3, -0.1)),))
    s = ks.solve(
        machine, POSE, crank_speed=1.0, loads=[ks.Force(300.0, at=("cylinder", 0.1, 0.0), direction=np.radians(-90))]
    )
    return apart(s, "cylinder", (0.1, 0.0), -90)


def yoke():
    """Scotch yoke with an inclined slot."""
    machine = ks.Mechanism("yoke", ks.Crank(0.1), (ks.YokeGroup(ks.Guide.at(0.0), slot_angle=np.radians(75)),))
    s = ks.solve(machine, POSE, crank_speed=1.0, loads=[ks.ProcessForce(-500.0)])
    return apart(s, "slider", (0.0, 0.0), 180, gap=0.8)


def cam_roller():
    """Cam-guided crank-slider."""
    machine = ks.cam_crank_slider(ks.cams.Circle(0.1, (-0.05, -0.02)), 0.28)
    s = ks.solve(machine, POSE, crank_speed=1.0, loads=[ks.ProcessForce(-500.0)])
    return apart(s, "slider", (0.0, 0.0), 180)


# Frames


def angle_mark(ax, centre, radius, start, end, text, colour=INK, place=1.25):
    """An arc with an arrow from one angle to another, rad."""
    turn = np.linspace(start, end, 60)
    ax.plot(centre[0] + radius * np.cos(turn), centre[1] + radius * np.sin(turn), color=colour, lw=0.9)
    tip = centre + radius * np.array([np.cos(end), np.sin(end)])
    before = centre + radius * np.array([np.cos(turn[-6]), np.sin(turn[-6])])
    ax.annotate("", tip, before, arrowprops={**SHAFT, "color": colour, "lw": 0.9, "mutation_scale": 8})
    middle = centre + place * radius * np.array([np.cos((start + end) / 2), np.sin((start + end) / 2)])
    ax.text(*middle, text, color=colour, ha="center", va="center")


def signs():
    """Crank angle, guide with its direction and normal, axes of links, senses of torque and rates."""
    lean, offset = np.radians(12.0), -0.045
    machine = ks.crank_slider(0.1, 0.28, guide_angle=lean, guide_offset=offset)
    phi = np.radians(62.0)
    s = ks.solve(machine, [phi], crank_speed=1.0)
    u = np.array([np.cos(lean), np.sin(lean)])
    n = strokes.left(u)
    a, b = (s.position(name)[:, 0] for name in "AB")
    figure, ax = plt.subplots()
    for way, text in ((np.array([0.4, 0.0]), "x"), (np.array([0.0, 0.16]), "y")):
        ax.annotate("", way, (0, 0), arrowprops={**SHAFT, "color": INK, "lw": 0.8, "mutation_scale": 9})
        ax.text(*(1.06 * way), text, ha="center", va="center")
    foot = offset * n
    rail = strokes.hatched_line(foot + 0.1 * u - 0.011 * n, foot + 0.42 * u - 0.011 * n, 0.008)
    ax.plot(*rail, color=INK, lw=0.8, alpha=0.6)
    ax.plot(*np.stack([foot - 0.03 * u, foot + 0.36 * u], axis=1), color=INK, lw=0.6, ls="-.")
    for start, end in (((0.0, 0.0), a), (a, b)):
        ax.plot(*np.stack([start, end], axis=1), **LINES["bar"])
    ax.fill(*(b[:, None] + _box(u, 0.016)), **PLATES["block"])
    ax.plot(0, 0, marker=PIVOT, ms=18, mfc="0.85", mec=INK, mew=0.8)
    for point, name, shift in (((0, 0), "O", (-0.018, 0.006)), (a, "A", (-0.012, 0.014)), (b, "B", (-0.004, 0.032))):
        ax.plot(*point, "o", ms=5, mfc="white", mec=INK, zorder=8)
        ax.text(*(np.asarray(point) + shift), name, ha="center", va="center")
    angle_mark(ax, np.zeros(2), 0.055, 0.0, phi, r"$\varphi$", ACCENT, 1.22)
    angle_mark(ax, np.zeros(2), 0.03, np.radians(110), np.radians(245), r"$M,\ \omega > 0$", LOAD, 2.4)
    arrow(ax, foot + 0.36 * u, foot + 0.43 * u, "u", INK)
    arrow(ax, foot + 0.36 * u, foot + 0.36 * u + 0.05 * n, "n", INK)
    ax.annotate("", foot, (0, 0), arrowprops={**SHAFT, "color": ACCENT, "lw": 0.9, "mutation_scale": 8})
    ax.text(*(0.5 * foot + (0.026, 0.0)), "e < 0", color=ACCENT, ha="center", va="center", fontsize="small")
    q = (b - a) / np.hypot(*(b - a))
    arrow(ax, a, a + 0.07 * q, "")
    ax.text(*(a + 0.06 * q + 0.018 * strokes.left(q)), "along", color=ACCENT, fontsize="small", ha="center")
    arrow(ax, a, a + 0.045 * strokes.left(q), "across")
    ax.text(*(foot + 0.2 * u - 0.035 * n), "guide", rotation=12, fontsize="small", ha="center", va="center")
    ax.update_datalim([(0.0, 0.175), (-0.12, 0.0)])
    ax.set_aspect("equal", adjustable="datalim")
    ax.autoscale_view()
    ax.margins(0.04)
    ax.axis("off")
    return figure


def groups():
    """Each group in one pose."""
    crank, pivot = ks.Crank(0.1), (0.28, -0.02)
    cam = ks.CamRoller(ks.cams.Circle(0.1, (-0.03, 0.0)))
    dyad = (ks.RockerGroup(0.25, 0.18, pivot), ks.Pin(on="crank", at=(0.03, 0.06), name="C"))
    chains = {
        "SliderGroup": (crank, (ks.SliderGroup(0.25),)),
        "RockerGroup": (crank, (ks.RockerGroup(0.25, 0.18, pivot),)),
        "Dyad (on B and C)": (crank, (*dyad, ks.Dyad(0.2, 0.22, on=("B", "C"), assembly=-1))),
        "LeverGroup": (crank, (ks.LeverGroup((0.0, -0.18)),)),
        "CylinderGroup": (crank, (ks.CylinderGroup((0.3, 0.0)),)),
        "YokeGroup": (crank, (ks.YokeGroup(ks.Guide.at(0.0)),)),
        "PlanetaryCrank": (crank, (ks.PlanetaryCrank(0.1),)),
        "CamRoller and SliderGroup": (ks.Crank(None), (cam, ks.SliderGroup(0.25))),
        "RollerFollower": (ks.Crank(None), (ks.RollerFollower(ks.laws.cosine(0.03, 0.12)),)),
    }
    figure, axes = plt.subplots(3, 3)
    for ax, (name, (driver, chain)) in zip(axes.flat, chains.items(), strict=True):
        s = ks.solve(ks.Mechanism(name, driver, chain), TURN, crank_speed=1.0)
        ks.plots.mechanism(s, angles=(60,), ax=ax)
        ax.set_title(name, fontsize="medium")
        ax.axis("off")
    return figure


def friction():
    """A pin that rubs, and a shoe that carries a couple."""
    figure, (pin, shoe) = plt.subplots(1, 2)
    around = np.linspace(0.0, 2 * np.pi, 200)
    circle = np.array([np.cos(around), np.sin(around)])
    pin.fill(*(1.9 * circle), fc="0.92", ec=STEEL, lw=1.2)
    pin.fill(*circle, fc="white", ec=INK, lw=1.2)
    pin.plot(*(0.3 * circle), color=ACCENT, lw=1.0, ls="--")
    pin.text(0.62, -0.45, r"$\mu\, r$", color=ACCENT, ha="center")
    angle_mark(pin, np.zeros(2), 1.55, np.radians(100), np.radians(170), r"$\omega_{rel}$", STEEL, 0.8)
    arrow(pin, np.array([-0.3, -2.6]), np.array([-0.3, 0.0]), "R", tail=True)
    pin.plot([0.0, -0.3], [0.0, 0.0], color=ACCENT, lw=1.0)
    pin.plot(0, 0, "+", color=INK)
    pin.set_title("pin: R touches the friction circle", fontsize="medium")
    shoe.fill([-1, 1, 1, -1], [0, 0, 0.7, 0.7], fc=STEEL, ec="none", alpha=0.7)
    shoe.plot(*strokes.hatched_line(np.array([-2.2, -0.03]), np.array([2.4, -0.03]), 0.18), color=INK, lw=0.8)
    arrow(shoe, np.array([1.1, 0.4]), np.array([1.9, 0.4]), "v", INK)
    arrow(shoe, np.array([-0.95, -1.2]), np.array([-0.95, -0.03]), "N/2 - C/2b", tail=True)
    arrow(shoe, np.array([0.95, -1.2]), np.array([0.95, -0.03]), "N/2 + C/2b", tail=True)
    arrow(shoe, np.array([-1.0, 0.12]), np.array([-1.9, 0.12]), "F", LOAD)
    shoe.annotate("", (-1, 1.1), (1, 1.1), arrowprops={**SHAFT, "arrowstyle": "<->", "color": INK, "lw": 0.8})
    shoe.text(0.0, 1.25, "2b", ha="center")
    shoe.set_title("shoe: F = \N{GREEK SMALL LETTER MU} max(|N|, |C|/b) against v", fontsize="medium")
    for ax in (pin, shoe):
        ax.set_aspect("equal", adjustable="datalim")
        ax.autoscale_view()
        ax.margins(0.12)
        ax.axis("off")
    return figure


def bars_on_rockers():
    """Three wheels with two coupling rods, and the second rod crossed."""
    figure, axes = plt.subplots(1, 2)
    for ax, word in zip(axes, ("open", "crossed"), strict=True):
        rods = (
            ks.RockerGroup(0.28, 0.1, (0.28, 0.0), "open"),
            ks.RockerGroup(0.22, 0.1, (0.5, 0.0), word, on="B", pin="C", pivot_name="O3", label="2"),
        )
        s = ks.solve(ks.Mechanism(word, ks.Crank(0.1), rods), TURN, crank_speed=1.0)
        ks.plots.mechanism(s, angles=(60,), ax=ax)
        ax.set_title(f'assembly "{word}"', fontsize="medium")
        ax.axis("off")
    return figure


def rolling_arm():
    """A roller on its cam: the force of the cam ahead of the contact, that along the curve, and those of the pin."""
    figure, ax = plt.subplots()
    around = np.linspace(0.0, 2.0 * np.pi, 200)
    circle = np.array([np.cos(around), np.sin(around)])
    ax.fill(*circle, fc="0.92", ec=INK, lw=1.2)
    ax.fill(*(0.2 * circle), fc="white", ec=INK, lw=1.2)
    ax.plot(*strokes.hatched_line(np.array([-2.2, -1.02]), np.array([2.4, -1.02]), 0.18), color=INK, lw=0.8)
    arrow(ax, np.array([0.3, -2.2]), np.array([0.3, -1.02]), "K", tail=True)
    arrow(ax, np.array([0.3, -1.0]), np.array([-0.8, -1.0]), "")
    ax.text(-0.75, -0.9, "$K_t$", color=ACCENT, ha="right")
    ax.plot([0.0, 0.0], [-2.0, 0.0], color=STEEL, lw=0.8, ls="--")
    ax.text(-0.15, -1.6, "e", ha="right", va="center")
    ax.annotate("", (0.0, -1.6), (0.3, -1.6), arrowprops={**SHAFT, "arrowstyle": "<->", "color": INK, "lw": 0.8})
    arrow(ax, np.array([0.3, 0.0]), np.array([1.6, 0.0]), "v", INK)
    angle_mark(ax, np.zeros(2), 0.55, np.radians(60), np.radians(150), r"$p\,\sqrt{K^2 + K_t^2}$", ACCENT, 2.4)
    ax.text(0.66, 0.3, "$R_r$", ha="left")
    ax.plot([0.0, np.cos(0.6)], [0.0, np.sin(0.6)], color=INK, lw=0.8)
    ax.set_aspect("equal", adjustable="datalim")
    ax.autoscale_view()
    ax.margins(0.08)
    ax.axis("off")
    return figure


def sections():
    """A coupler between its pins with its point masses, and a part of it with the forces at the section."""
    figure, (bar, part) = plt.subplots(2, 1)
    for ax, end in ((bar, 4.0), (part, 1.6)):
        ax.fill([0, end, end, 0], [-0.12, -0.12, 0.12, 0.12], fc="0.88", ec=INK, lw=1.0)
        arrow(ax, np.array([-0.7, 0.0]), np.array([0.0, 0.0]), "$F_t$", tail=True)
        arrow(ax, np.array([0.0, -0.75]), np.array([0.0, 0.0]), "$F_n$", tail=True)
        ax.plot(0.0, 0.0, "o", ms=7, mfc="white", mec=INK)
        ax.plot([1.0], [0.0], "o", ms=9, color=STEEL)
        ax.text(1.0, 0.26, r"$m_i$", ha="center", color=STEEL)
    bar.plot(4.0, 0.0, "o", ms=7, mfc="white", mec=INK)
    arrow(bar, np.array([4.8, 0.0]), np.array([4.1, 0.0]), "")
    arrow(bar, np.array([4.0, -0.75]), np.array([4.0, 0.0]), "")
    for height, end, text in ((0.62, 4.0, "L"), (-0.42, 1.0, r"$x_i$")):
        bar.annotate("", (0, height), (end, height), arrowprops={**SHAFT, "arrowstyle": "<->", "color": INK, "lw": 0.8})
        bar.text(0.5 * end, height + 0.08, text, ha="center", bbox={"fc": "white", "ec": "none", "pad": 0.5})
    for x in np.linspace(0.2, 1.5, 6):
        arrow(part, np.array([x, 0.75]), np.array([x, 0.42]), "", LOAD)
    part.text(0.45, 0.82, r"$\mu\,(g - a)$ on each metre", color=LOAD)
    arrow(part, np.array([1.6, 0.0]), np.array([2.5, 0.0]), "N")
    arrow(part, np.array([1.6, 0.12]), np.array([1.6, -0.7]), "V")
    angle_mark(part, np.array([1.6, 0.0]), 0.42, np.radians(-75), np.radians(75), "", ACCENT)
    part.text(2.05, 0.36, "M", color=ACCENT)
    part.annotate("", (0, -0.42), (1.6, -0.42), arrowprops={**SHAFT, "arrowstyle": "<->", "color": INK, "lw": 0.8})
    part.text(0.8, -0.36, "x", ha="center")
    arrow(part, np.array([3.4, 0.0]), np.array([4.1, 0.0]), "t", INK)
    arrow(part, np.array([3.4, 0.0]), np.array([3.4, 0.7]), "n", INK)
    for ax in (bar, part):
        ax.set(xlim=(-1.0, 5.0), ylim=(-0.95, 1.05))
        ax.set_aspect("equal")
        ax.axis("off")
    return figure


def bearings():
    """A rolling bearing with the load and the turning of its rings; a plain bearing with its diameter and width."""
    figure, (rolling, plain) = plt.subplots(1, 2, width_ratios=(1.2, 1.0))
    around = np.linspace(0.0, 2.0 * np.pi, 181)
    for radius, shade in ((1.5, "0.88"), (1.2, "white"), (0.8, "0.75"), (0.5, "white")):
        rolling.fill(radius * np.cos(around), radius * np.sin(around), fc=shade, ec=INK, lw=1.0)
    for angle in np.arange(12) * np.pi / 6:
        x, y = 1.0 * np.cos(angle), 1.0 * np.sin(angle)
        rolling.fill(x + 0.19 * np.cos(around), y + 0.19 * np.sin(around), fc="white", ec=STEEL, lw=1.0)
    arrow(rolling, np.array([0.0, 0.0]), np.array([-1.8, -0.9]), "F")
    angle_mark(rolling, np.zeros(2), 0.35, np.radians(20), np.radians(150), "", LOAD)
    rolling.text(0.22, -0.32, r"$\omega_1$", ha="center", color=LOAD)
    angle_mark(rolling, np.zeros(2), 1.65, np.radians(60), np.radians(110), "", LOAD)
    rolling.text(0.15, 1.78, r"$\omega_2$", ha="center", color=LOAD)
    rolling.text(1.7, -0.9, r"$\omega_{rel} = \omega_1 - \omega_2$")
    plain.fill([-1.8, 1.8, 1.8, -1.8], [-0.5, -0.5, 0.5, 0.5], fc="white", ec=INK, lw=1.0)
    for low, high in ((0.5, 0.9), (-0.9, -0.5)):
        plain.fill([-1.0, 1.0, 1.0, -1.0], [low, low, high, high], fc="0.88", ec=INK, lw=1.0, hatch="///")
    plain.plot([-2.0, 2.0], [0.0, 0.0], color=INK, lw=0.7, ls=(0, (9, 3, 2, 3)))
    arrow(plain, np.array([0.0, 1.9]), np.array([0.0, 0.95]), "F", tail=True)
    ends = {**SHAFT, "arrowstyle": "<->", "color": INK, "lw": 0.8}
    plain.annotate("", (-1.0, -1.15), (1.0, -1.15), arrowprops=ends)
    plain.text(0.0, -1.45, "b", ha="center")
    plain.annotate("", (1.5, -0.5), (1.5, 0.5), arrowprops=ends)
    plain.text(1.58, 0.12, "d")
    for ax in (rolling, plain):
        ax.set(xlim=(-2.1, 3.4) if ax is rolling else (-2.3, 2.3), ylim=(-1.75, 2.15))
        ax.set_aspect("equal")
        ax.axis("off")
    return figure


def spring_line(start, end, width, turns=5):
    """Points (2, N) of a zigzag between two points, with straight ends."""
    start, end = np.asarray(start, dtype=float), np.asarray(end, dtype=float)
    along = np.concatenate([[0.0, 0.2], 0.2 + 0.6 * (np.arange(2 * turns) + 0.5) / (2 * turns), [0.8, 1.0]])
    across = width * np.concatenate([[0.0, 0.0], np.tile([1.0, -1.0], turns), [0.0, 0.0]])
    way = end - start
    return start[:, None] + np.outer(way, along) + np.outer(strokes.left(way / np.hypot(*way)), across)


def damper_lines(start, end, width):
    """A piston in its cylinder between two points, each line (2, N)."""
    start, end = np.asarray(start, dtype=float), np.asarray(end, dtype=float)
    way = end - start
    side = width * strokes.left(way / np.hypot(*way))
    at = [start + share * way for share in (0.0, 0.35, 0.55, 0.65, 1.0)]
    cylinder = [at[3] + side, at[1] + side, at[1] - side, at[3] - side]
    return [np.array([at[0], at[1]]).T, np.array(cylinder).T, np.array([at[4], at[2]]).T] + [
        np.array([at[2] + 0.7 * side, at[2] - 0.7 * side]).T
    ]


def dimension(ax, start, end, text, shift):
    """A dimension between two points."""
    style = {**SHAFT, "arrowstyle": "<->", "color": INK, "lw": 0.8, "mutation_scale": 8}
    ax.annotate("", end, start, arrowprops=style)
    ax.text(*(np.add(start, end) / 2 + shift), text, ha="center", va="center")


def foundation():
    """A block with a machine on springs and dampers."""
    figure, ax = plt.subplots()
    ax.fill([-1.2, 1.2, 1.2, -1.2], [0.0, 0.0, 0.8, 0.8], fc="0.9", ec=INK, lw=1.2)
    pivot = np.array([-0.7, 1.05])
    pin, end = pivot + 0.22 * _unit(55), pivot + (0.95, 0.0)
    ax.fill([-0.82, -0.7, -0.58], [0.8, 1.05, 0.8], fc="white", ec=INK, lw=1.0)
    ax.fill([-0.1, 0.85, 0.85, -0.1], [0.8, 0.8, 0.97, 0.97], fc="white", ec=INK, lw=1.0)
    for first, second in ((pivot, pin), (pin, end)):
        ax.plot(*np.stack([first, second], axis=1), **LINES["bar"])
    ax.fill(*(end[:, None] + _box(np.array([1.0, 0.0]), 0.08)), **PLATES["block"])
    for point, name, shift in ((pivot, "O", (-0.13, 0.05)), (pin, "A", (-0.02, 0.13)), (end, "B", (0.02, 0.18))):
        ax.plot(*point, "o", ms=5, mfc="white", mec=INK, zorder=8)
        ax.text(*np.add(point, shift), name, ha="center", va="center")
    arrow(ax, pivot + (0.12, 0.0), pivot + (0.5, 0.0), "F", ACCENT)
    ground = [((-2.0, -0.6), (2.0, -0.6)), ((-2.0, 1.0), (-2.0, -0.6))]
    for start, stop in ground:
        ax.plot(*strokes.hatched_line(np.array(start), np.array(stop), 0.09), color=INK, lw=0.8)
    for place in (-0.9, 0.6):
        ax.plot(*spring_line((place, -0.6), (place, 0.0), 0.07), color=STEEL, lw=1.2)
        for line in damper_lines((place + 0.3, -0.6), (place + 0.3, 0.0), 0.08):
            ax.plot(*line, color=STEEL, lw=1.2)
    ax.plot(*spring_line((-2.0, 0.55), (-1.2, 0.55), 0.07), color=STEEL, lw=1.2)
    for line in damper_lines((-2.0, 0.25), (-1.2, 0.25), 0.08):
        ax.plot(*line, color=STEEL, lw=1.2)
    ax.text(-1.6, 0.74, "$k_x$", ha="center")
    ax.text(-1.6, 0.03, "$c_x$", ha="center", va="center")
    ax.text(-0.15, -0.32, "$k_y, c_y$\n$k_\\theta, c_\\theta$", ha="center", va="center")
    centre = np.array([0.15, 0.4])
    ax.plot(*centre, "o", ms=7, mfc="white", mec=INK)
    ax.plot(*centre, ".", ms=3, color=INK)
    arrow(ax, centre, centre + (0.4, 0.0), "x", LOAD)
    arrow(ax, centre, centre + (0.0, 0.27), "y", LOAD)
    angle_mark(ax, centre, 0.2, np.radians(200), np.radians(330), r"$\theta$", LOAD, 0.55)
    ax.text(0.85, 0.2, "mass, inertia", ha="center", va="center", fontsize="small")
    for level in (pivot, centre):
        ax.plot([level[0], -0.95], [level[1], level[1]], color=INK, lw=0.5)
    dimension(ax, (-0.95, centre[1]), (-0.95, pivot[1]), "centre y < 0", (-0.36, 0.21))
    dimension(ax, (pivot[0], 0.08), (centre[0], 0.08), "centre x", (0.0, 0.07))
    for level in (pivot, centre):
        ax.plot([level[0], level[0]], [level[1], 0.05], color=INK, lw=0.5)
    arrow(ax, np.array([1.6, -0.15]), np.array([1.6, -0.58]), "to the ground", ACCENT, tail=True)
    ax.set_aspect("equal", adjustable="datalim")
    ax.autoscale_view()
    ax.margins(0.04)
    ax.axis("off")
    return figure


def play():
    """A journal in its play, much enlarged: bearing, contact and force; the clearance is half the difference."""
    figure, ax = plt.subplots()
    around = np.linspace(0.0, 2.0 * np.pi, 240)
    circle, beta, lag, c = np.array([np.cos(around), np.sin(around)]), np.radians(35.0), np.radians(28.0), 0.45
    e, f = (np.array([np.cos(turned), np.sin(turned)]) for turned in (beta, beta + lag))
    journal = c * e
    ax.fill(*(1.9 * circle), fc="0.9", ec=STEEL, lw=1.0)
    ax.fill(*(1.5 * circle), fc="white", ec=INK, lw=1.2)
    ax.fill(*(journal[:, None] + 1.05 * circle), fc=STEEL, ec=INK, lw=1.0, alpha=0.45)
    ax.plot(*(c * circle), color=INK, lw=0.7, ls="--")
    ax.plot([0.0, 2.3], [0.0, 0.0], color=INK, lw=0.5, ls="-.")
    ax.plot(*np.transpose([(0.0, 0.0), 2.35 * e]), color=INK, lw=0.5, ls="-.")
    ax.plot(*np.transpose([journal, journal + 1.3 * f]), color=ACCENT, lw=0.5, ls="-.")
    arrow(ax, journal, journal + 0.6 * f, "F", ACCENT)
    arrow(ax, 2.3 * e, 1.5 * e, "N", LOAD, tail=True)
    angle_mark(ax, np.zeros(2), 2.05, 0.0, beta, r"$\beta$", INK, 1.07)
    angle_mark(ax, journal, 1.25, beta, beta + lag, "d", ACCENT, 1.12)
    arrow(ax, np.zeros(2), c * np.array([-0.94, -0.34]), "c", INK)
    arrow(ax, journal, journal + 0.55 * strokes.left(e), "t", INK)
    for point in (np.zeros(2), journal):
        ax.plot(*point, "o", ms=4, mfc="white", mec=INK, zorder=8)
    ax.text(0.0, -1.72, "bearing", ha="center", va="center", fontsize="small")
    ax.text(0.55, -0.35, "journal", ha="center", va="center", fontsize="small")
    ax.set_aspect("equal")
    ax.margins(0.06)
    ax.axis("off")
    return figure


def planes():
    """A crankshaft of four throws on two bearings: planes of the throws, forces of the cylinders, drive end."""
    figure, ax = plt.subplots()
    places, ends, radii = (-1.5, -0.5, 0.5, 1.5), (-2.2, 2.2), (0.55, -0.55, 0.55, -0.55)
    ax.plot([-2.7, 2.9], [0, 0], color=INK, lw=0.5, ls="-.")
    line = [(ends[0] - 0.2, 0.0)]
    for z, radius in zip(places, radii, strict=True):
        line += [(z - 0.2, 0.0), (z - 0.2, radius), (z + 0.2, radius), (z + 0.2, 0.0)]
    ax.plot(*np.transpose([*line, (2.75, 0.0)]), color=STEEL, lw=5, solid_joinstyle="round")
    for z, name in zip(ends, ("left", "right"), strict=True):
        ax.plot([z, z], [-0.2, -0.1], color=INK, lw=0.8)
        ax.fill([z - 0.14, z + 0.14, z + 0.14, z - 0.14], [-0.1, -0.1, 0.1, 0.1], fc="0.85", ec=INK, lw=0.8, zorder=5)
        ax.plot(*strokes.hatched_line(np.array([z - 0.25, -0.2]), np.array([z + 0.25, -0.2]), 0.07), color=INK, lw=0.8)
        arrow(ax, np.array([z, -0.85]), np.array([z, -0.36]), f"$R_{{{name}}}$", tail=True)
    for number, (z, radius) in enumerate(zip(places, radii, strict=True), 1):
        ax.plot([z, z], [radius, 1.0], color=INK, lw=0.5)
        tips = (0.78, 1.35) if number % 2 else (1.35, 0.78)
        arrow(ax, *(np.array([z, tip]) for tip in tips), f"$F_{number}$", LOAD, tail=number % 2 == 0)
    for level, z, name in ((-1.05, places[0], "$z_1 < 0$"), (-1.05, places[3], "$z_4$")):
        ax.plot([z, z], [-0.62, level], color=INK, lw=0.5)
        ax.annotate("", (0, level), (z, level), arrowprops={**SHAFT, "arrowstyle": "<->", "color": INK, "lw": 0.8})
        ax.text(0.5 * z, level + 0.08, name, ha="center")
    ax.plot([0, 0], [-1.3, 0.0], color=INK, lw=0.5, ls="--")
    ax.text(0.0, -1.4, "z = 0", ha="center", va="center")
    arrow(ax, np.array([2.75, -0.6]), np.array([3.25, -0.6]), "z", INK)
    ax.text(2.8, 0.14, "drive", ha="center")
    ax.text(0.0, 0.2, "torque", ha="center", fontsize="small", color=ACCENT)
    ax.plot([0, 0], [-0.12, 0.12], color=ACCENT, lw=1.4)
    ax.set_aspect("equal", adjustable="datalim")
    ax.autoscale_view()
    ax.margins(0.04)
    ax.axis("off")
    return figure


def work():
    """A saw frame in its log, with force, thrust and overhang; a section of a knife between two fingers."""
    figure, (saw, knife) = plt.subplots(2, 1, height_ratios=(1.0, 0.8))
    for height in (-0.22, 0.22):  # blades from the pin's end of the frame to the other
        saw.plot([0.4, 3.2], [height, height], color=STEEL, lw=2.4)
    for end in (0.3, 3.2):
        saw.fill(*_box(np.array([1.0, 0.0]), 0.1) * [[1.0], [4.5]] + [[end], [0.0]], **PLATES["block"])
    saw.fill([1.6, 2.5, 2.5, 1.6], [-0.4, -0.4, 0.4, 0.4], fc="0.9", ec=INK, lw=1.0, zorder=0, alpha=0.8)
    saw.plot([-0.9, 0.3], [-0.25, 0.0], **LINES["bar"])
    saw.plot(0.3, 0.0, "o", ms=5, mfc="white", mec=INK, zorder=8)
    saw.text(0.3, 0.72, "B at mid-stroke", ha="center", va="center")
    middle = np.array([2.05, 0.0])
    arrow(saw, middle, middle + (0.75, 0.0), "F", LOAD)
    arrow(saw, middle, middle + (0.0, 0.62), "thrust F", LOAD)
    saw.text(1.7, -0.53, "log", ha="center", va="center")
    saw.annotate("", (-0.75, 0.28), (-0.05, 0.28), arrowprops={**SHAFT, "color": INK})
    saw.text(-0.4, 0.42, "cuts", ha="center", va="center")
    for x in (0.3, 2.05):
        saw.plot([x, x], [-0.1, -0.95], color=INK, lw=0.5)
    dimension(saw, (0.3, -0.88), (2.05, -0.88), "overhang", (0.0, 0.14))
    pitch, place = 2.0, 1.0
    for x in (0.0, pitch):  # fingers, and the section on its way between them
        knife.fill(x + np.array([-0.32, 0.32, 0.2, -0.2]), [0.0, 0.0, 1.0, 1.0], fc="0.9", ec=INK, lw=1.0)
        knife.text(x, -0.14, "finger", ha="center", va="center")
        knife.plot([x, x], [0.0, 1.75], color=INK, lw=0.5)
    knife.fill(place + np.array([-1.0, 1.0, 0.2, -0.2]), [0.0, 0.0, 1.0, 1.0], **(PLATES["block"] | {"alpha": 0.7}))
    knife.plot([place, place], [0.0, 1.42], color=INK, lw=0.5)
    knife.text(place, 0.35, "section", ha="center", va="center")
    knife.plot(1.722, 0.348, "o", ms=5, color=LOAD, zorder=9)
    knife.annotate("cut", (1.722, 0.348), (2.8, 0.65), va="center", arrowprops={**SHAFT, "color": LOAD, "lw": 0.9})
    dimension(knife, (0.0, 1.66), (pitch, 1.66), "pitch", (0.0, 0.13))
    dimension(knife, (0.0, 1.3), (place, 1.3), "start ... end", (0.0, 0.13))
    for ax in (saw, knife):
        ax.set_aspect("equal", adjustable="datalim")
        ax.margins(0.06)
        ax.axis("off")
    return figure


def balance_shafts():
    """A harmonic of the force as an ellipse of two circles; a crank-slider with counterweight and three shafts."""
    figure, (one, two) = plt.subplots(1, 2, width_ratios=(1.0, 1.5))
    turn, angle, forward, backward = np.exp(1j * TURN), 0.7, 1.0, 0.45
    for radius, centre in ((forward, 0.0), (backward, forward * np.exp(1j * angle))):
        circle = centre + radius * turn
        one.plot(circle.real, circle.imag, color=INK, lw=0.6, ls="--")
    ellipse = forward * turn + backward * turn.conj()
    one.plot(ellipse.real, ellipse.imag, color=LOAD, lw=1.6)
    middle = forward * np.exp(1j * angle)
    tip = middle + backward * np.exp(-1j * angle)
    ends = [np.array([part.real, part.imag]) for part in (0j, middle, tip)]
    for start, end, colour in ((0, 1, STEEL), (1, 2, STEEL), (0, 2, LOAD)):
        arrow(one, ends[start], ends[end], "", colour)
    for place, name, colour in (
        ((0.0, 0.28), "$+n$", STEEL),
        ((0.93, 0.6), "$-n$", STEEL),
        ((0.6, 0.06), "$F_n$", LOAD),
    ):
        one.text(*place, name, color=colour)
    machine = ks.Scene(ks.crank_slider(0.05, 0.17, slider=ks.Link(1.0)), 100.0)
    places = {-1.0: (-0.11, 0.0), 2.0: (0.06, 0.09), -2.0: (0.06, -0.09)}
    found = ks.balancing.shafts(machine, at=places, crank=ks.Counterweight(arm=-0.022))
    ks.plots.mechanism(found.scene.solve(np.radians([40.0])), angles=(40,), ax=two)
    for ratio, (x, y) in {**places, 1.0: (-0.01, -0.05)}.items():
        two.text(x - 0.02, y + 0.012, f"${ratio:+g}$", ha="right", va="bottom", color=ACCENT)
    one.set_aspect("equal")
    for ax in (one, two):
        ax.axis("off")
    return figure


def springs():
    """A helical spring with its dimensions; a slider between springs that press and pull, and between opposed ones."""
    figure, (one, two) = plt.subplots(1, 2, width_ratios=(1.0, 1.6))
    made = {"wire_diameter": 8e-3, "coil_diameter": 48e-3, "active_turns": 5.0, "travel": 0.03, "preload": 1.5e3}
    draw_spring(one, ks.sizing.HelicalSpring(**made), ("d", "D", "$L_0$", "$L_s$"))
    for height, end, name in ((0.0, 1.3, "opposed: two springs, always pressed"), (1.6, 0.0, "push-pull: one spring")):
        for start, far in ((-2.2, -0.4), (2.2, 0.4))[: 1 + (end > 0.0)]:
            points = strokes.span_symbol(strokes.SPRING, *np.array([[[start], [height]], [[far], [height]]]), 0.22)
            two.plot(*points[..., 0], color=INK, lw=1.0)
            wall = np.array([[start, height - 0.4], [start, height + 0.4]])[:: 1 if start < 0 else -1]
            two.plot(*strokes.hatched_line(*wall[::-1], 0.1), color=INK, lw=0.8)
        two.fill([-0.4, 0.4, 0.4, -0.4], [height - 0.2, height - 0.2, height + 0.2, height + 0.2], fc=STEEL, ec=INK)
        two.text(0.0, height - 0.72, name, ha="center", va="center")
    two.annotate("", (-1.0, 2.15), (1.0, 2.15), arrowprops={**SHAFT, "arrowstyle": "<->", "color": INK, "lw": 0.8})
    two.text(0.0, 2.2, "travel", ha="center", va="bottom")
    two.set_aspect("equal")
    two.margins(0.06)
    two.axis("off")
    return figure


DRAWINGS = {
    "signs": (signs, (6.4, 3.1)),
    "groups": (groups, (7.6, 5.4)),
    "crank_slider": (crank_slider, (6.4, 1.7)),
    "four_bar": (four_bar, (6.4, 1.9)),
    "lever": (lever, (6.4, 2.9)),
    "cylinder": (cylinder, (6.4, 2.0)),
    "yoke": (yoke, (6.4, 2.3)),
    "cam_roller": (cam_roller, (7.0, 1.6)),
    "friction": (friction, (6.4, 2.5)),
    "bars_on_rockers": (bars_on_rockers, (7.2, 2.2)),
    "rolling_arm": (rolling_arm, (4.4, 2.6)),
    "../parts/sections": (sections, (6.4, 4.2)),
    "../parts/foundation": (foundation, (6.4, 3.2)),
    "../parts/play": (play, (4.4, 3.6)),
    "../parts/springs": (springs, (6.4, 3.0)),
    "../machines/balance_shafts": (balance_shafts, (7.0, 3.0)),
    "../machines/work": (work, (6.0, 4.6)),
    "../parts/planes": (planes, (6.4, 3.2)),
    "../parts/bearings": (bearings, (6.4, 2.6)),
}
"""How each is drawn, and its size in inches."""


def drawn(name):
    """A drawing as SVG."""
    draw, size = DRAWINGS[name]
    with look(name, size):
        svg = as_svg(draw())
        plt.close("all")
    return svg


if __name__ == "__main__":
    for name in sys.argv[1:] or DRAWINGS:
        (FOLDER / f"{name}.svg").write_text(drawn(name), encoding="utf-8")
