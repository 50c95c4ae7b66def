"""How long each rule took: the benchmark files of the workflow, one line a rule."""

from pathlib import Path

import pandas as pd

from sonicvacuum.files import replacing


def gather(folder) -> pd.DataFrame:
    """Columns rule, jobs, median_s, longest_s, peak_memory_MB of all benchmark files below a folder.

    A file `<rule>/<job>.tsv` or `<rule>.tsv` is what Snakemake's `benchmark:` writes.
    """
    rows = []
    for path in sorted(Path(folder).rglob("*.tsv")):
        rule = path.relative_to(folder).parts[0].removesuffix(".tsv")
        measured = pd.read_csv(path, sep="\t", na_values="-")
        rows.append({"rule": rule, "s": measured["s"].median(), "memory": measured["max_rss"].max()})
    jobs = pd.DataFrame(rows, columns=["rule", "s", "memory"]).groupby("rule", sort=True)
    return pd.DataFrame(
        {
            "jobs": jobs.size(),
            "median_s": jobs["s"].median().round(2),
            "longest_s": jobs["s"].max().round(2),
            "peak_memory_MB": jobs["memory"].max().round(0),
        }
    ).reset_index()


def write(folder, path) -> None:
    """Gather and write as CSV."""
    with replacing(path) as stream:
        gather(folder).to_csv(stream, index=False, lineterminator="\n")
