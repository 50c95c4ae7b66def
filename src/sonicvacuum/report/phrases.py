"""Small phrases that all sentences of a page share: probabilities in words, lists, counts."""

from sonicvacuum.report.tables import number

# Probability from which on each wording is used.
SURE = (
    (0.99, "practically certain"),
    (0.95, "very probable"),
    (0.8, "probable"),
    (0.5, "more probable than not"),
    (0.0, "less probable than all its rivals together"),
)


def in_words(probability: float) -> str:
    """A probability in words, with its number, both of the same two decimals."""
    told = round(probability, 2)
    word = "as probable as not" if told == 0.5 else next(text for least, text in SURE if told >= least)
    return f"{word} ({share(probability)})"


def share(value: float) -> str:
    """A probability with two decimals, never rounded to certainty."""
    if value > 0.995:
        return "above 0.99"
    return "below 0.01" if value < 0.005 else f"{value:.2f}"


def joined(parts: list[str], last: str = "and") -> str:
    """a, b and c."""
    return parts[0] if len(parts) == 1 else f"{', '.join(parts[:-1])} {last} {parts[-1]}"


def plural(count: int, word: str) -> str:
    """Count and word."""
    return f"{count} {word}{'' if count == 1 else 's'}"


def chance(p: float) -> str:
    """A p-value with two digits, never rounded to certainty."""
    if p > 0.995:
        return "above 0.99"
    return number(str(p), 2) if p > 1e-300 else "below 1e-300"
