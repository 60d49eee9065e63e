"""Check the language of the documents: ``python docs/check_prose.py [FILE ...]``, all checked files unless told.

Prints phrases that a reader has to read twice, each with a plain one, and sentences of more than 30 words. Code, link
targets and front matter are skipped; cells of tables are checked for phrases only.
"""

import ast
import json
import re
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]
CHECKED = ("README.md", "CHANGELOG.md", "docs/**/*.md", "notebooks/*.ipynb", "kinetostatics")
"""Trees that have to be clean."""
MADE = {"_build", "generated"}
DOCS_COPY = ROOT / "docs" / "notebooks"
"""Folders that the build of the pages makes."""
MAX_WORDS = 30
"""Words of a sentence."""

PHRASES = {
    r"what (is|are|was|were)\b(?![^.]*\?)": "name the thing: 'the slider', 'the value', 'which'",
    r"what (rubs|binds|looks|lives|turns|moves|stands|goes|comes|came|rolls|slides|runs|acts)\b": "name the thing",
    r"such(?! as\b)": "'this', 'these' or a relative clause",
    r"so (much|many)\b": "name the amount",
    r"that of (which|what)\b": "name the noun again",
    r"(is|are|was|be) asked (about|of)\b": "'a HintWarning suggests ...'",
    r"told\b": "'explained', 'described', 'reported', 'specified'",
    r"tells? (\w+ )*apart\b": "'distinguishes'",
    r"(says?|said|tells?|telling|saying) (what|how|where|who|which|whether|when|why|so)\b": "'describes', 'reports'",
    r"(hangs?|hung|hanging) (on|upon|from)\b": "'depends on', 'is attached to'",
    r"rub(s|bed)?\b": "'friction'",
    r"parted\b": "'split', 'separated'",
    r"taken (wherever|apart)\b": "'accepted', 'may be'",
    r"which extremes (says?|tells?)\b": "'`extremes` warns'",
    r"(where|if) none is\b": "'where no value exists'",
    r"buys?\b": "'reduces', 'gains'",
    r"goes by (joint|its|his|crank|travel|the)\b": "'is defined per joint', 'has the name'",
    r"stands? for (a|an|the) number": "'may be a function'",
    r"true (extrem(a|e|es)|peaks?)\b": "'exact peak values'",
    r"but for\b": "'except for'",
    r"anew\b": "'again'",
    r"by how much\b(?![^.]*\?)": "'the gain', 'the difference'",
    r"owes? (to|its)\b": "'depends on'",
    r"gives? way\b": "'is relaxed'",
    r"(have|has) in common\b": "'share', 'common'",
    r"nobody\b": "name the subject",
    r"(is|are) there,? too\b": "'also exists'",
}
"""Pattern of a phrase, without regard to capitals, and what to write in its place."""
RULES = [(re.compile(rf"(?<![\w'-])(?:{pattern})", re.IGNORECASE), advice) for pattern, advice in PHRASES.items()]
ANY = re.compile(rf"(?<![\w'-])(?:{'|'.join(PHRASES)})", re.IGNORECASE)

SKIPPED = re.compile(r"$|:\w+:|<!--|\(\w[\w-]*\)=$|[-=*]{3,}$|\*(uk|ru)\* ")
"""Lines of no sentence: options of directives, comments, targets, rules, terms in other languages."""
HEAD = re.compile(r"#+ |[-*+] |\d+\. |: |> ")
"""Begin of a heading, of an item of a list, of a quotation."""
PROSE_FENCES = re.compile(r"^(`{3,}|:{3,})\{(glossary|note|warning|tip|important|admonition|figure|dropdown)\}")
INLINE = [
    (re.compile(r"!?\[((?:[^\[\]]|\[[^\]]*\])*)\]\([^)]*\)"), r"\1"),  # links and pictures: their text
    (re.compile(r"\{[\w:]+\}(?=`)"), ""),  # roles
    (re.compile(r"(`+)(?:(?!\1).|\n)+?\1", re.DOTALL), "Code"),
    (re.compile(r"\$\$.+?\$\$", re.DOTALL), "Formula"),
    (re.compile(r"\$[^$]+\$"), "Formula"),
    (re.compile(r"<[^>\n]+>"), ""),
    (re.compile(r"\*\*|__|(?<!\w)[*_]|[*_](?!\w)"), ""),
    (re.compile(r"\bhttps?://\S+"), "Link"),
]
MARKS = re.compile(r"[`*_\[$<{]|http")
"""Begin of the marks of INLINE."""
ABBREVIATIONS = re.compile(r"\b(e\.g|i\.e|etc|cf|vs|approx|eqs?|[Ff]igs?|[Nn]os?|pp|vol|al)\.$")
NAMES = re.compile(r"\w+(\([\w, ]*\))?(, \w+(\([\w, ]*\))?)+")
"""Line of names of attributes or methods."""
END = re.compile(r"[.!?][\"')\]]*(?=\s+[\"'(\[]*[A-Z0-9\u0400-\u04ff]|\s*$)")
WORD = re.compile(r"[^\W_][\w'.,/^-]*")


def plain(text):
    """`text` without the marks of Markdown, code and formulas as one word, on the same lines."""
    for pattern, replacement in INLINE if MARKS.search(text) else ():

        def replaced(found, replacement=replacement):
            kept = found.expand(replacement)
            return kept + "\n" * (found[0].count("\n") - kept.count("\n"))

        text = pattern.sub(replaced, text)
    return text


def sentences(text, line=1):
    """Pairs of line and sentence of a paragraph."""
    text = plain(text)
    start = 0
    ends = [end.end() for end in END.finditer(text) if not ABBREVIATIONS.search(text[: end.start() + 1])]
    for end in [*ends, len(text)]:
        sentence = text[start:end]
        if sentence.strip():
            skipped = len(sentence) - len(sentence.lstrip())
            yield line + text.count("\n", 0, start + skipped), " ".join(sentence.split())
        start = end


def findings(blocks):
    """Pairs of line and complaint about blocks: line, text, whether sentences are counted."""
    for first, text, counted in blocks:
        for line, sentence in sentences(text, first):
            for rule, advice in RULES if ANY.search(sentence) else ():
                if found := rule.search(sentence):
                    yield line, f"'{found[0]}': write {advice}: {sentence[:110]}"
            if counted and len(sentence) > 2 * MAX_WORDS and (words := len(WORD.findall(sentence))) > MAX_WORDS:
                yield line, f"{words} words in one sentence, {MAX_WORDS} at most: {sentence[:110]}"


def markdown(text, first=1):
    """Blocks of a page: paragraphs, items of lists, headings, rows of tables."""
    lines = text.split("\n")
    fence, front = None, lines[0] == "---"
    block, start = [], first
    blocks = []

    def close():
        if block:
            blocks.append((start, "\n".join(block), True))
            block.clear()

    for number, line in enumerate(lines, first):
        stripped = line.strip()
        if front:
            front = not (stripped == "---" and number > first)
        elif fence:
            fence = None if stripped.startswith(fence) and not stripped.strip("`:$") else fence
        elif stripped.startswith(("```", ":::", "$$")) and not (stripped.startswith("$$") and stripped.count("$$") > 1):
            close()
            mark = re.match(r"`+|:+|\$+", stripped)[0]
            fence = None if PROSE_FENCES.match(stripped) or not stripped.strip("`:") else mark
        elif stripped.startswith("|"):
            close()
            blocks.append((number, stripped.replace("|", " . ").strip(" ."), False))
        elif SKIPPED.match(stripped) or line.startswith("    "):
            close()
        else:
            before = lines[number - first - 1]
            if HEAD.match(stripped) or before.startswith("#") or (line.startswith("  ") and re.match(r"\w", before)):
                close()
            if not block:
                start = number
            block.append(re.sub(r"^(#+|[-*+]|\d+\.|:|>) ", "", stripped))
    close()
    return blocks


def unreleased(text):
    """The part of the change log that is still written."""
    first = text[: text.index("## Unreleased")].count("\n") + 1
    return markdown(re.split(r"^## ", text, flags=re.MULTILINE)[1], first)


def docstring(text, first):
    """Blocks of a docstring: doctests, tables of plain text and heads of its parameters are skipped."""
    blocks, block, start, depth, code = [], [], first, 0, False
    lines = [*text.split("\n"), ""]
    for number, line in enumerate(lines, first):
        stripped, indent = line.strip(), len(line) - len(line.lstrip())
        code = bool(stripped) and (code or stripped.startswith((">>>", "|")))
        head = re.match(r"[\w*][\w*, ]* : |[-=~]{3,}", stripped) or re.search(r"\S {3,}\S", stripped)
        head = head or NAMES.fullmatch(stripped)
        if (
            not stripped
            or code
            or head
            or stripped.startswith(("- ", "* ", ".. "))
            or (block and indent != depth and number > first + 1)
        ):
            if block:
                blocks.append((start, "\n".join(block), True))
            block = []
        if stripped and not code and not head:
            if not block:
                start, depth = number, indent
            block.append(stripped)
    return blocks


def message(text, line):
    """A text of three words or more is a message, unless it is code, in lines or with braces."""
    return [] if text.count(" ") < 2 or re.search(r"[{}]|\n.*[=<;]", text) else [(line, text, True)]


WORDLESS = (ast.Name, ast.expr_context, ast.operator, ast.cmpop, ast.alias, ast.arguments)
"""Nodes of the syntax that hold no text."""


def module(text):
    """Blocks of a module of the package: docstrings, those of constants too, and texts of three words or more."""
    blocks, waiting = [], [ast.parse(text)]
    while waiting:
        node = waiting.pop()
        match node:
            case ast.Expr(value=ast.Constant(value=str(found))):
                blocks += docstring(found, node.lineno)
            case ast.Constant(value=str(found)):
                blocks += message(found, node.lineno)
            case ast.JoinedStr():
                parts = [part.value if isinstance(part, ast.Constant) else "N" for part in node.values]
                blocks += message("".join(parts), node.lineno)
            case _:
                waiting += [child for child in ast.iter_child_nodes(node) if not isinstance(child, WORDLESS)]
    return sorted(blocks)


def notebook(text):
    """Blocks of each cell of text, with its place."""
    for number, cell in enumerate(json.loads(text)["cells"], 1):
        if cell["cell_type"] == "markdown":
            yield number, markdown("".join(cell["source"]))


def checked(path):
    """Complaints about a file, each with its place."""
    name, text = path.relative_to(ROOT).as_posix(), path.read_text(encoding="utf-8")
    if path.suffix == ".ipynb":
        for cell, blocks in notebook(text):
            yield from (f"{name}: cell {cell}, line {line}: {complaint}" for line, complaint in findings(blocks))
        return
    reader = module if path.suffix == ".py" else unreleased if path.name == "CHANGELOG.md" else markdown
    yield from (f"{name}:{line}: {complaint}" for line, complaint in findings(reader(text)))


def paths(names=CHECKED):
    """All files of some trees, files and folders."""
    trees = [f"{name}/**/*" if (ROOT / name).is_dir() else name for name in names]
    found = {path for tree in trees for path in ROOT.glob(tree) if path.suffix in (".md", ".ipynb", ".py")}
    return sorted(path for path in found if not MADE & set(path.parts) and DOCS_COPY not in path.parents)


def main(names):
    """Print complaints; 1 if there are any."""
    complaints = [complaint for path in paths(names or CHECKED) for complaint in checked(path)]
    if complaints:
        print(*complaints, sep="\n")
    return bool(complaints)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
