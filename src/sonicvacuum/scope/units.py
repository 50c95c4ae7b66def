"""Units as recorders write them and sensitivities as users write them: texts to base units and factors.

A base unit is what the record or SI counts in: V, N, m/s, m/s^2, s, Pa …; `g`, the acceleration, is left as
it is and converted only by a gauge's sensitivity.
"""

import math
import re
from dataclasses import dataclass

from sonicvacuum.files import InputError

# Standard acceleration of free fall, exact (3rd CGPM, 1901), the unit g of accelerometers.
STANDARD_GRAVITY = 9.80665
_PREFIX = {"p": 1e-12, "n": 1e-9, "u": 1e-6, "m": 1e-3, "c": 1e-2, "k": 1e3, "M": 1e6, "G": 1e9}
_LONG_PREFIX = {
    "pico": 1e-12,
    "nano": 1e-9,
    "micro": 1e-6,
    "mikro": 1e-6,
    "milli": 1e-3,
    "kilo": 1e3,
    "mega": 1e6,
}
# Symbol → base unit; those that take prefixes.
_SYMBOLS = {
    "V": "V", "A": "A", "N": "N", "Pa": "Pa", "s": "s", "m": "m", "m/s": "m/s", "m/s^2": "m/s^2", "g": "g",
    "C": "C", "W": "W", "Hz": "Hz", "Sa/s": "Hz", "S/s": "Hz", "Ohm": "Ohm", "strain": "strain", "K": "K",
    "J": "J", "T": "T", "F": "F", "H": "H",
}  # fmt: skip
# Spelled out, compared without regard to case and to a plural s.
_WORDS = {
    "volt": "V", "ampere": "A", "amp": "A", "newton": "N", "pascal": "Pa", "second": "s", "sec": "s",
    "sekunde": "s", "sekunden": "s", "seconde": "s", "hertz": "Hz", "sample/second": "Hz", "meter": "m",
    "metre": "m", "gee": "g", "gravity": "g", "ohm": "Ohm", "watt": "W", "kelvin": "K",
}  # fmt: skip
_WHOLE = {"S": ("s", 1.0), "kg": ("kg", 1.0), "1/s": ("Hz", 1.0), "sps": ("Hz", 1.0), "°C": ("degC", 1.0)}
# Forces that instruments show: decanewton, and weights at standard gravity (1 lb = 0.45359237 kg, 1959).
_WHOLE |= {"daN": ("N", 10.0), "kgf": ("N", STANDARD_GRAVITY), "kp": ("N", STANDARD_GRAVITY)}
_WHOLE |= {"lbf": ("N", 0.45359237 * STANDARD_GRAVITY), "Kg": ("kg", 1.0)}
_WHOLE |= {"LBF": _WHOLE["lbf"], "Lbf": _WHOLE["lbf"], "gn": ("g", 1.0), "g's": ("g", 1.0)}
_WHOLE |= {"%": ("%", 1.0), "bar": ("Pa", 1e5), "dB": ("dB", 1.0), "deg": ("deg", 1.0), "min": ("s", 60.0)}
# Units in other scripts (Cyrillic, Chinese, Japanese), and times as programs for microcontrollers call them.
_WHOLE |= {"\u0441": ("s", 1.0), "м\u0441": ("s", 1e-3), "мк\u0441": ("s", 1e-6), "н\u0441": ("s", 1e-9)}
_WHOLE |= {"В": ("V", 1.0), "мВ": ("V", 1e-3), "мкВ": ("V", 1e-6), "Н": ("N", 1.0), "мН": ("N", 1e-3)}
_WHOLE |= {
    "кН": ("N", 1e3),
    "м/\u0441": ("m/s", 1.0),
    "мм/\u0441": ("m/s", 1e-3),
    "м/\u0441^2": ("m/s^2", 1.0),
}
_WHOLE |= {"秒": ("s", 1.0), "毫秒": ("s", 1e-3), "微秒": ("s", 1e-6), "u秒": ("s", 1e-6), "m秒": ("s", 1e-3)}
_WHOLE |= {"ミリ秒": ("s", 1e-3), "マイクロ秒": ("s", 1e-6), "mus": ("s", 1e-6), "u s": ("s", 1e-6)}
_BARE = {"millis": 1e-3, "micros": 1e-6, "mikros": 1e-6, "nanos": 1e-9}
# Prefixes that recorders write in another case: K for kilo before these, S for seconds behind small ones.
_CAPITAL_K = re.compile(r"K(?=V$|N$|Pa$|Hz$|Sa?/s$|Ohm$)")
_SECONDS = re.compile(r"([munp])S")
# Volts, of which meters say that they are not those of an alternating voltage.
_DIRECT = re.compile(r"^(.?V)[ _]?\(?(?:DC|dc)\)?$")
# Samples a second, however they are written.
_SAMPLES = re.compile(r"\s*(?:samples?|sa|s)\s*/\s*(?:s|sec|seconds?)|\s*sps", re.IGNORECASE)
_NUMBER = r"[-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][-+]?\d+)?"
# The micro sign in its two code points and as wrong decoding leaves it (UTF-8, GBK and DOS read as Latin-1).
_MICRO = re.compile("Âµ|Î¼|¦Ì|µ|μ|[�æ](?=[sVANmg]\\b)")


@dataclass(frozen=True)
class Unit:
    """A unit as a multiple of a base unit."""

    base: str
    factor: float = 1.0


def unit_of(text: str) -> Unit | None:
    """The unit that a text names, brackets around it allowed; None for anything else."""
    text = _plain(text)
    if not text:
        return None
    if text in _WHOLE:
        return Unit(*_WHOLE[text])
    for symbol, base in _SYMBOLS.items():
        if text == symbol:
            return Unit(base)
        if text.endswith(symbol) and text[: -len(symbol)] in _PREFIX:
            return Unit(base, _PREFIX[text[: -len(symbol)]])
    return spelled(text)


def _plain(text):
    """Brackets off, one spelling of micro, of squares and of products with s."""
    text = _MICRO.sub("u", text.strip().strip('"').strip())
    text = re.sub(r"^[\[({<](.*)[\])}>]$", r"\1", text).strip()
    text = re.sub(r"[$\\]", "", text)
    text = text[:-1] if re.search(r"\w\w\.$", text) else text
    rate = re.fullmatch(rf"([kKMG]?)({_SAMPLES.pattern})", text, re.IGNORECASE)
    if rate and rate.group(1) != "m":
        text = f"{rate.group(1)}Sa/s"
    text = _SECONDS.sub(r"\1s", text) if _SECONDS.fullmatch(text) else _CAPITAL_K.sub("k", text)
    text = (
        _DIRECT.sub(r"\1", text).replace("m/sec", "m/s").replace("⁻", "-").replace("¹", "1").replace("²", "2")
    )
    text = re.sub(r"/([s\u0441])(\*\*2|\^2|2|/s)$", r"/\1^2", text)
    text = re.sub(r"^(.*?)\s*[·⋅*.\s]\s*s\^?-2$", r"\1/s^2", text)
    text = re.sub(r"^(.*?)\s*[·⋅*.\s]\s*s\^?-1$", r"\1/s", text)
    return text.replace("Ω", "Ohm").replace("ε", "strain").strip()


def spelled(word: str) -> Unit | None:
    """The unit that a word such as `Second`, `Volts` or `millivolt` is; None for anything else."""
    word = word.lower()
    if word in _BARE:
        return Unit("s", _BARE[word])
    for prefix, factor in ({"": 1.0} | _LONG_PREFIX | {"m": 1e-3, "u": 1e-6, "n": 1e-9, "k": 1e3}).items():
        if word.startswith(prefix):
            rest = word[len(prefix) :]
            base = _WORDS.get(rest) or _WORDS.get(rest.removesuffix("s"))
            if base and (len(prefix) != 1 or rest.startswith(("sec", "volt", "hertz"))):
                return Unit(base, factor)
    return None


def quantity(text: str, decimal: str = ".") -> tuple[float, Unit | None] | None:
    """A number with its unit, as in `1e+06Hz` or `4 ns`; None where the text is no number."""
    text = text.strip().strip('"').strip()
    if decimal == ",":
        text = text.replace(",", ".", 1)
    # Blanks part thousands, as in 500 000 Hz.
    text = re.sub(
        r"^([-+]?\d{1,3})((?:[ \u00a0\u202f]\d{3})+)(?![\d.])", lambda m: re.sub(r"\s", "", m[0]), text
    )
    text = re.sub(r"^(?:10\s*\^\s*|E(?=[-+]))([-+]?\d+)", r"1e\1", text)
    found = re.match(rf"({_NUMBER})\s*(.*)$", text)
    if not found:
        return None
    unit = unit_of(found.group(2))
    number = float(found.group(1))
    if (found.group(2) and unit is None) or not math.isfinite(number):
        return None
    return number, unit


@dataclass(frozen=True)
class Scale:
    """A gauge's sensitivity: `factor` of `unit` for one `per`, both base units."""

    factor: float
    unit: str
    per: str

    def of(self, unit: str) -> tuple[float, str] | None:
        """Factor and unit that readings in `unit` come to, None where the sensitivity is for another."""
        if unit == self.per:
            return self.factor, self.unit
        if unit == self.unit:
            return 1.0 / self.factor, self.per
        return None


def scale(text: str, name: str) -> Scale:
    """A sensitivity such as `12.5N/V`, `-12.5 N/V`, `80mV/N`, `100 mV/g`; InputError for anything else."""
    found = re.fullmatch(rf"\s*({_NUMBER})\s*(\S.*)", text)
    value, units = (float(found.group(1)), found.group(2)) if found else (0.0, "")
    for place in [m.start() for m in re.finditer("/", units)]:
        upper, lower = unit_of(units[:place]), unit_of(units[place + 1 :])
        if upper and lower and value:
            found = _standard(value * upper.factor / lower.factor, upper.base, lower.base)
            if found.factor and math.isfinite(found.factor) and math.isfinite(1.0 / found.factor):
                return found
    raise InputError(
        f"--scale {name}: is {text!r}; write a finite number other than 0 and two units, as in 12.5N/V, "
        "-12.5N/V, 80mV/N or 100mV/g"
    )


def _standard(factor, upper, lower):
    """The sensitivity with g written out in m/s^2, which is what a record counts in."""
    if upper == "g":
        factor, upper = factor * STANDARD_GRAVITY, "m/s^2"
    if lower == "g":
        factor, lower = factor / STANDARD_GRAVITY, "m/s^2"
    return Scale(factor, upper, lower)
