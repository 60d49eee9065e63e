"""A plain case as text, complete and right."""

PLAIN = """
title = "test"
reference = "plain"
[common]
crank_speed = "320 rpm"
[common.coupler]
mass = "150 kg"
centre = "mid-length"
inertia = "20.5 kg m^2"
[common.slider]
mass = "600 kg"
[variants.plain]
mechanism = "crank-slider"
crank_length = "300 mm"
coupler_length = "2 m"
"""
