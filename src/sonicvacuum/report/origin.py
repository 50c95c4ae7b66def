"""Where a verdict comes from, in plain words: data, files, chain, strikers, program."""

from sonicvacuum.discover.given import Inputs
from sonicvacuum.records import Record
from sonicvacuum.records.described import chain_of

# Digits of a SHA-256 that are enough to tell files apart by eye.
DIGITS = 16


def rows(inputs: Inputs, records: list[Record]) -> list[dict[str, str]]:
    """Label, text and, where the text is cut short, the whole of it; one entry a line."""
    first = records[0]
    source = first.block.source
    what = ("Chain", "Strikers") if first.beads else ("Ball", "Impacts")
    found = [(what[0], chain_of(first)), (what[1], _strikers(records))]
    found += [("Gauges", _gauges(first))] if first.gauges else []
    found.append(("Data of", source.date.isoformat() if source.date else "no date in record.yaml"))
    told = (source.citation, source.doi, source.licence, source.note)
    found += [("Source", "; ".join(t for t in told if t))] if any(told) else []
    lines = [{"label": label, "text": text, "whole": ""} for label, text in found]
    for record in records:
        lines.append({"label": "Record", "text": _cut(record), "whole": f"SHA-256 {record.digest}"})
    return [*lines, {"label": "Made with", "text": f"sonicvacuum {inputs.version}", "whole": ""}]


def _cut(record):
    return f"{record.name}, SHA-256 {record.digest[:DIGITS]}…" if record.digest else record.name


def _strikers(records):
    """Each kind of striker with its speeds."""
    kinds: dict[str, list[str]] = {}
    for record in records:
        for run, block in zip(record.runs, record.block.runs, strict=True):
            s = run.striker
            size = "" if block.striker.shape == "flat" else f", {2e3 * s.radius_m:g} mm"
            shape = "flat" if block.striker.shape == "flat" else "ball"
            kind = f"{s.surface.name} {shape}{size}, {s.mass_kg * 1e3:g} g"
            kinds.setdefault(kind, []).append(f"{s.speed_m_s:g}")
    return "; ".join(f"{kind}, at {', '.join(dict.fromkeys(v))} m/s" for kind, v in kinds.items())


def _gauges(record):
    said = []
    for g in record.gauges:
        place = "at the wall" if g.bead is None else f"{'in' if g.kind == 'embedded' else 'on'} bead {g.bead}"
        said.append(place if g.id == "wall" else f"{g.id} {place}")
    return ", ".join(said)
