"""What of the full blind study is kept in git, and what docs/study.md and README say of it."""

from pathlib import Path

import pandas as pd

from sonicvacuum.files import InputError, read_text, replacing
from sonicvacuum_blind.baselines.names import ALARM, EXACT, PANELS, WRONG
from sonicvacuum_blind.kept import TABLES
from sonicvacuum_blind.report import Study, followed, percent, read, results, rivals

BEGIN = "<!-- study: made by `snakemake publish_study`, do not edit -->"
END = "<!-- end of study -->"
# What is kept of a study: what must be there, and what may.
KEPT = ("summary", "confusion", "accuracy", "reliability", "coverage")
ALSO_KEPT = ("score", "parameters", "pit", "baselines", "resolved_summary", "fresh")
# Said of tables without rows of the records.
BEFORE = (
    "These tables are of the method as it was before nuisances of the laboratory, slips, effects beside a "
    "misfit and the free-form law came in; they have not been made anew since, and part of the study had "
    "been read while that method was mended."
)
KINDS = {
    "null": "with nothing hidden",
    "single": "with one effect",
    "pair": "with two",
    "set": "with three",
    "foreign": "with one from outside the catalogue",
    "beside": "with one of each",
}
GROUPS = tuple(group for _, group, *_ in PANELS)
# Said beside the lines on held-out gaps: χ² of N data scatters by √(2N).
HELD_OUT = (
    "A held-out gap of d′² in N data drowns in the scatter of χ², √(2N), while d′ is below (2N)^¼, about 10 "
    "here: the median of single records shows that scatter, the gaps added up show what is closed."
)
# How what is asked is counted, where the words do not say it.
MEANT = (
    "Exact: the set named is the set hidden; unknown where the hidden effect is none of the catalogue's. "
    "Unqualified: without a word of unknown. Ideal rule: it is told all signatures, gives every effect "
    "the same prior, whatever its number of places, signs and shapes, fits each explanation through the "
    "integrator, names that of most evidence and tosses a coin between equals; where one effect of less than "
    "d′ 8 is hidden noise is a rival, and it names none at a false-alarm rate of 1 %. None is worked out for "
    "three effects, nor where its own fit of what is hidden fails. A group is named after the d′ of the list "
    "that is nearest to the one reached: 40 counts as 50. Localisation is by run and "
    "gauge: a cell found is right where the model without the "
    "hidden effect leaves d′ 1 or more there, and every cell of d′ 5 or more is to be found. Calibration "
    "errors are of the probability of the name given. An effect's PIT is the posterior probability below "
    "the truth; bands (Kolmogorov) hold in all effects at once. The verdict does not state what the "
    "record's own errors would be if nothing were named: how far they then move is worked out without "
    "noise."
)
# Where docs/study.md finds the pictures drawn from these tables.
PICTURE = "../figures/blind_{}.png"


def told(study: Study) -> str:
    """Records and goals in a sentence or two."""
    met, undecided, missed = study.goals
    return (
        f"{study.cases} records. Of {met + undecided + missed} goals {met} are met, {undecided} open and "
        f"{missed} missed: met where the whole 95 % interval fulfils it, missed where none of it does."
    )


def provenance(score: pd.DataFrame) -> str:
    """How a study was made, from the rows of its records."""
    from sonicvacuum_blind import study  # and with it the integrator

    counts = {kind: int(sum(score["kind"] == kind)) for kind in KINDS}
    kinds = ", ".join(f"{count} {KINDS[kind]}" for kind, count in counts.items() if count)
    hours, all_cases = score["seconds"].astype(float).sum() / 3600.0, len(study.cases("full"))
    part = "" if len(score) == all_cases else f"{len(score)} of {all_cases}, the first batches: "
    asked = int((score["errors_before"] != "nan").sum())
    ideal = "" if asked == len(score) else f" The ideal rule was asked about {asked} of them, evenly spread."
    return (
        f"Method: commit {study.METHOD}, tag `{study.TAG}`. The seed, {study.SEEDS['full']}, was drawn "
        "after that; all verdicts are of that commit, each made once. Studies of seeds "
        f"{', '.join(map(str, study.BEFORE))} came before (tables of the last: commit "
        f"{study.KEPT_BEFORE}); what was found in them was mended. "
        f"Records: {part}{kinds}.{_added(score)}{ideal} Verdicts took "
        f"{hours:.1f} hours, one thread each. Made with `snakemake --cores 2 publish_study`, in batches that "
        f"can be resumed, on one machine or a cluster. Of each record [score.csv](../{TABLES}/score.csv) has "
        f"what was found, of each stated interval [parameters.csv](../{TABLES}/parameters.csv); the tables "
        f"follow from these: `sonicvacuum blind tables {TABLES} --out tables`."
    )


def _added(score):
    """What of a study is besides its main list, a sentence or nothing."""
    count = int(score["added"].astype(int).sum()) if "added" in score else 0
    if not count:
        return ""
    return (
        f" {count} of these, empty, of strong effects or of one ball, are besides the list of the studies "
        "before, so that it can be told whether goals are met: they count by design and d′, by noise and in "
        "intervals, not where all records are added up."
    )


def in_short(study: Study) -> str:
    """Four lines for the README."""
    rows = {(row["measure"], row["group"]): row for row in study.summary.to_dict("records")}

    def found(measure, group):
        row = rows.get((measure, group), {})
        if row.get("count", "0") == "0":
            return "–"
        value, low, high = (100.0 * float(row[key]) for key in ("value", "low", "high"))
        beside = "" if row["ideal"] in ("", "nan") else f", an ideal rule {100.0 * float(row['ideal']):.1f} %"
        return f"{value:.1f} % ({low:.1f} to {high:.1f}{beside})"

    outside, weak = "outside the catalogue", "leftover d' 8 and more"
    unknown = found("says unknown", f"{outside}, {weak}")
    wrong = found("wrong name, unqualified", outside)
    lines = (
        told(study) + " All of them: [docs/study.md](docs/study.md).",
        f"Single effects of 3 to 500 standard errors named exactly: {found('exact name', 'all')}; pairs: "
        f"{found('exact pair', 'all')}; sets of three: {found('exact set of three', 'all')}.",
        f"Empty records named: {_alarms(study) or found('named on null', 'white')}; "
        f"effects {outside} called unknown: {unknown}, given a wrong name and no word of unknown: {wrong}.",
        _beside_bic(study.baselines),
    )
    return "\n".join(lines)


def _alarms(study):
    """How many of all empty records are named, whatever their noise; "" where no rule was held beside."""
    rows = () if study.baselines is None else study.baselines.to_dict("records")
    own = (r for r in rows if (r["rule"], r["measure"]) == ("sonicvacuum", ALARM) and r["group"] in GROUPS)
    return percent(next(own, None)) if rows else ""


def _beside_bic(baselines):
    """What BIC does on the same records; where it was not tried, what it did in the study before."""
    if baselines is None:
        return (
            "Naming alone is no better than that of the Bayesian information criterion, BIC: on the study "
            "before, 83.3 % against 83.1 %; but BIC named 6.3 % of empty records, and 86.8 % of effects that "
            "no catalogue holds."
        )
    rows = {(r["rule"], r["measure"]): r for r in baselines.to_dict("records") if r["group"] in GROUPS}
    own, other = rows["sonicvacuum", EXACT], rows["bic", EXACT]
    better = float(own["low"]) > float(other["high"])
    both = {
        what: [percent(rows.get((rule, what))) for rule in ("bic", "sonicvacuum")] for what in (ALARM, WRONG)
    }
    return (
        f"Naming alone is {'better than' if better else 'no better than'} that of the Bayesian information "
        f"criterion, BIC: {percent(own)} against {percent(other)}. But BIC names more where it should not: "
        f"of empty records {both[ALARM][0]}, this method {both[ALARM][1]}; of effects that no catalogue "
        f"holds {both[WRONG][0]}, this method {both[WRONG][1]}, where any name counts, also one beside "
        "which something unknown is said to be left."
    )


def markdown(study: Study) -> str:
    """The part of docs/study.md that is made: tables and pictures, with a sentence each."""
    parts = [
        BEFORE if study.score is None else provenance(study.score),
        told(study),
        results(study.summary).markdown,
        *([] if study.score is None else [MEANT]),
        HELD_OUT,
        f"![Share of right names against the strength of what is hidden]({PICTURE.format('accuracy')})",
        "What is taken for what, and whether stated probabilities and intervals come true: "
        "[figures/README.md](../figures/README.md).",
    ]
    parts += _section(
        study.baselines,
        rivals,
        "The same records given to simpler rules (shares in per cent, 95 % intervals):",
        "Simpler rules were not tried on these records.",
    )
    parts += _section(
        study.resolved,
        followed,
        "Records of which several effects were left (of a part of the study), taken together with one "
        "more run, the one that the verdict proposes or one drawn from all that it could propose:",
        "No further run was tried on records left ambiguous.",
    )
    parts += _section(
        study.fresh,
        followed,
        "One fresh run of the same laboratory, under conditions drawn at random, for a part of the "
        "records: how well the model as found and the nominal one foretell it, nothing fitted but the "
        "run's own errors:",
    )
    return "\n\n".join(parts)


def _section(table, shown, said, without=""):
    """A sentence and the table as it is shown; what is said instead where there is none."""
    return [said, shown(table).markdown] if table is not None else [without] * bool(without)


def publish(folder, page_path, kept_folder, readme_path=None) -> None:
    """Copy a study's tables to their place in git, and renew their page and the lines of the README.

    Raises:
        InputError: where a table is missing or has other columns, or the page lacks the markers; nothing
            is written then.
    """
    folder, kept_folder = Path(folder), Path(kept_folder)
    texts = {name: read_text(folder / f"{name}.csv") for name in KEPT}
    texts |= {n: read_text(folder / f"{n}.csv") for n in ALSO_KEPT if (folder / f"{n}.csv").exists()}
    study = read(folder)
    renewed = {page_path: with_study(read_text(page_path), markdown(study), page_path)}
    if readme_path:
        renewed[readme_path] = with_study(read_text(readme_path), in_short(study), readme_path)
    for name in (*KEPT, *ALSO_KEPT):
        path = kept_folder / f"{name}.csv"
        if name in texts:
            with replacing(path) as stream:
                stream.write(texts[name])
        else:
            path.unlink(missing_ok=True)
    for path, text in renewed.items():
        with replacing(path) as stream:
            stream.write(text)


def with_study(page: str, text: str, path="docs/study.md") -> str:
    """The page with the text between the study's markers replaced; InputError without markers."""
    if BEGIN not in page or END not in page:
        raise InputError(f"{path}: the markers are missing; put {BEGIN} and {END} around the study's table")
    before, rest = page.split(BEGIN, 1)
    return f"{before}{BEGIN}\n{text.strip()}\n{END}{rest.split(END, 1)[1]}"
