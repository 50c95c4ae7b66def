"""Tables as pages show them: read, checked for their columns, numbers made legible."""

import math

from sonicvacuum.files import InputError, check_file, reading

_UNITS = {"us": "µs", "um": "µm", "uN": "µN", "1": "", "1/s": "s⁻¹", "m/s2": "m/s²", "g/cm3": "g/cm³"}


def unit_of(unit: str) -> str:
    """A unit as people write it, with a space before it."""
    shown = _UNITS.get(unit, unit)
    return f" {shown}" if shown else ""


def read(path, columns, numbers=()):
    """The pandas.DataFrame of a table with exactly these columns, text kept as text and missing cells empty.

    Raises:
        InputError: when the file has other columns or cannot be parsed, or where a cell of the columns
            `numbers` is neither a number nor empty.
    """
    import pandas as pd  # only here: the page of a record does without

    check_file(path)
    with reading(path, "make the table again"):
        table = pd.read_csv(path, dtype=str, keep_default_na=False)
    if list(table.columns) != list(columns):
        raise InputError(f"{path}: columns are {','.join(table.columns)}; expected {','.join(columns)}")
    for column in numbers:
        for place, cell in enumerate(table[column], 2):
            _check_number(cell, f"{path}, line {place}: {column}")
    return table


def _check_number(cell, where):
    try:
        float(cell or "nan")
    except ValueError:
        raise InputError(f"{where}: is {cell!r}; make the table again, or write a number") from None


def number(text: str, digits: int = 4) -> str:
    """A number of a table with so many significant digits; other text as it is, nothing for nothing."""
    try:
        value = float(text)
    except ValueError:
        return text
    if math.isnan(value):
        return ""
    if math.isinf(value):
        return text
    if value == 0.0:
        return "0"
    exponent = math.floor(math.log10(abs(value)))
    if -3 <= exponent < 6:
        shown = f"{value:.{max(0, digits - 1 - exponent)}f}"
        return shown.rstrip("0").rstrip(".") if "." in shown else shown
    mantissa, power = f"{value:.{digits - 1}e}".split("e")
    return f"{mantissa.rstrip('0').rstrip('.')}e{int(power)}"


def digits(text, count: int = 4) -> str:
    """A number with so many significant digits, also where they end in zeros: 1.000 beside 1.436."""
    try:
        value = float(text)
    except ValueError:
        return text
    if not math.isfinite(value) or value == 0.0:
        return number(str(text), count)
    # Rounding may carry: 0.99996 is 1.000.
    exponent = math.floor(math.log10(abs(float(f"{value:.{count - 1}e}"))))
    return f"{value:.{max(0, count - 1 - exponent)}f}" if -3 <= exponent < 6 else number(str(text), count)


def with_error(value, sigma):
    """Value ± standard error with two digits of the error."""
    if not sigma > 0.0:
        return f"{value:.4g} (error not determined)"
    places = decimals(value, sigma)
    if places is None:
        return _in_one_power(value, sigma)
    return f"{fixed(value, places)} ± {fixed(sigma, places)}"


def _in_one_power(value, sigma):
    """Both with the power of ten of the larger: 8.04e-5 ± 0.25e-5."""
    power = math.floor(math.log10(max(abs(value), sigma)))
    scale = 10.0**power
    places = max(0, 1 - math.floor(math.log10(float(f"{sigma / scale:.1e}"))))
    return f"{value / scale:.{places}f}e{power} ± {sigma / scale:.{places}f}e{power}"


def decimals(value, sigma):
    """Decimals down to the second digit of an error; None where powers of ten say it better."""
    # Rounding may carry: 0.0996 is 0.10.
    places = 1 - math.floor(math.log10(float(f"{sigma:.1e}")))
    return None if places >= 7 or abs(value) >= 1e6 else places


def fixed(value, places):
    """A number with so many decimals; a negative count rounds before the point."""
    return f"{round(value, places):.{max(0, places)}f}"
