"""The documentation site: everything it shows and links to is made here, offline."""

import os
import shutil
import sys
from importlib.metadata import version as version_of
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE / "_extensions"))

# Notebooks live at the top of the repository; Sphinx reads what lies beside this file, with shorter links.
shutil.rmtree(HERE / "notebooks", ignore_errors=True)
shutil.copytree(HERE.parent / "notebooks", HERE / "notebooks", ignore=shutil.ignore_patterns(".*"))
for notebook in (HERE / "notebooks").glob("*.ipynb"):
    notebook.write_text(notebook.read_text(encoding="utf-8").replace("](../docs/", "](../"), encoding="utf-8")

# Figures of the pages' code: SVG, small and sharp.
kernel = HERE / "_build" / "ipython" / "profile_default" / "ipython_kernel_config.py"
kernel.parent.mkdir(parents=True, exist_ok=True)
kernel.write_text(
    """c = get_config()
c.InlineBackend.figure_formats = {"svg"}
c.InlineBackend.rc = {"figure.figsize": (6.4, 3.6), "font.size": 9, "svg.hashsalt": "kinetostatics"}
""",
    encoding="utf-8",
)
os.environ["IPYTHONDIR"] = str(kernel.parents[1])
os.environ.pop("MPLBACKEND", None)  # another one would show no figures

project = "kinetostatics"
author = "the kinetostatics developers"
copyright = author  # noqa: A001 - Sphinx's name
version = release = version_of("kinetostatics")

extensions = [
    "casefile_keys",
    "forked_kernels",
    "mathml",
    "myst_nb",
    "notebook_pages",
    "offline",
    "numpydoc",
    "public_names",
    "sphinx.ext.autodoc",
]
exclude_patterns = ["_build", "**.ipynb_checkpoints", "README.md"]
nitpicky = True

# Pages: MyST. Their code cells run at build; notebooks are committed with their outputs.
myst_enable_extensions = ["amsmath", "colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3
nb_execution_mode = "auto"
nb_execution_excludepatterns = ["notebooks/*.ipynb"]
nb_execution_raise_on_error = True
nb_execution_timeout = 120
nb_execution_in_temp = True  # what pages write is gone
nb_ipywidgets_js = {}  # widgets would load scripts from elsewhere
nb_merge_streams = True
html_math_renderer = "mathml"

autodoc_typehints = "none"  # docstrings say types, shapes and units
default_role = "literal"  # single backticks in docstrings
toc_object_entries_show_parents = "hide"
numpydoc_show_class_members = False

html_theme = "pydata_sphinx_theme"
html_title = "kinetostatics"
html_static_path = ["_static"]
html_css_files = ["site.css"]
alone = (
    "index",
    "start",
    "command_line",
    "casefile",
    "explore",
    "how_sure",
    "gallery",
    "glossary",
    "contributors",
    "search",
)
html_sidebars = {page: [] for page in alone}
html_show_sourcelink = False
html_theme_options = {
    "header_links_before_dropdown": 6,
    "navbar_end": ["theme-switcher"],
    "secondary_sidebar_items": ["page-toc"],
    "footer_start": ["copyright"],
    "footer_end": [],
    "show_prev_next": True,
}


def setup(app):
    """Build pages, and run their code, on all processors."""
    app.parallel = max(app.parallel, os.cpu_count() or 1)
