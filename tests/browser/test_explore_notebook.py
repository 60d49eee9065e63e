"""The explore page in a notebook of JupyterLab: curves follow a slider, the next cell has the scene that is shown."""

import json
import os
import re
import subprocess
import sys
import time
from contextlib import suppress

import pytest

pytest.importorskip("anywidget")
pytest.importorskip("jupyterlab")
pytest.importorskip("selenium")
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import WebDriverWait

pytestmark = pytest.mark.slow
TOKEN = "token-of-this-test"
PATIENCE = 90.0
"""Seconds in which a notebook starts and answers on a machine that is busy with other tests."""
CELLS = [
    "import kinetostatics as ks\nw = ks.explore('sawframe_2r63', variant='cam-circle')\nw",
    "print('mass', w.scene.parameters['slider.mass'], w.state)",
    "v = ks.explore(w.scene)\nv",
    "w.state = {'variant': 'plain', 'values': {'slider.mass': 500.0}}",
    "import os; os._exit(1)",
]


def notebook(cells):
    kernel = {"name": "python3", "display_name": "Python 3", "language": "python"}
    empty = {"cell_type": "code", "metadata": {}, "execution_count": None, "outputs": []}
    cells = [empty | {"id": f"cell{number}", "source": text} for number, text in enumerate(cells)]
    return {"nbformat": 4, "nbformat_minor": 5, "metadata": {"kernelspec": kernel}, "cells": cells}
