"""The text of record.yaml for imported runs: what is known, what was assumed, what is to be filled in."""

import difflib
from pathlib import Path

import msgspec
import yaml

from sonicvacuum.files import InputError, in_one_line, read_yaml
from sonicvacuum.records import writer
from sonicvacuum.records.blocks import RecordBlock, RecordSensorBlock, RunBlock
from sonicvacuum.records.reader import FILE
from sonicvacuum.scope.clean import CleanRun
from sonicvacuum.scope.options import Options

# Relative error of a sensitivity that states none; the comment beside it says so.
GAIN_REL_SIGMA = 0.05
# Written for `unknown` while the format knows numbers only: the largest that it takes.
_LARGEST = {"gain_rel_sigma": 2.0, "trigger_sigma_us": 1e4}
# Keys of the template that go into the record as they are: all but those that the runs decide.
_DECIDED = ("format", "title", "sensors", "trigger_sigma_us", "runs")
_KEYS = tuple(f.encode_name for f in msgspec.structs.fields(RecordBlock))
_RUN = tuple(f.encode_name for f in msgspec.structs.fields(RunBlock))
_KEPT = tuple(k for k in _KEYS if k not in _DECIDED)
# Letters of a title that names the runs.
_LONG = 60
_SIGMA_KEY = {"m/s": "sigma_m_s", "m/s^2": "sigma_m_s2"}
_KIND = {"m/s": "velocity", "m/s^2": "acceleration"}
_CHAIN = """\
# To be filled in: the chain (sonicvacuum record new FOLDER writes a commented example).
# chain:
#   beads:            # bead 1 is the one the striker hits, the last bead touches the wall
#   orientation:      # vertical | horizontal
#   bead: {diameter_mm: , mass_g: , material: }
#   wall: {material: }
# materials:
#   NAME: {modulus_GPa: , poisson: , modulus_rel_sigma: }
"""


def template(like=None, record=None) -> dict:
    """Content of the record that gives chain, materials, gauges and striker, {} without one.

    Args:
        like: folder of a record. record: a YAML file with keys of a record, which may be incomplete.
    """
    if like is not None and record is not None:
        raise InputError("--like and --record exclude each other; give one")
    if like is not None:
        file = Path(like) if Path(like).is_file() else Path(like) / FILE
        given = _checked(read_yaml(file), file)
        # What was measured there, and when its clock began, are its own.
        runs = [{k: v for k, v in r.items() if k != "observables"} for r in given.get("runs") or []]
        return {k: v for k, v in given.items() if k != "trigger_sigma_us"} | ({"runs": runs} if runs else {})
    return _checked(read_yaml(record), record) if record is not None else {}


def _checked(given, file):
    """The content of a template, of which everything that is looked at has the form that it must have."""
    _known(given, _KEYS, file, "")
    for key, keys in (("runs", _RUN), ("sensors", None)):
        entries = given.get(key)
        if entries is not None and not isinstance(entries, list):
            raise InputError(f"{file}: {key}: is {entries!r}; write a list, each entry with its id")
        for k, entry in enumerate(entries or []):
            place = f"{key}[{k}]"
            if not isinstance(entry, dict) or not isinstance(entry.get("id", ""), str):
                odd = entry.get("id") if isinstance(entry, dict) else entry
                raise InputError(f"{file}: {place}: is {odd!r}; write keys, and an id in quotes")
            if keys:
                _known(entry, keys, file, place + ".")
            if not isinstance(entry.get("striker") or {}, dict):
                raise InputError(
                    f"{file}: {place}.striker: is {entry['striker']!r}; write its keys, as in {{shape: flat, "
                    "material: alumina, mass_g: 0.47}"
                )
    return given


def _known(mapping, keys, file, place):
    """Refuse keys that a record does not have: they would be lost."""
    for key in mapping:
        if key not in keys:
            near = difflib.get_close_matches(str(key), keys, 1)
            cure = f"write {near[0]}" if near else f"there are {', '.join(keys)}"
            raise InputError(f"{file}: {place}{key}: a record has no such key; {cure}, or take it out")


def unknown(kind: type, key: str) -> str | float:
    """`unknown` where the format takes it for a key, else the largest number it takes."""
    field = next(f.type for f in msgspec.structs.fields(kind) if f.name == key)
    try:
        return msgspec.convert("unknown", field)
    except msgspec.ValidationError:
        return _LARGEST[key]


def content(runs: list[CleanRun], given: dict, options: Options, title: str | None) -> dict:
    """The mapping of record.yaml; what neither files nor template tell is left out."""
    kept = {k: given[k] for k in _KEPT if k in given}
    named = title or given.get("title") or _title([r.id for r in runs])
    result = {"format": 1, "title": named} | kept
    result["sensors"] = [_sensor(g, runs, given, options) for g in _gauges(runs)]
    stated = given.get("trigger_sigma_us")
    result["trigger_sigma_us"] = _trigger(runs) if stated is None else stated
    result["runs"] = [_run(r, given, options) for r in runs] + _scalar_runs(runs, given)
    result["sensors"] += _named(result, given)
    return result


def _scalar_runs(runs, given):
    """Runs of which only scalars were measured; they have no file."""
    ids = {r.id for r in runs}
    return [
        e | {"striker": e.get("striker") or {}}
        for e in _listed(given, "runs")
        if e.get("observables") and not e.get("signals") and e.get("id") not in ids
    ]


def _named(record, given):
    """Gauges that have no channel, while observables name them."""
    scalars = [o for r in record["runs"] for o in r.get("observables") or [] if isinstance(o, dict)]
    names = [o.get(k) for o in scalars for k in ("from", "to", "sensor")]
    have = [s["id"] for s in record["sensors"]]
    return [s for s in _listed(given, "sensors") if s.get("id") in names and s.get("id") not in have]


def _title(ids):
    """As many runs as the line holds, and how many more there are."""
    shown = len(ids)
    while shown > 1 and len(", ".join(ids[:shown])) > _LONG:
        shown -= 1
    more = f" and {len(ids) - shown} more" if shown < len(ids) else ""
    return f"Imported: {', '.join(ids[:shown])[:_LONG]}{more}"


def _gauges(runs):
    return list(dict.fromkeys(g for r in runs for g in r.signals.readings))


def _sensor(gauge, runs, given, options):
    """A gauge: place and kind from options or template, noise from the runs, gain from the sensitivity."""
    known = next((s for s in _listed(given, "sensors") if s.get("id") == gauge), {})
    unit = next(r.unit[gauge] for r in runs if gauge in r.unit)
    sensor = {"id": gauge} | {k: known[k] for k in ("kind", "bead") if k in known}
    if gauge in options.places:
        bead = options.places[gauge]
        sensor["kind"] = _KIND.get(unit, "wall" if bead is None else "embedded")
        sensor |= {"bead": bead} if bead is not None else {}
    sigma = sum(r.sigma[gauge] ** 2 for r in runs if gauge in r.sigma) / sum(gauge in r.sigma for r in runs)
    sensor[_SIGMA_KEY.get(unit, "sigma_N")] = float(f"{sigma**0.5:.3g}")
    sensor["gain_rel_sigma"] = _gain(gauge, known, unit, options)
    rest = {k: v for k, v in known.items() if k not in sensor and not k.startswith("sigma_")}
    return sensor | rest


def _gain(gauge, known, unit, options):
    if gauge in options.gain_rel_sigma:
        return options.gain_rel_sigma[gauge]
    if gauge not in options.scales and unit not in ("N", *_SIGMA_KEY):
        return unknown(RecordSensorBlock, "gain_rel_sigma")
    return known.get("gain_rel_sigma", GAIN_REL_SIGMA)


def _trigger(runs):
    """Common standard error of time zero in us, or `unknown`; as a number, the time ahead of the pulse."""
    sigmas = [r.zero_sigma_s for r in runs]
    word = unknown(RecordBlock, "trigger_sigma_us")
    # One as large as the longest that the format takes is as good as unknown.
    if None not in sigmas and max(sigmas) * 1e6 <= _LARGEST["trigger_sigma_us"]:
        return float(f"{max(sigmas) * 1e6:.3g}")
    if isinstance(word, str):
        return word
    return float(f"{min(word, max(r.lead_s for r in runs) * 1e6):.3g}")


def _run(run, given, options):
    listed = _listed(given, "runs")
    same = next((r for r in listed if r.get("id") == run.id), None)
    striker = dict((same or (listed[0] if listed else {})).get("striker") or {})
    if same is None:
        striker.pop("speed_m_s", None)
    for key, stated in (("speed_m_s", options.speeds), ("speed_rel_sigma", options.speed_rel_sigma)):
        if run.id in stated or "" in stated:
            striker[key] = stated.get(run.id, stated.get(""))
    observed = {"observables": same["observables"]} if same and same.get("observables") else {}
    return {"id": run.id, "striker": striker, "signals": f"{run.id}.csv"} | observed


def unused(given: dict, runs: list[CleanRun]) -> list[str]:
    """That runs of a given record got no file, which mostly means that a file has another name."""
    listed = [e for e in _listed(given, "runs") if "id" in e]
    ids = [e["id"] for e in listed if e.get("signals") or not e.get("observables")]
    found = [r.id for r in runs]
    missing = [i for i in ids if i not in found]
    if not missing or set(found) <= set(ids):
        return []
    cure = f"--run {missing[0]}=FILE says which it is"
    return [
        f"no file is called like {', '.join(missing)} of the record; there are {', '.join(found)}: {cure}"
    ]


def check_gauges(given: dict, options: Options, file) -> None:
    """InputError for a channel that is said to read a gauge which the record in `file` has not."""
    known = _ids(given)
    for channel, gauge in options.channels.items():
        if known and gauge not in known and gauge not in options.places:
            raise InputError(
                f"--channel {channel}={gauge}: {file} has no gauge {gauge!r}, but {', '.join(known)}; write "
                f"one of these, or say where a further one sits: --place {gauge}=BEAD"
            )


def unread(given: dict, record: dict, file) -> list[str]:
    """That gauges of a given record are left out, or stand beside others that it does not know."""
    known, have = _ids(given), [s["id"] for s in record["sensors"]]
    lost = [g for g in known if g not in have]
    if not lost:
        return []
    new = [g for g in have if g not in known]
    beside = f"; it does not have {', '.join(new)}" if new else ""
    return [
        f"left out of the gauges of {file}, as no channel reads them: {', '.join(lost)}{beside} "
        f"(--channel CH={lost[0]} says which channel reads which gauge)"
    ]


def _ids(given):
    return [s["id"] for s in _listed(given, "sensors") if "id" in s]


def _listed(given, key):
    entries = given.get(key)
    return [e for e in entries if isinstance(e, dict)] if isinstance(entries, list) else []


def text(record: dict, runs: list[CleanRun], options: Options, given: dict) -> str:
    """record.yaml with comments on what was done, assumed, and is to be filled in."""
    head = {k: record[k] for k in ("format", "title", "source") if k in record}
    chain = {k: record[k] for k in _KEPT if k in record and k not in head}
    parts = [
        "# Imported from a recorder's files; what was done to each run stands at the end.\n",
        _yaml(head),
    ]
    parts.append(_yaml(chain) if "chain" in chain else _CHAIN + (_yaml(chain) if chain else ""))
    parts.append("# Positive readings = compression. sigma: white noise of one sample, estimated at rest.\n")
    parts += [_comment(line) for line in _gauge_remarks(record, runs, options)]
    parts.append(_yaml({"sensors": record["sensors"]}))
    if any(r.zero_sigma_s is None for r in runs) and given.get("trigger_sigma_us") is not None:
        parts.append(
            "# Stated with the record: time zero, as said of the runs below, must be known to that.\n"
        )
    elif any(r.zero_sigma_s is None for r in runs):
        parts.append("# The moment of impact is not known (--impact-at gives it): time zero is free.\n")
    parts.append(_yaml({"trigger_sigma_us": record["trigger_sigma_us"]}))
    parts += [_comment(f"To be filled in: {line}") for line in _striker_gaps(record)]
    parts.append(_yaml({"runs": record["runs"]}))
    for run in runs:
        parts += [_comment(f"Run {run.id}:"), *(_comment(f"  {note}") for note in run.notes)]
    return "".join(parts)


def _comment(text):
    """A line of YAML that says nothing to a reader of the format, whatever a file's name holds."""
    return f"# {in_one_line(text)}\n"


def _gauge_remarks(record, runs, options):
    for sensor in record["sensors"]:
        gauge = sensor["id"]
        if not any(gauge in r.unit for r in runs):
            continue
        unit = next(r.unit[gauge] for r in runs if gauge in r.unit)
        noise = [r.sigma[gauge] for r in runs if gauge in r.sigma]
        if max(noise) > 2.0 * min(noise):
            yield f"{gauge}: noise differs from run to run, {min(noise):.3g} to {max(noise):.3g} {unit}."
        if "kind" not in sensor:
            yield f"To be filled in: kind and bead of {gauge} (--place {gauge}=13, or =wall)."
        if unit not in ("N", *_SIGMA_KEY):
            yield (
                f"{gauge}: readings are in {unit or 'an unknown unit'}, its gain is unknown; to be filled "
                f"in: the sensitivity (--scale {gauge}=12.5N/V)."
            )
        elif gauge not in options.gain_rel_sigma and sensor["gain_rel_sigma"] == GAIN_REL_SIGMA:
            yield f"{gauge}: gain_rel_sigma is assumed; say how well the sensitivity is known."


def _striker_gaps(record):
    for run in record["runs"]:
        keys = [k for k in ("shape", "material", "mass_g", "speed_m_s") if k not in run["striker"]]
        if keys:
            yield f"striker of {run['id']}: {', '.join(keys)}."


def _yaml(mapping):
    """YAML of some keys of the record, each beginning a line, as in a file of all keys."""
    lines = []
    for key, value in mapping.items():
        if isinstance(value, dict | list):
            lines.append(writer.text({key: value}))
        else:
            lines.append(
                yaml.safe_dump({key: value}, allow_unicode=True, default_flow_style=False, width=1000)
            )
    return "".join(lines)
