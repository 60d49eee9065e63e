"""Random mechanisms with friction in their joints, each for the package and as `multibody.System`."""

import math

import mpmath as mp
import numpy as np

import kinetostatics as ks

from .multibody import Body, Pin, Roller, Slide, System, circles_meet

RUBBED = ks.crank_slider(
    0.1,
    0.3,
    guide_offset=0.02,
    crank=ks.Link(2.0, (0.03, 0.01), 0.01),
    coupler=ks.Link(3.0, (0.1, 0.01), 0.02),
    slider=ks.Link(4.0, (0.01, 0.02)),
)
JOINTS = {
    "O": ks.PinFriction(0.1, 0.02),
    "A": ks.PinFriction(0.1, 0.02),
    "B": ks.PinFriction(0.1, 0.015),
    "guide": ks.GuideFriction(0.15, 0.04),
}
"""A crank-slider off its centre, and friction in all its joints."""
KINDS = ("slider", "cam", "four-bar", "six-bar", "coupler point", "lever", "cylinder", "yoke", "dyad")
FOLLOWERS = ("roller follower", "swinging follower")


class Drawn:
    """Numbers of one random machine; `scale` of the coefficients."""

    def __init__(self, kind, seed, scale=1.0):
        self.rng, self.scale = np.random.default_rng([(*KINDS, *FOLLOWERS).index(kind), seed]), scale
        self.bodies, self.poses, self.joints, self.friction, self.applied, self.loads = {}, {}, {}, {}, [], ()
        self.r = self.real(0.08, 0.15)
        crank, *groups = getattr(self, "_" + kind.replace("-", "_").replace(" ", "_"))()
        self.speed = float(self.rng.choice([-1, 1]) * self.real(3.0, 40.0))
        self.acceleration = self.real(-60.0, 60.0)
        self.gravity = self.real(-10, 10), self.real(-10, 10)
        self.scene = ks.Scene(
            ks.Mechanism(kind, crank, tuple(groups)),
            self.speed,
            self.acceleration,
            (ks.Gravity(math.hypot(*self.gravity), math.atan2(*self.gravity[::-1])), *self.loads),
            self.friction,
        )
        x, y = (item.vector for item in self.scene.loads if isinstance(item, ks.Gravity)).__next__()
        self.system = System(
            self.bodies,
            self.poses,
            self.joints,
            mp.mpf(self.speed),
            mp.mpf(self.acceleration),
            mp.mpc(float(x), float(y)),
            self.applied,
        )

    def real(self, low, high):
        """A number."""
        return float(self.rng.uniform(low, high))

    def inertia(self, mass):
        """Moment of inertia of a body of some mass, by its radius of gyration."""
        return mass * self.real(0.03, 0.3) ** 2

    def link(self, name, point, direction):
        """Mass properties, also for the system."""
        mass = self.real(0.1, 9)
        inertia = self.inertia(mass)
        centre = self.real(-0.1, 0.2), self.real(-0.05, 0.05)
        self.bodies[name], self.poses[name] = Body(mass, centre, inertia), (point, direction)
        return ks.Link(mass, centre, inertia)

    def pin(self, name, on, against, at):
        """A pin that rubs."""
        mu, radius = self.scale * self.real(0.0, 0.2), self.real(0.005, 0.02)
        self.friction[name] = ks.PinFriction(mu, radius)
        self.joints[name] = Pin(on, against, at, mp.mpf(mu) * radius)

    def slide(self, name, on, against, at, direction):
        """A guide or slot that rubs, with a shoe or without."""
        mu = self.scale * self.real(0.0, 0.25)
        half = self.real(0.05, 0.2) if self.rng.random() < 0.6 else None
        self.friction[name] = (ks.GuideFriction if against is None else ks.SlotFriction)(mu, half)
        self.joints[name] = Slide(on, against, at, direction, mp.mpf(mu), half)

    def _crank(self, length):
        self.A = lambda phi: self.r * mp.expj(phi)
        link = self.link("crank", lambda phi: mp.mpc(0), mp.expj)
        self.pin("O", "crank", None, lambda phi: mp.mpc(0))
        return ks.Crank(length, link)

    def _sliding(self, inner, carrier, on="A", pin="B", label=""):
        """Slider group on a point."""
        length, angle = self.real(4, 6) * self.r, self.real(-3, 3)
        offset, side = self.real(-0.4, 0.4) * self.r, int(self.rng.choice([-1, 1]))
        guide = ks.Guide.at(angle, offset)
        u = mp.mpc(*map(float, guide.direction))
        force = self.real(-300, 300)

        def slider(phi):
            a = inner(phi) / u
            across = offset - mp.im(a)
            return u * (mp.re(a) + side * mp.sqrt(length**2 - across**2) + 1j * offset)

        def direction(phi):
            return (slider(phi) - inner(phi)) / length

        coupler, block = "coupler" + label, "slider" + label
        group = ks.SliderGroup(
            length,
            guide,
            side,
            coupler=self.link(coupler, inner, direction),
            slider=self.link(block, slider, lambda phi: u),
            on=on,
            pin=pin,
            label=label,
        )
        self.pin(on + label, coupler, carrier, inner)
        self.pin(pin, block, coupler, slider)
        self.slide("guide" + label, block, None, slider, lambda phi: u)
        self.applied.append((block, lambda phi: force * u, slider))
        self.loads = (*self.loads, ks.ProcessForce(force, on=block))
        return group

    def _slider(self):
        return self._crank(self.r), self._sliding(self.A, "crank")

    def _cam(self):
        r, centre = self.r, (self.real(-0.2, 0.2) * self.r, self.real(-0.2, 0.2) * self.r)
        c = mp.mpc(*centre)

        def roller(phi):
            along, across = mp.re(c * mp.conj(mp.expj(phi))), mp.im(c * mp.conj(mp.expj(phi)))
            return mp.expj(phi) * (along + mp.sqrt(r**2 - across**2))

        crank = self._crank(None)
        block = self.link("block", roller, mp.expj)
        self.slide("slot", "block", "crank", roller, mp.expj)
        mu, pin_radius, radius = self.scale * self.real(0, 0.1), self.real(0.01, 0.02), self.real(0.02, 0.05)
        slider = self._sliding(roller, "block")
        arm = self.scale * self.rng.choice([0.0, self.real(0.0, 0.003)])
        self.friction["cam"] = ks.RollerFriction(mu, pin_radius, radius, arm)
        self.joints["cam"] = Roller("block", roller, mp.mpf(mu) * pin_radius, mp.mpf(radius), arm=mp.mpf(arm))
        return crank, ks.CamRoller(ks.cams.Circle(r, centre), block), slider

    def _roller_follower(self):
        """Follower on a guide, on a cam of the crank, and a four-bar."""
        lift, mean, phase, angle = self.real(0.01, 0.02), self.real(0.08, 0.12), self.real(-3, 3), self.real(-3, 3)
        offset, u, crank, bars = self.real(-0.01, 0.01), mp.expj(angle), self._crank(self.r), self._bars()
        at = lambda phi: u * (mean + lift * mp.cos(phi - phase) + 1j * mp.mpf(offset))  # noqa: E731
        body = self.link("follower", at, lambda phi: u)
        self.slide("guide", "follower", None, at, lambda phi: u)
        self._roller("follower", at)
        law = ks.laws.cosine(lift, mean, phase)
        return crank, bars, ks.RollerFollower(law, ks.Guide.at(angle, offset), body)

    def _swinging_follower(self):
        """Swinging follower on a cam of the crank, and a four-bar."""
        lift, mean, phase, side = self.real(0.05, 0.15), self.real(0.6, 0.8), self.real(-3, 3), 1
        crank, bars, pivot, arm = self._crank(self.r), self._bars(), self.real(0.12, 0.14), self.real(0.09, 0.11)
        p = lambda phi: -mp.expj(-side * (mean + lift * mp.cos(phi - phase)))  # noqa: E731
        at = lambda phi: pivot + arm * p(phi)  # noqa: E731
        body = self.link("arm", lambda phi: mp.mpc(pivot), p)
        self.pin("Q", "arm", None, lambda phi: mp.mpc(pivot))
        self._roller("arm", at)
        return crank, bars, ks.SwingingFollower(ks.laws.cosine(lift, mean, phase), arm, (pivot, 0.0), side, body)

    def _roller(self, on, at):
        mu, pin_radius, radius = self.scale * self.real(0, 0.1), self.real(0.004, 0.006), self.real(0.012, 0.02)
        arm = self.scale * self.real(0.0, 0.002)
        self.friction["contact"] = ks.RollerFriction(mu, pin_radius, radius, arm)
        self.joints["contact"] = Roller(on, at, mp.mpf(mu) * pin_radius, mp.mpf(radius), "crank", mp.mpf(arm))

    def _bars(self):
        a = self.r
        b, h, pivot = self.real(2, 3) * a, self.real(2.2, 3) * a, (self.real(2, 2.5) * a, self.real(-0.5, 0.5) * a)
        side, O2 = int(self.rng.choice([-1, 1])), mp.mpc(*pivot)
        B = lambda phi: circles_meet(self.A(phi), b, O2, h, side)  # noqa: E731
        q = lambda phi: (B(phi) - self.A(phi)) / b  # noqa: E731
        p = lambda phi: (B(phi) - O2) / h  # noqa: E731
        group = ks.RockerGroup(
            b,
            h,
            pivot,
            side,
            coupler=self.link("coupler", self.A, q),
            rocker=self.link("rocker", lambda phi: O2, p),
        )
        self.pin("A", "coupler", "crank", self.A)
        self.pin("B", "rocker", "coupler", B)
        self.pin("O2", "rocker", None, lambda phi: O2)
        self.B, self.q = B, q
        return group

    def _four_bar(self):
        return self._crank(self.r), self._bars()

    def _six_bar(self):
        return self._crank(self.r), self._bars(), self._sliding(self.B, "rocker", "B", "C", "2")

    def _coupler_point(self):
        along, across = self.real(0.5, 1.5) * self.r, self.real(-0.5, 0.5) * self.r
        crank, bars = self._crank(self.r), self._bars()
        point = lambda phi: self.A(phi) + mp.mpc(along, across) * self.q(phi)  # noqa: E731
        pin = ks.Pin(on="coupler", at=(along, across), name="C")
        return crank, bars, pin, self._sliding(point, "coupler", "C", "D", "2")

    def _dyad(self):
        """Dyad between the rocker's end and a further pin of the crank."""
        crank, bars = self._crank(self.r), self._bars()
        along = self.real(-0.6, -0.3) * self.r
        point = lambda phi: along * mp.expj(phi)  # noqa: E731
        one, two = self.real(4, 5) * self.r, self.real(4, 5) * self.r
        side = int(self.rng.choice([-1, 1]))
        D = lambda phi: circles_meet(self.B(phi), one, point(phi), two, side)  # noqa: E731
        dyad = ks.Dyad(
            one,
            two,
            ("B", "C"),
            assembly=side,
            dyad1=self.link("dyad1", self.B, lambda phi: (D(phi) - self.B(phi)) / one),
            dyad2=self.link("dyad2", point, lambda phi: (D(phi) - point(phi)) / two),
        )
        self.pin("dyad1_B", "dyad1", "rocker", self.B)
        self.pin("dyad2_C", "dyad2", "crank", point)
        self.pin("D", "dyad2", "dyad1", D)
        return crank, bars, ks.Pin(on="crank", at=(along, 0.0), name="C"), dyad

    def _lever(self):
        crank = self._crank(self.r)
        pivot = self.real(-0.5, 0.5) * self.r, self.real(-2.5, -1.5) * self.r
        offset, O2 = self.real(-0.3, 0.3) * self.r, mp.mpc(*pivot)

        def direction(phi):
            d = self.A(phi) - O2
            return d / mp.mpc(mp.sqrt(abs(d) ** 2 - mp.mpf(offset) ** 2), offset)

        lever = ks.LeverGroup(
            pivot,
            offset=offset,
            lever=self.link("lever", lambda phi: O2, direction),
            block=self.link("block", self.A, direction),
        )
        self.pin("A", "block", "crank", self.A)
        self.pin("O2", "lever", None, lambda phi: O2)
        self.slide("slot", "block", "lever", self.A, direction)
        return crank, lever

    def _cylinder(self):
        crank = self._crank(self.r)
        pivot = self.real(-0.5, 0.5) * self.r, self.real(-4, -2) * self.r
        O2 = mp.mpc(*pivot)
        towards = lambda phi: (self.A(phi) - O2) / abs(self.A(phi) - O2)  # noqa: E731
        group = ks.CylinderGroup(
            pivot,
            rod=self.link("rod", self.A, lambda phi: -towards(phi)),
            cylinder=self.link("cylinder", lambda phi: O2, towards),
        )
        self.pin("A", "rod", "crank", self.A)
        self.pin("O2", "cylinder", None, lambda phi: O2)
        self.slide("cylinder", "rod", "cylinder", lambda phi: O2, towards)
        self.joints["cylinder"].moving = self.A
        return crank, group

    def _yoke(self):
        crank = self._crank(self.r)
        angle, offset, beta = self.real(-3, 3), self.real(-0.3, 0.3) * self.r, self.real(1.1, 2.0)
        guide = ks.Guide.at(angle, offset)
        u = mp.mpc(*map(float, guide.direction))
        along = u * mp.expj(beta)
        force = self.real(-300, 300)

        def slider(phi):
            a = self.A(phi) / u
            return u * (mp.re(a) - (mp.im(a) - offset) * mp.cot(beta) + 1j * offset)

        group = ks.YokeGroup(
            guide,
            beta,
            slider=self.link("slider", slider, lambda phi: u),
            block=self.link("block", self.A, lambda phi: along),
        )
        self.pin("A", "block", "crank", self.A)
        self.slide("guide", "slider", None, slider, lambda phi: u)
        self.slide("slot", "block", "slider", self.A, lambda phi: along)
        self.joints["guide"].half_length = half = self.real(2, 4) * self.r
        self.friction["guide"] = ks.GuideFriction(self.friction["guide"].mu, half)
        self.applied.append(("slider", lambda phi: force * u, slider))
        self.loads = (ks.ProcessForce(force),)
        return crank, group


def differences(kind, seed, scale=1.0, changed=None):
    """Largest difference of forces, friction, losses and torque from a full system, relative; and the solution."""
    drawn = Drawn(kind, seed, scale)
    if changed is not None:
        changed(drawn)
    angle = float(np.random.default_rng(seed).uniform(0.0, 2 * np.pi))
    solution = drawn.scene.solve(angle)
    with mp.workdps(40):
        forces, torque, friction, loss = drawn.system.forces(angle)
        pins = {name: complex(forces[name]) for name, joint in drawn.joints.items() if isinstance(joint, Pin)}
        size = max(map(abs, pins.values()))
        found = [abs(complex(*solution.reaction(name)) - force) for name, force in pins.items()]
        for name, joint in drawn.joints.items():
            if isinstance(joint, Roller):
                found.append(abs(float(solution.scalar(f"{name}_force") - forces[name])))
            elif not isinstance(joint, Pin):
                head, label = next((head, name[len(head) :]) for head in ("guide", "slot", "cylinder") if head in name)
                found.append(abs(float(solution.scalar(f"{head}_force{label}") - mp.re(forces[name]))))
                if f"{head}_moment{label}" in solution.scalars:
                    found.append(abs(float(solution.scalar(f"{head}_moment{label}") - mp.im(forces[name]))) / drawn.r)
            found.append(abs(float(solution.friction_at(name) - friction[name])))
            found.append(
                abs(float(solution.friction_loss_at(name) - loss[name])) / max(1.0, abs(drawn.speed) * drawn.r)
            )
        found.append(abs(float(solution.balancing_torque - torque)) / drawn.r)
    return max(found) / size, solution
