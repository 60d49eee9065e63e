"""What is looked at before a solution is handed out: whether it closes, whether friction jams, whether loads apply."""

from ..machine.loads import refusals
from ..mechanics import energy_contact, jamming
from ..mechanics.load_values import require_pure
from ..numbers import checks


def check_solution(solution, on_gap="raise"):
    """The solution, its friction found, if nothing stands against it; `on_gap` as for `solve`."""
    (solution.check if on_gap == "raise" else solution.warn)()
    if solution.friction.acting:
        checks.require("solve", jamming.problem_at_rest(solution))
        solution = jamming.solve_friction(solution, jamming.checks_of)
        jamming.check(solution, on_gap)
    if not solution.loads_are_given:
        require_pure(solution)
    checks.require("solve", *refusals(solution), *(energy_contact.refusals(solution) if on_gap == "raise" else ()))
    return solution
