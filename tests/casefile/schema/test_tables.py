"""Tables within a variant."""

from support.case_files import problems
from support.plain_case import PLAIN


def test_a_cam_of_a_kind_that_is_not_there_is_told_the_nearest(tmp_path):
    text = PLAIN + '[variants.cam]\nmechanism = "cam-crank-slider"\ncoupler_length = "2 m"\ncam = { kind = "cirkle" }\n'
    kind, radius = problems(tmp_path, text)
    assert kind.startswith("variants.cam.cam.kind is 'cirkle'")
    assert "did you mean 'circle'?" in kind
    assert radius == "variants.cam.cam.radius is missing"
