"""Which of the allowed words is meant by one that is not: by what engineers call it elsewhere, else by its spelling."""

import re

SYNONYMS = {
    # machines
    "four_bar": ("fourbar", "crank_rocker", "double_crank", "double_rocker"),
    "crank_slider": ("slider_crank",),
    "slotted_lever": ("quick_return", "whitworth"),
    "scotch_yoke": ("yoke",),
    # engines
    "compiled": ("numba", "jit", "njit", "fast"),
    "numpy": ("np", "python"),
    "jax": ("gpu", "xla"),
    # reductions
    "largest": ("max", "maximum", "maximal", "peak", "highest", "greatest"),
    "smallest": ("min", "minimum", "minimal", "lowest", "least"),
    "largest_at": ("argmax", "max_at"),
    "smallest_at": ("argmin", "min_at"),
    "largest_absolute": ("max_abs", "absmax", "abs_max", "amplitude"),
    "mean_absolute": ("mean_abs", "abs_mean"),
    "mean": ("average", "avg"),
    "rms": ("root_mean_square", "effective"),
    "range": ("ptp", "peak_to_peak", "span"),
    # quantities
    "balancing_torque": ("torque", "moment", "drive_torque", "driving_torque", "input_torque", "crank_torque"),
    "guide_force": ("normal_force", "side_force", "side_thrust"),
    "slider_position": ("position", "displacement", "stroke", "travel"),
    "slider_velocity": ("velocity", "speed"),
    "slider_acceleration": ("acceleration",),
    "O": ("support", "bearing", "main_bearing"),
    "A": ("crank_pin", "crankpin"),
    "B": ("wrist_pin", "gudgeon_pin", "piston_pin", "slider_pin"),
    # parameters and links
    "crank_speed": ("omega", "rpm", "speed", "angular_velocity"),
    "crank_acceleration": ("alpha", "angular_acceleration"),
    "crank_length": ("crank_radius", "throw"),
    "coupler_length": ("rod_length", "conrod_length", "connecting_rod_length"),
    "guide_offset": ("offset", "eccentricity"),
    "coupler": ("rod", "conrod", "connecting_rod"),
    "slider": ("piston", "crosshead", "ram"),
    "rocker": ("follower", "output_link"),
}
"""What is called otherwise elsewhere, by the library's word."""
_MEANT: dict[str, list[str]] = {}
for _word, _others in SYNONYMS.items():
    for _other in _others:
        _MEANT.setdefault(_other, []).append(_word)
_UNIT = re.compile(r"\s*(?:\([^()]*\)|\[[^\[\]]*\])\s*$")
"""A unit behind a name, as headings have it."""
_PART = re.compile(r"([^\s.]*?)(\d*)(?=[\s.]|$)")
"""A word of a path or of an output, and the number of its label."""


def nearest(value, allowed):
    """The allowed word that is meant by, or is like, the one given without a unit and bars of a magnitude, or None."""
    import difflib

    text, allowed = _UNIT.sub("", str(value)[:100]).strip("|"), list(allowed)
    for spelled in (text, *_others_for(text.lower()), text.rpartition(" ")[2]):
        found = next((word for word in allowed if str(word).lower() == spelled.lower()), None)
        if found is not None:
            return found
    return next(iter(difflib.get_close_matches(text, allowed, n=1)), None)


def _others_for(text):
    """What a text may mean by the library's words: as a whole, else with each of its words as the library has it."""
    yield from _MEANT.get(text, ())
    yield _PART.sub(lambda found: _MEANT.get(found[1], [found[1]])[0] + found[2], text)
