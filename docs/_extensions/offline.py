"""The built pages load nothing from elsewhere: no script, style, font or picture."""

import re

from sphinx.errors import ExtensionError

LOADED = re.compile(
    r"""<(?:script|img|iframe|source)[^>]*\ssrc=["'](?:https?:)?//[^>]*>|<link[^>]*\shref=["'](?:https?:)?//[^>]*>"""
)
IMPORTED = re.compile(r"""(?:@import|url\()\s*["']?(?:https?:)?//[^)"']*""")


def check(app, exception):
    """Stop the build where a page or a style loads from another host."""
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


def setup(app):
    """Check when all is built."""
    app.connect("build-finished", check)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
