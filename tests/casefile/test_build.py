"""A variant made a scene: what its file leaves out is derived, and what balances it is found."""

import pytest

import kinetostatics as ks

HEAD = """
title = "t"
reference = "a"
[variants.a]
crank_speed = "60 rpm"
slider = { mass = "10 kg" }
"""
SAW = HEAD + 'mechanism = "crank-slider"\ncrank_length = "300 mm"\ncoupler_length = "2 m"\n'


def variant(folder, text):
    path = folder / "case.toml"
    path.write_text(text, encoding="utf-8")
    return ks.load_case(path).variant("a")


def test_the_law_of_a_cam_gives_the_length_left_out(tmp_path):
    text = HEAD + 'mechanism = "cam-crank-slider"\ncam = { kind = "cosine-law", amplitude = "0.3 m", mean = "2 m" }\n'
    (group,) = variant(tmp_path, text).mechanism.groups[1:]
    assert group.coupler_length == ks.cams.CosineLaw(0.3, 2.0).coupler_length
    with pytest.raises(ks.CaseError, match="only a cosine-law cam fixes it"):
        variant(tmp_path, HEAD + 'mechanism = "cam-crank-slider"\ncam = { kind = "circle", radius = "0.3 m" }\n')


def test_balancing_without_a_weight_on_the_crank_is_refused(tmp_path):
    text = SAW + '[variants.a.balancing]\nmethod = "full"\ncoupler = { arm = "-0.2 m" }\n'
    with pytest.raises(ks.CaseError, match=r"needs a counterweight on the crank|balancing"):
        variant(tmp_path, text)
