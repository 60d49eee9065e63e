"""The built pages load nothing from elsewhere, no script, style, font or picture, and little from here."""

import re

from sphinx.errors import ExtensionError

LOADED = re.compile(
    r"""<(?:script|img|iframe|source)[^>]*\ssrc=["'](?:https?:)?//[^>]*>|<link[^>]*\shref=["'](?:https?:)?//[^>]*>"""
)
IMPORTED = re.compile(r"""(?:@import|url\()\s*["']?(?:https?:)?//[^)"']*""")
PICTURE = re.compile(r"""<img[^>]*\ssrc=["']([^"':]+)["']""")
MOST = 300_000
"""Bytes of pictures on a page."""
LARGER = {"gallery.html": 700_000, "explore.html": 1_500_000}
"""The page of pictures takes more, and the film of the explore page."""


def check(app, exception):
    """Stop the build where a page or a style loads from another host, or a page too many bytes of pictures."""
    if exception or app.builder.format != "html":
        return
    found = {
        f"{path.relative_to(app.outdir)}: {hit}"
        for ending, pattern in (("html", LOADED), ("css", IMPORTED))
        for path in app.outdir.rglob(f"*.{ending}")
        for hit in pattern.findall(path.read_text(encoding="utf-8"))
    }
    if found:
        raise ExtensionError("loaded from elsewhere:\n" + "\n".join(sorted(found)))
    sizes = {path.relative_to(app.outdir).as_posix(): pictures(path) for path in app.outdir.rglob("*.html")}
    most = {page: LARGER.get(page, MOST) for page in sizes}
    large = [
        f"{page}: {size} bytes of pictures, {most[page]} at most" for page, size in sizes.items() if size > most[page]
    ]
    if large:
        raise ExtensionError("\n".join(large))


def pictures(path):
    """Bytes of the pictures of a page."""
    files = {(path.parent / name).resolve() for name in PICTURE.findall(path.read_text(encoding="utf-8"))}
    return sum(file.stat().st_size for file in files if file.exists())


def setup(app):
    """Check when all is built."""
    app.connect("build-finished", check)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
