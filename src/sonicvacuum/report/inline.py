"""Drawings and styles inside a page, so that it needs nothing but itself."""

import re
import zlib
from contextlib import suppress
from pathlib import Path

import jinja2
from markupsafe import Markup, escape

from sonicvacuum.files import read_text, reading
from sonicvacuum.physics import compiled
from sonicvacuum.report import tables

# Drawings of one journal column are not blown up to the width of the page; pt.
_COLUMN = 300.0


def environment(*packages: str) -> jinja2.Environment:
    """The templates of this package and of others; `number` shows a table's number legibly, `unit`
    its unit with a space before it, `formula` an equation, `typeset` a sentence."""
    found = jinja2.Environment(
        loader=jinja2.ChoiceLoader([jinja2.PackageLoader(p, ".") for p in ("sonicvacuum.report", *packages)]),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        bytecode_cache=_Kept(),
    )
    found.filters["number"] = lambda text, digits=4: typeset(tables.number(text, digits))
    found.filters["digits"] = lambda text, digits=4: typeset(tables.digits(text, digits))
    found.filters["unit"] = tables.unit_of
    found.filters["formula"] = formula
    found.filters["typeset"] = typeset
    return found


class _Kept(jinja2.BytecodeCache):
    """Compiled templates beside compiled kernels, where these can be kept: a page takes nearly half its time
    for them.
    """

    def load_bytecode(self, bucket):
        with suppress(OSError):
            if path := _path(bucket):
                bucket.bytecode_from_string(compiled.own(path))

    def dump_bytecode(self, bucket):
        with suppress(OSError):
            if path := _path(bucket):
                compiled.write(path, bucket.bytecode_to_string())


def _path(bucket):
    """A place of its own for each text of each template; None where there is no cache."""
    folder = compiled.cache_folder()
    name = f"page-{jinja2.__version__}-{bucket.key}-{bucket.checksum}.bin"
    return folder / name if folder else None


def svg(path, prefix: str, told: str = "") -> Markup:
    """The drawing in an SVG file with ids of its own, so that the clip paths of two drawings never meet.

    Args:
        path: of the file.
        prefix: put before every id.
        told: what a screen reader says.
    """
    with reading(path, "draw it again"):
        text = read_text(path)
        text = text[text.index("<svg") :]
    prefix = _identifier(prefix)
    text = re.sub(r'\bid="([^"]+)"', rf'id="{prefix}-\1"', text)
    text = re.sub(r"url\(#([^)]+)\)", rf"url(#{prefix}-\1)", text)
    text = re.sub(r'href="#([^"]+)"', rf'href="#{prefix}-\1"', text)
    label = f' role="img" aria-label="{escape(told)}"' if told else ""
    return Markup(text.replace("<svg", f"<svg{label}", 1))


def _identifier(name: str) -> str:
    """A name as part of an id, which holds no spaces, quotes or brackets; different names stay different."""
    plain = re.sub(r"[^A-Za-z0-9_.-]", "-", name)
    return plain if plain == name else f"{plain}-{zlib.crc32(name.encode()):08x}"


def is_narrow(path) -> bool:
    """Whether a drawing is one journal column wide."""
    found = re.search(r'<svg[^>]*\swidth="([\d.]+)pt"', Path(path).read_text(encoding="utf-8"))
    return bool(found) and float(found[1]) < _COLUMN


# What effects write in plain letters in their equations.
_GREEK = {"chi": "χ", "delta": "δ", "tau": "τ", "alpha": "α", "gamma": "γ", "epsilon": "ε"}

# Typed → set; `>` is escaped by then.
_SIGNS = {"-&gt;": "→", "sqrt(": "√(", " - ": " − ", "...": "…"}

_MINUS = re.compile(r"(?<![\w.^-])-(?=\d)")
_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
# 7.4e-4 as computers write it; digests and names that hold the like are longer words.
_POWER = re.compile(r"(?<![\w.])(\d+(?:\.\d+)?)e([+-]?)0*(\d{1,3})(?!\w|\.\d|…)")


def typeset(text) -> str:
    """A sentence of a table, typed in plain letters, with the signs of print: micro, minus, plus or minus,
    powers of ten and of units, chi square; no line ends before a per cent sign."""
    told = powers(_micro(str(text)).replace("+-", "±").replace("chi2", "χ²").replace("g/cm3", "g/cm³"))
    told = re.sub(r"\bnu\b", "ν", re.sub(r"(?<=\d) - (?=(?:\d )?nu\b)", " − ", told))
    told = re.sub(r"\b10\^(-?\d+)", lambda m: f"10{m[1].translate(_RAISED)}", told)
    return _MINUS.sub("−", re.sub(r"(?<=\d) (?=%)", "\N{NO-BREAK SPACE}", told))


def powers(text: str) -> str:
    """`7.4e-4` as 7.4 × 10⁻⁴, and `1e6` as 10⁶."""

    def printed(found):
        raised = f"{found[2].strip('+')}{found[3]}".translate(_RAISED)
        times = "" if found[1] == "1" else f"{found[1]}\N{NO-BREAK SPACE}×\N{NO-BREAK SPACE}"
        return f"{times}10{raised}"

    return _POWER.sub(printed, text)


def _micro(text):
    return re.sub(r"(?<=\d) u(?=[smN]\b)", " µ", text)


def formula(text: str) -> Markup:
    """An equation as effects write it, with powers raised, indices lowered, Greek letters and signs."""
    plain = str(escape(text))
    for typed, set_ in _SIGNS.items():
        plain = plain.replace(typed, set_)
    plain = re.sub(
        "|".join(rf"(?<![A-Za-z]){name}(?![a-z])" for name in _GREEK), lambda m: _GREEK[m[0]], plain
    )
    plain = re.sub(r"(?<![\w.])-(?=\d)", "−", powers(_micro(plain)))
    plain = re.sub(
        r"\^\{([^}]*)\}|\^([-−]?\w+(?:\.\d+)?)",
        lambda m: f"<sup>{(m[1] or m[2]).replace('-', '−')}</sup>",
        plain,
    )
    return Markup(re.sub(r"_\{([^}]*)\}|(?<=\b\w)_(\w+)", lambda m: f"<sub>{m[1] or m[2]}</sub>", plain))


def with_subscripts(text: str) -> Markup:
    """Plain text as HTML, F_m and the like with their index lowered."""
    plain = str(escape(" ".join(text.split())))
    return Markup(re.sub(r"\b([A-Za-z])_(\w+)", r"<i>\1</i><sub>\2</sub>", plain))
