"""Drawings of cams: to scale, with dimensions, zero mark and sense of rotation."""

import re
import xml.etree.ElementTree as ET

import numpy as np
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks

LAW = ks.cams.CosineLaw(0.3, 2.0)
GIVEN = {"roller_radius": 0.05, "cutter_radius": 0.02, "points": 500}


def read_svg(path):
    root = ET.parse(path).getroot()
    return root, {"svg": "http://www.w3.org/2000/svg"}


@pytest.mark.parametrize("side", ["disk", "ring"])
def test_a_drawing_is_one_to_one_and_its_curve_the_profile(tmp_path, side):
    LAW.export(tmp_path / "cam.svg", side=side, **GIVEN)
    root, space = read_svg(tmp_path / "cam.svg")
    left, top, width, height = map(float, root.get("viewBox").split())
    assert root.get("width") == f"{width:.6g}mm"
    assert root.get("height") == f"{height:.6g}mm"
    path = root.find("svg:path[@id='surface']", space).get("d")
    points = np.array(re.findall(r"(\S+) (\S+)(?= [LZ])", path), dtype=float).T * [[1e-3], [-1e-3]]
    made = LAW.profile(0.05, 500, side)
    assert_allclose(points, made.surface, rtol=0, atol=1e-9)
    for x, y in 1e3 * made.surface.T:
        assert left < x < left + width
        assert top < -y < top + height


def test_a_drawing_has_dimensions_zero_mark_and_sense_of_rotation(tmp_path):
    LAW.export(tmp_path / "cam.svg", clockwise=True, **GIVEN)
    root, space = read_svg(tmp_path / "cam.svg")
    texts = [item.text for item in root.findall("svg:text", space)]
    for expected in ("0° zero mark", "roller goes clockwise", "500 mm", "roller ⌀ 100 mm"):
        assert expected in texts
    assert "smallest R 278.095 mm at 0°" in texts
    assert "largest R 321.905 mm at 180°" in texts
