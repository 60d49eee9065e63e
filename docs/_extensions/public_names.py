"""API pages: tables of public names, each with a page of its own; names in the text lead there.

``{api}`` in a page lists names as users call them, without the ``ks.``; with ``:members:`` their pages show all that
the objects give too.
"""

import inspect
import re
import sys
import types
from functools import reduce

from docutils import nodes
from docutils.parsers.rst import directives
from numpydoc.docscrape import ClassDoc
from sphinx import addnodes
from sphinx.pycode import ModuleAnalyzer
from sphinx.util.docutils import SphinxDirective
from sphinx.util.nodes import make_refnode

import kinetostatics as ks

CALLED = re.compile(r"(?:ks|kinetostatics)((?:\.\w+)+)")

CLASSES = {name for name in ks.__all__ if name[0].isupper()}
"""Names that docstrings call without the ``ks.``."""


class Api(SphinxDirective):
    """A table of public names, one a line, each with the first sentence of what it says of itself."""

    has_content = True
    option_spec = {"members": directives.flag}  # noqa: RUF012 - as docutils declares it

    def run(self):
        """The table, and the pages of its names below this one."""
        pages = [f"api/generated/{full(name)}" for name in self.content]
        shown = {"hidden": True, "glob": False, "maxdepth": 1, "caption": None, "numbered": 0, "titlesonly": True}
        entries = {"parent": self.env.docname, "entries": [(None, page) for page in pages], "includefiles": pages}
        below = addnodes.toctree(**shown, **entries)
        body = nodes.tbody("", *(self.row(name) for name in self.content))
        columns = [nodes.colspec(colwidth=35), nodes.colspec(colwidth=65)]
        group = nodes.tgroup("", *columns, body, cols=2)
        return [nodes.compound("", below, classes=["toctree-wrapper"]), nodes.table("", group, classes=["api"])]

    def row(self, name):
        """Name that leads to its page, and its first sentence."""
        link = addnodes.pending_xref(
            "", nodes.literal("", f"ks.{name}"), refdomain="py", reftype="obj", reftarget=full(name), refexplicit=True
        )
        said = first_sentence(name)
        parts = [nodes.literal("", part) if odd else nodes.Text(part) for odd, part in said]
        cells = [nodes.paragraph("", "", link), nodes.paragraph("", "", *parts)]
        return nodes.row("", *(nodes.entry("", cell) for cell in cells))


def found(name):
    """What users call ``ks.name``."""
    return reduce(getattr, name.split("."), ks)


def kind_of(name):
    """What documents a name: class, function or data."""
    item = found(name)
    return "class" if isinstance(item, type) else "function" if inspect.isroutine(item) else "data"


def docstring(name):
    """What a name says of itself; data in the text that stands below its value."""
    if kind_of(name) != "data":
        return inspect.getdoc(found(name))
    module, _, own = name.rpartition(".")
    told = ModuleAnalyzer.for_module(found(module).__name__).find_attr_docs().get(("", own))
    return "\n".join(told).strip() if told else f"Entries: {', '.join(map(str, found(name)))}."


def first_sentence(name):
    """First paragraph of what a name says of itself, in parts: whether each is literal, and its text."""
    line = docstring(name).partition("\n\n")[0].replace("\n", " ")
    return [(number % 2, part) for number, part in enumerate(re.split("`+", line)) if part]


def full(name):
    """Name by which Python finds what users call ``ks.name``."""
    return f"kinetostatics.{name}"


def modules():
    """Public modules of names, as ``ks.cams``, by name."""
    return {name: found for name in ks.__all__ if isinstance(found := getattr(ks, name), types.ModuleType)}


def listed(text):
    """Names in the directives of a page: pairs of name and whether its members are shown."""
    pairs = []
    for options, names in re.findall(r"```\{api\}\n((?::\w+:\n)*)(.*?)```", text, flags=re.DOTALL):
        pairs += [(name, ":members:" in options) for name in names.split()]
    return pairs


def write_pages(app):
    """A page for each name that pages of the folder ``api`` list."""
    folder = app.srcdir / "api" / "generated"
    folder.mkdir(exist_ok=True)
    wanted = {}
    for page in sorted((app.srcdir / "api").glob("*.md")):
        for name, members in listed(page.read_text(encoding="utf-8")):
            wanted[f"{full(name)}.rst"] = page_of(name, members)
    for path in folder.glob("*.rst"):
        if path.name not in wanted:
            path.unlink()
    for file, text in wanted.items():
        path = folder / file
        if not path.exists() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")


def page_of(name, members):
    """Text of the page of one name."""
    title, kind = f"ks.{name}", kind_of(name)
    if kind == "data":
        text = docstring(name).replace("\n", "\n   ")
        return f"{title}\n{'=' * len(title)}\n\n.. py:data:: {full(name)}\n\n   {text}\n"
    shown = f"   :members: {told(name)}\n   :inherited-members: object, Mapping\n" if members else ""
    return f"{title}\n{'=' * len(title)}\n\n.. auto{kind}:: {full(name)}\n{shown}"


def told(name):
    """Members that the docstring of a class lists; none where it does not, which stands for all."""
    listed = ClassDoc(found(name), config={"show_class_members": False})
    items = [*listed["Attributes"], *listed["Methods"]] if listed["Methods"] else []
    return ", ".join(re.findall(r"\w+(?=\(|,|$)", ", ".join(re.sub(r"\(.*?\)", "", item.name) for item in items)))


def only_told(app, what, name, item, skip, options):
    """Leave out members that were not asked for by name where some were, which inherited ones else are not."""
    asked = options.get("members")
    return True if isinstance(asked, list | tuple | set) and asked and name not in asked else None


def escape_bars(app, what, name, item, options, lines):
    """Leave ``|x|`` as it is written: no substitution, but a magnitude."""
    example = False
    for number, line in enumerate(lines):
        example = bool(line.strip()) and (example or line.lstrip().startswith(">>>"))
        if not example:
            parts = re.split("(``.*?``)", line)
            lines[number] = "".join(part if part.startswith("``") else part.replace("|", r"\|") for part in parts)


def link_names(app, doctree, docname):
    """Let names as ``ks.solve`` in literal text lead to their pages."""
    objects = app.env.domains["py"].objects
    for literal in list(doctree.findall(nodes.literal)):
        text = literal.astext()
        called = CALLED.match(f"ks.{text}" if text in CLASSES else text)
        if not called or isinstance(literal.parent, nodes.reference):
            continue
        parts = called[1][1:].split(".")
        names = (".".join(parts[:count]) for count in range(len(parts), 0, -1))
        name = next((name for name in names if full(name) in objects), None)
        if name is None or objects[full(name)].docname == docname:
            continue
        to = objects[full(name)]
        literal.replace_self(
            make_refnode(app.builder, docname, to.docname, to.node_id, literal.deepcopy(), f"ks.{name}")
        )


def setup(app):
    """Register the directive and what runs before and after reading."""
    sys.modules.update({full(name): found for name, found in modules().items()})
    app.add_directive("api", Api)
    app.connect("builder-inited", write_pages)
    app.connect("autodoc-skip-member", only_told)
    app.connect("autodoc-process-docstring", escape_bars, priority=900)  # after numpydoc
    app.connect("doctree-resolved", link_names)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
