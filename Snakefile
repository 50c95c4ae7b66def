"""From the cases of config.yaml to Figures 3-6, the ledger of claims and the report; from the records of measured data to
what the model lacks; and the blind test of that.
"""

from snakemake.utils import min_version

min_version("9.0")


include: "workflow/rules/common.smk"
include: "workflow/rules/blind_common.smk"


rule all:
    default_target: True
    input:
        "results/report.html",
        "results/ledger.csv",
        "results/assumptions.csv",
        "results/benchmarks.csv",
        "results/blind/small/summary.csv",
        expand("results/discover/{record}/index.html", record=RECORDS),
        expand("figures/{figure}.{kind}", figure=FIGURES, kind=["csv", "svg", "png"]),
        expand("figures/{picture}.{kind}", picture=STUDY, kind=["svg", "png"]),


include: "workflow/rules/discover.smk"
include: "workflow/rules/cards.smk"
include: "workflow/rules/simulate.smk"
include: "workflow/rules/observe.smk"
include: "workflow/rules/figures.smk"
include: "workflow/rules/report.smk"
include: "workflow/rules/bench.smk"
include: "workflow/rules/blind.smk"


report: "workflow/report/workflow.rst"
