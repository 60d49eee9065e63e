"""Formulas: recorded arithmetic as trees, gathered as by hand, the value kept."""

from kinetostatics.engines.graph import Graph, Node
from kinetostatics.explain.formats import TEXT, Symbol, write_formula
from kinetostatics.explain.formulas import formula, names_in
from tests.support.every import every


def spelled(make):
    """Text of what is made of recorded numbers a, b, c."""
    graph = Graph()
    given = [graph.parameter(place) for place in range(3)]
    tree = formula(make(*given), set(given))
    return write_formula(tree, TEXT, lambda place: Symbol("abc"[place]))


@every(
    "make, text",
    [
        (lambda a, b, c: a + b - c, "a + b - c"),
        (lambda a, b, c: a - (b + c), "a - (b + c)"),
        (lambda a, b, c: a - (b - c), "a - (b - c)"),
        (lambda a, b, c: (a + b) * c, "(a + b)*c"),
        (lambda a, b, c: a * (b / c), "a*(b/c)"),
        (lambda a, b, c: a / (b * c), "a/(b*c)"),
        (lambda a, b, c: a / b / c, "a/b/c"),
        (lambda a, b, c: a * a * b, "a^2*b"),
        (lambda a, b, c: (a + b) * (a + b), "(a + b)^2"),
        (lambda a, b, c: -a * b + c, "-a*b + c"),
        (lambda a, b, c: a * -b, "-a*b"),
        (lambda a, b, c: -(a + b), "-(a + b)"),
        (lambda a, b, c: c - a / -b, "c + a/b"),
        (lambda a, b, c: 0.0 * a + b, "b"),
        (lambda a, b, c: 0.0 - a, "-a"),
        (lambda a, b, c: 2.0 * a + 0.1, "2*a + 0.1"),
        (lambda a, b, c: -1.0 * a, "-a"),
        (lambda a, b, c: a.sin() * b.cos() + abs(c), "sin(a)*cos(b) + abs(c)"),
        (lambda a, b, c: a.forgiving_root(b * b), "sqrt(a)"),
        (lambda a, b, c: a.kept_off_zero(b) * c, "a*c"),
        (lambda a, b, c: a.moved_apart(b), "a"),
        (lambda a, b, c: (a * a + 1e-290).sqrt(), "sqrt(a^2)"),
        (lambda a, b, c: 0.5 * (a + b + abs(a - b)), "max(a, b)"),
        (lambda a, b, c: a.held() + b.arctan() * c.sign(), "a + atan(b)*sign(c)"),
    ],
)
def test_what_is_there_for_rounding_is_left_out_and_signs_and_factors_are_gathered(make, text):
    assert spelled(make) == text


def test_a_formula_names_where_it_ends_each_once_in_order():
    graph = Graph()
    a, b = graph.parameter(0), graph.parameter(1)
    inner = b * b
    tree = formula(inner * a + inner, {a, inner})
    assert [graph[place] is node for place, node in zip(names_in(tree), (inner, a), strict=True)] == [True, True]


def test_one_number_may_stand_for_another():
    graph = Graph()
    a = graph.parameter(0)
    turned = -a
    held = Node(graph, "held", (turned,), turned.varies)
    assert formula(turned * a, {a, held}, {turned: held}) == ("product", ("name", held.index), ("name", a.index))
    assert formula(held, {a, held}, {turned: held}) == ("negative", ("name", a.index))
