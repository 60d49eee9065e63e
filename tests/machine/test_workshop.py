"""What the workshop is given: files read back give the same points, nothing is half written."""

import re
import sys
import xml.etree.ElementTree as ET

import numpy as np
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks
from kinetostatics.numbers.files import read_columns

CUT_CAM = ks.cams.CosineLaw(0.3, 2.0)
GIVEN = {"roller_radius": 0.05, "cutter_radius": 0.02, "points": 500}
UNITS = {"mm": 1e-3, "cm": 1e-2, "m": 1.0, "in": 0.0254}


@pytest.mark.slow
@pytest.mark.parametrize("units", UNITS)
def test_a_dxf_read_back_gives_the_same_points(tmp_path, units):
    ezdxf = pytest.importorskip("ezdxf")
    CUT_CAM.export(tmp_path / "cam.dxf", units=units, **GIVEN)
    drawing = ezdxf.readfile(tmp_path / "cam.dxf")
    made = CUT_CAM.profile(0.05, 500)
    for layer, points in (("PITCH", made.pitch), ("SURFACE", made.surface), ("CUTTER", made.cutter_path(0.02))):
        (line,) = drawing.modelspace().query(f'LWPOLYLINE[layer=="{layer}"]')
        assert line.closed
        assert_allclose(
            UNITS[units] * np.array([point[:2] for point in line.get_points()]).T, points, rtol=0, atol=1e-15
        )
    assert drawing.units == {"mm": 4, "cm": 5, "m": 6, "in": 1}[units]
    texts = [text.dxf.text for text in drawing.modelspace().query("TEXT")]
    assert any("roller goes around counter-clockwise" in text for text in texts)
    assert "0" in texts


@pytest.mark.parametrize("units", UNITS)
def test_csv_gives_back_points_and_cam(tmp_path, units):
    CUT_CAM.export(tmp_path / "cam.csv", units=units, **GIVEN)
    names = dict.fromkeys(("roller_x", "roller_y", "surface_x", "surface_y", "cutter_x", "cutter_y", "radius"), "m")
    columns = dict(zip(names, read_columns(tmp_path / "cam.csv", names), strict=True))
    made = CUT_CAM.profile(0.05, 500)
    for name, points in (("roller", made.pitch), ("surface", made.surface), ("cutter", made.cutter_path(0.02))):
        assert_allclose([columns[f"{name}_x"], columns[f"{name}_y"]], points, rtol=0, atol=1e-15)
    again = ks.cams.Sampled.from_csv(tmp_path / "cam.csv")
    assert_allclose(again.radius(0.123)[2], CUT_CAM.radius(0.123)[2], atol=1e-9)


def test_a_measured_cam_states_the_error_of_the_forces(tmp_path):
    angle = np.radians(np.arange(360))
    cam = ks.cams.Sampled(angle, np.round(CUT_CAM.radius(angle)[0], 6), noise=0.29e-6)
    for ending in ("csv", "svg"):
        cam.export(tmp_path / f"cam.{ending}", roller_radius=0.05, points=60)
        assert "forces are uncertain by 0.0004" in (tmp_path / f"cam.{ending}").read_text(encoding="utf-8")


def test_what_cannot_be_cut_leaves_the_file_as_it_was(tmp_path):
    for name in ("cam.svg", "cam.csv"):
        (tmp_path / name).write_text("as it was")
        for wrong in ({"roller_radius": 0.4}, {"roller_radius": 0.05, "side": "ring", "cutter_radius": 0.4}):
            with pytest.raises(ks.ParameterError, match=r"undercuts|does not fit"):
                CUT_CAM.export(tmp_path / name, points=60, **wrong)
        assert (tmp_path / name).read_text() == "as it was"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["cam.csv", "cam.svg"]


def test_a_dxf_without_ezdxf_names_the_extra(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "ezdxf", None)
    with pytest.raises(ks.KinetostaticsError, match=r'pip install "kinetostatics\[workshop\]"'):
        CUT_CAM.export(tmp_path / "cam.dxf", roller_radius=0.05, points=60)
    assert not list(tmp_path.iterdir())


# Drawings of cams


def read_svg(path):
    root = ET.parse(path).getroot()
    return root, {"svg": "http://www.w3.org/2000/svg"}


@pytest.mark.parametrize("side", ["disk", "ring"])
def test_drawing_is_one_to_one(tmp_path, side):
    CUT_CAM.export(tmp_path / "cam.svg", side=side, **GIVEN)
    root, space = read_svg(tmp_path / "cam.svg")
    left, top, width, height = map(float, root.get("viewBox").split())
    assert root.get("width") == f"{width:.6g}mm"
    assert root.get("height") == f"{height:.6g}mm"
    path = root.find("svg:path[@id='surface']", space).get("d")
    points = np.array(re.findall(r"(\S+) (\S+)(?= [LZ])", path), dtype=float).T * [[1e-3], [-1e-3]]
    made = CUT_CAM.profile(0.05, 500, side)
    assert_allclose(points, made.surface, rtol=0, atol=1e-9)
    for x, y in 1e3 * made.surface.T:
        assert left < x < left + width
        assert top < -y < top + height


def test_drawing_has_dimensions_and_rotation_mark(tmp_path):
    CUT_CAM.export(tmp_path / "cam.svg", clockwise=True, **GIVEN)
    root, space = read_svg(tmp_path / "cam.svg")
    texts = [item.text for item in root.findall("svg:text", space)]
    for expected in ("0° zero mark", "roller goes clockwise", "500 mm", "roller ⌀ 100 mm"):
        assert expected in texts
    assert "smallest R 278.095 mm at 0°" in texts
    assert "largest R 321.905 mm at 180°" in texts
