"""The sawframe study: its case, its coefficients, and the cancellation that it reckons with."""

import kinetostatics as ks
from kinetostatics.studies.methods import papers
from support.case_files import shipped

CASE = shipped("sawframe_2r63")
PLAIN, CIRCLE, COSINE = (CASE.solve(name) for name in ("plain", "cam-circle", "cam-cosine"))
SLIDER = CASE.variant("cam-circle").mechanism.links["slider"].mass
CANCELLED = ks.solve(
    CIRCLE.mechanism,
    CIRCLE.crank_angle,
    crank_speed=CIRCLE.crank_speed,
    loads=[ks.Gravity(), ks.ProcessForce(lambda motion: SLIDER * motion.slider_acceleration)],
)
"""Right mechanics by the library itself, a force of minus the slider's inertia in place of the spring."""
PUBLISHED = {"n_d": [6.2, 7.55, 8.13, 6.42], "k_d": 6.77, "O": 12.0}
BY_PAPERS = papers.by_the_papers(papers.exactly_cancelled(CIRCLE))
COLUMNS = {
    "as printed": (papers.as_printed(CIRCLE), [6.178, 7.544, 8.131, 6.381], 6.724, 12.43, 53.87),
    "right sign": (BY_PAPERS, [7.099, 6.0, 6.317, 7.42], 6.629, 14.29, 53.87),
    "right sign, by the library": (CANCELLED, [7.099, 6.0, 6.317, 7.42], 6.629, 14.29, 53.87),
    "linear spring": (CIRCLE, [6.367, 5.498, 5.727, 6.598], 6.081, 12.87, 49.93),
    "linear spring, by the papers' formulas": (
        papers.by_the_papers(CIRCLE), [6.367, 5.498, 5.727, 6.598], 6.081, 12.87, 49.93,
    ),
}  # fmt: skip
