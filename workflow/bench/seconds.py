"""Where the seconds of a verdict go, in the sources here and in those of an earlier commit, in turns.

Every verdict is made in a process of its own, on one thread, by the verb that users type. Processor time is
told apart into: what is loaded before the search (Python, libraries, compiled code), the compiled stepper,
what surrounds it in a prediction, the rest of the search, tables, pictures and page. Compiled code, Python's
too, is in its cache already, as for whoever has used the command before: each version's first verdict is not
counted. On a machine that does other work too, --least takes the least of each part in place of the median.

    python workflow/bench/seconds.py RECORD… --before COMMIT [--repeats 3] [--least] [--out TABLE.csv]
    python workflow/bench/seconds.py --draw TABLE.csv PICTURE.svg      # and the table as Markdown
"""

import argparse
import csv
import json
import os
import statistics
import subprocess
import sys
import tarfile
import tempfile
from io import BytesIO
from pathlib import Path

from sonicvacuum.tables import write_csv

ROOT = Path(__file__).resolve().parents[2]
PARTS = ("start", "stepper", "around the stepper", "search", "tables", "pictures and page")
COLUMNS = ("sources", "record", "named", "chains", *PARTS, "sum")

MEASURED = """
import json, sys, time
record, out = sys.argv[1:]
spent = {}

def timed(owner, name, part):
    own = getattr(owner, name)
    def call(*arguments, **options):
        begun = time.process_time()
        try:
            return own(*arguments, **options)
        finally:
            spent[part] = spent.get(part, 0.0) + time.process_time() - begun
    setattr(owner, name, call)

from sonicvacuum.cli import main
from sonicvacuum.discover import session
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.physics import compiled, run
try:
    from sonicvacuum import drawn
except ImportError:  # of an earlier commit
    from sonicvacuum.cli import page as drawn
try:
    from sonicvacuum.discover import written
except ImportError:
    written = session

timed(run, "prepare", "prepare")
timed(run._Batch, "run", "stepper")
timed(Forward, "_sampled" if hasattr(Forward, "_sampled") else "sampled", "sampled")
timed(session, "discover", "discover")
timed(written, "write", "tables")
timed(drawn, "illustrate", "pictures")
sys.argv = ["sonicvacuum", "discover", record, "--out", out, "--threads", "1", "--quiet"]
try:
    main()
except SystemExit as ended:
    assert not ended.code, ended.code
finally:
    spent["all"] = time.process_time()
    with open(out + ".json", "w") as file:
        json.dump(spent, file)
"""


def earlier(commit: str, folder: Path) -> Path:
    """The sources of a commit, put into a folder."""
    kept = subprocess.run(
        ["git", "-C", str(ROOT), "archive", "--format=tar", commit, "src"], check=True, stdout=subprocess.PIPE
    )
    with tarfile.open(fileobj=BytesIO(kept.stdout)) as archive:
        # Pythons before 3.11.4 know no filters; the archive is our own.
        archive.extractall(folder, **({"filter": "data"} if hasattr(tarfile, "data_filter") else {}))
    return folder / "src"


def verdict(source: Path, record: Path, folder: Path) -> dict:
    """Seconds of one verdict by part, what it named, and the chains that it simulated."""
    out = folder / "out"
    environment = os.environ | {"PYTHONPATH": str(source), "PYTHONPYCACHEPREFIX": str(folder / "pycache")}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)
    subprocess.run(
        [sys.executable, "-c", MEASURED, str(record), str(out)],
        check=True,
        env=environment,
        stdout=subprocess.DEVNULL,
    )
    spent = json.loads(out.with_name("out.json").read_text())
    found = json.loads((out / "verdict.json").read_text(encoding="utf-8"))
    stepper = spent["stepper"] - spent["prepare"]
    around = spent["sampled"] - spent["stepper"]
    own = {
        "stepper": stepper,
        "around the stepper": around,
        "search": spent["discover"] - spent["sampled"],
        "tables": spent["tables"],
        "pictures and page": spent["pictures"],
    }
    own["start"] = spent["all"] - sum(own.values())
    return {**own, "sum": spent["all"], "named": "+".join(found["named"]), "chains": found["simulations"]}


def measured(
    sources: dict[str, Path], records: list[Path], repeats: int, told=statistics.median
) -> list[dict]:
    """Medians (`told`) of each record in each version of the sources, versions in turns."""
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for record in records:
            found = {name: [] for name in sources}
            for turn in range(repeats + 1):
                for name, source in sources.items():
                    one = verdict(source, record, Path(folder))
                    found[name] += [one] if turn else []
            for name, several in found.items():
                parts = {part: told([one[part] for one in several]) for part in PARTS}
                seconds = {
                    part: f"{value:.3f}" for part, value in (parts | {"sum": sum(parts.values())}).items()
                }
                own = {"sources": name, "record": record.name, **seconds}
                rows.append(own | {key: several[0][key] for key in ("named", "chains")})
                print(*(rows[-1][c] for c in COLUMNS), flush=True)
    return rows


def markdown(rows: list[dict]) -> str:
    """The table as it stands in docs/benchmark.md."""
    header = ("record", "named", "", "chains", *PARTS, "sum")
    lines = ["| " + " | ".join(header) + " |", "|---|---|---|" + "---:|" * (len(header) - 3)]
    for row in rows:
        seconds = [f"{float(row[part]):.2f}" for part in (*PARTS, "sum")]
        cells = (row["record"], row["named"] or "nothing", row["sources"], row["chains"], *seconds)
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def draw(rows: list[dict], path: Path) -> None:
    """Bars of the parts of each verdict, before above now, as the format that the path ends with."""
    from sonicvacuum.figures import style

    colours = (style.GREY, style.BLUE, style.SKY, style.ORANGE, style.PURPLE, style.GREEN)
    records = list(dict.fromkeys(row["record"] for row in rows))
    with style.context():
        height = 26.0 + 15.0 * len(records)
        figure = style.canvas(style.DOUBLE, height)
        axes = style.panel(figure, (44.0, 12.0, style.DOUBLE - 54.0, height - 26.0))
        for row in rows:
            # Versions of a record lie together, the first above.
            at = 3.0 * records.index(row["record"]) + (0.0 if row["sources"] == "before" else 1.0)
            left = 0.0
            for part, colour in zip(PARTS, colours, strict=True):
                size = float(row[part])
                axes.barh(at, size, left=left, height=0.85, color=colour, lw=0.0, label=part)
                left += size
            axes.text(left, at, f" {left:.1f} s", va="center", fontsize=7.0)
            axes.annotate(
                row["sources"], (0.0, at), (-3.0, 0.0), textcoords="offset points", ha="right", va="center"
            )
        for k, record in enumerate(records):
            named = next(row["named"] for row in rows if row["record"] == record) or "nothing"
            told = f"{record}\n{named.replace('+', ' +' + chr(10))}"
            spot = (-0.1, 3.0 * k + 0.5)
            axes.text(*spot, told, transform=axes.get_yaxis_transform(), ha="right", va="center")
        axes.set(ylim=(3.0 * len(records) - 1.2, -0.8), yticks=[], xlabel="processor time (s)")
        axes.margins(x=0.1)
        handles = {h.get_label(): h for h in axes.containers}
        axes.legend(handles.values(), handles.keys(), ncols=3, loc="lower center", bbox_to_anchor=(0.42, 1.0))
        style.save(figure, path)


def main() -> None:
    """The table, or its figure."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("records", nargs="*", type=Path)
    parser.add_argument("--before", help="an earlier commit")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--least", action="store_true", help="least in place of median times")
    parser.add_argument("--out", type=Path, default=Path("results/seconds.csv"))
    parser.add_argument("--draw", nargs=2, type=Path, metavar=("TABLE", "PICTURE"), help="draw a table")
    given = parser.parse_args()
    if given.draw:
        with open(given.draw[0], newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        draw(rows, given.draw[1])
        print(markdown(rows))
        return
    if not (given.records and given.before):
        parser.error("give records and --before COMMIT, or --draw")
    with tempfile.TemporaryDirectory() as folder:
        sources = {"before": earlier(given.before, Path(folder)), "now": ROOT / "src"}
        rows = measured(sources, given.records, given.repeats, min if given.least else statistics.median)
    write_csv(given.out, COLUMNS, ([row[c] for c in COLUMNS] for row in rows))


if __name__ == "__main__":
    main()
