"""What derived classes still say of what they give anew."""

from kinetostatics.numbers.inherited import say_together
from support.every import every


class Both:
    whole = parts = "first"


class Same(Both):
    """Gives nothing anew."""


class OtherWhole(Both):
    whole = "another"


class OtherParts(Both):
    parts = "others"


class BothAnew(OtherWhole):
    whole = parts = "third"


@every(
    "kind, expected",
    [(Both, True), (Same, True), (OtherWhole, False), (OtherParts, True), (BothAnew, True), (object, False)],
)
def test_parts_are_those_of_a_whole_unless_that_alone_is_given_anew(kind, expected):
    assert say_together(kind, "parts", "whole") is expected


def test_whichever_of_the_others_is_given_last_counts():
    assert say_together(OtherWhole, "whole", "whole", "parts")
    assert not say_together(OtherParts, "whole", "whole", "parts")
