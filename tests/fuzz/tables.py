"""A sound table of each kind that users hand to `sonicvacuum paper` and `blind`, and what reads it."""

import csv
import io
import json
import random
import shutil
import sys
from pathlib import Path

import yaml

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests" / folder) for folder in ("blind", "figures")]

from made_truths import truth, verdict  # noqa: E402
from test_digitised import block  # noqa: E402

from sonicvacuum import config  # noqa: E402
from sonicvacuum_blind import score, study  # noqa: E402
from sonicvacuum_blind.page import build as study_page  # noqa: E402
from sonicvacuum_paper import digitised, figures, stages  # noqa: E402
from sonicvacuum_paper.report import publish  # noqa: E402
from sonicvacuum_paper.rows import Row, write_rows  # noqa: E402

CELLS = [
    "",
    "-1",
    "0",
    "1e999",
    "nan",
    "-inf",
    "1e-320",
    "two",
    '"',
    "<b>",
    "µ",
    "a;b c;",
    "x/y",
    "x/y/z",
    "1,5",
]
METRICS = [
    Row(f"fig3a.{column}", quantity, sensor, value, unit, 1e-3)
    for column in ("handbook", "matched", "layer")
    for quantity, sensor, value, unit in (
        ("speed", "g9-g5", 220.0, "m/s"),
        ("duration", "g9", 75.0, "us"),
        ("loss_effects", "", 0.0, "1"),
    )
]
LADDER = {name: [name] for name in ("handbook", "matched", "layer")}


def in_cell(whole: bytes, draw: random.Random) -> bytes:
    """A table with one cell changed, moved, lost or put in twice."""
    rows = list(csv.reader(io.StringIO(whole.decode())))
    row = draw.choice([row for row in rows if row])
    at = draw.randrange(len(row))
    kind = draw.choice(["change", "change", "change", "lose", "repeat", "swap"])
    if kind == "lose":
        del row[at]
    elif kind == "repeat":
        row.insert(at, row[at])
    elif kind == "swap":
        row[at], row[-1] = row[-1], row[at]
    else:
        row[at] = draw.choice(CELLS)
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue().encode()


class Tables:
    """Sound tables in a folder.

    Attributes:
        trees: kind → (file, content, writer) of those that are trees.
        readers: kind → (file, what reads it).
    """

    def __init__(self, folder: Path):
        folder.mkdir()
        self.folder = folder
        self.config = config.Config(cases={"fig3a": {}}, ledger=LADDER)
        resources = ROOT / "workflow/resources"
        for path in (
            resources / "claims.csv",
            resources / "assumptions.csv",
            resources / "reference/ledger.csv",
        ):
            shutil.copy(path, folder)
        shutil.copy(resources / "reference/blind_full/summary.csv", folder)
        shutil.copy(resources / "reference/blind_small.csv", folder / "score.csv")
        shutil.copy(ROOT / "README.md", folder)
        write_rows(METRICS, folder / "metrics.csv", reasons=False)
        (folder / "absent.csv").write_text("case,quantity,sensor,reason\n")
        (folder / "probable.csv").write_text(
            "claim,model,low,median,high,draws,probability\nfig3a-speed,layer,190,226,260,100,0.25\n"
        )
        study.write_cases(study.cases("small")[:4], folder / "cases.csv")
        with open(ROOT / "figures/fig4.csv") as stream:
            (folder / "fig4.csv").write_text("".join(line for line in stream if line[0] in "pa"))
        self.trees = {
            "points": ("points.yaml", block([[0.25, 130.0], [1.0, 170.0]]), yaml.safe_dump),
            "truth": ("truth/x/truth.json", truth(), json.dumps),
            "blind verdict": ("verdict/x/verdict.json", verdict(), json.dumps),
        }
        for file, content, dumped in self.trees.values():
            (folder / file).parent.mkdir(parents=True, exist_ok=True)
            (folder / file).write_text(dumped(content))
        self.readers = {
            "metrics": ("metrics.csv", self._ledger),
            "absent": ("absent.csv", self._ledger),
            "claims": ("claims.csv", self._ledger),
            "probable": ("probable.csv", self._ledger),
            "assumptions": ("assumptions.csv", self._audit),
            "ledger": ("ledger.csv", self._published),
            "cases": ("cases.csv", study.read_cases),
            "figure": ("fig4.csv", self._held),
            "points": ("points.yaml", self._held),
            "summary": ("summary.csv", study_page),
            "score": ("score.csv", publish.naming),
            "truth": ("truth/x/truth.json", self._scored),
            "blind verdict": ("verdict/x/verdict.json", self._scored),
        }

    def _ledger(self, _):
        here = self.folder
        stages.write_ledger(
            here / "metrics.csv", here / "claims.csv", self.config, here / "out.csv", here / "probable.csv"
        )

    def _audit(self, path):
        stages.write_assumptions(self.folder / "metrics.csv", path, self.config, self.folder / "out.csv")

    def _published(self, path):
        publish.publish(path, self.folder / "README.md", self.folder / "out.csv")

    def _held(self, _):
        digitised.told(
            digitised.read(self.folder / "points.yaml"), figures.read("fig4", self.folder / "fig4.csv")
        )

    def _scored(self, _):
        score.score(self.folder / "truth", self.folder / "verdict")
