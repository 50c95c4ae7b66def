"""Slips of the laboratory, with and without hidden effects: made, searched without the truth, counted.

Asked for by name (`make slips`); the tables of a run become those in git with publish_slips.
"""

SLIPS = "results/blind_slips"
SLIP_BATCHES = 8
SLIP_TABLES = home("workflow/resources/reference/slips")


rule make_slips:
    output:
        records=directory(f"{SLIPS}/records/{{batch}}"),
        truth=directory(f"{SLIPS}/truth/{{batch}}"),
    log:
        "results/logs/make_slips/{batch}.log",
    benchmark:
        "results/benchmarks/make_slips/{batch}.tsv"
    conda:
        ENVIRONMENT
    params:
        sources=sources("blind slips", without=CATALOGUE),
        batches=SLIP_BATCHES,
    message:
        "Making slips, batch {wildcards.batch}"
    shell:
        "sonicvacuum blind slips --batch {wildcards.batch:q}/{params.batches:q}"
        " --records {output.records:q} --truth {output.truth:q} > {log:q} 2>&1"


rule discover_slips:
    input:
        records=f"{SLIPS}/records/{{batch}}",
    output:
        directory(f"{SLIPS}/verdicts/{{batch}}"),
    log:
        "results/logs/discover_slips/{batch}.log",
    benchmark:
        "results/benchmarks/discover_slips/{batch}.tsv"
    conda:
        ENVIRONMENT
    params:
        sources=sources("discover", without=PAGES),
    message:
        "Discovering what is off in slips, batch {wildcards.batch}"
    shell:
        "sonicvacuum discover {input.records:q}/* --out {output:q} --no-figures --threads {threads:q} > {log:q} 2>&1"


rule score_slips:
    input:
        truth=expand(f"{SLIPS}/truth/{{batch}}", batch=range(SLIP_BATCHES)),
        verdicts=expand(f"{SLIPS}/verdicts/{{batch}}", batch=range(SLIP_BATCHES)),
    output:
        rows=f"{SLIPS}/records.csv",
        summary=f"{SLIPS}/summary.csv",
    log:
        "results/logs/score_slips.log",
    conda:
        ENVIRONMENT
    params:
        sources=sources("blind slips-score", without=CATALOGUE),
        truth=lambda wildcards, input: Path(input.truth[0]).parent,
        verdicts=lambda wildcards, input: Path(input.verdicts[0]).parent,
    message:
        "Counting slips and effects that were named"
    shell:
        "sonicvacuum blind slips-score --truth {params.truth:q} --verdicts {params.verdicts:q}"
        " --out {output.rows:q} --summary {output.summary:q} > {log:q} 2>&1"


# Run on purpose, as publish_study is.
rule publish_slips:
    input:
        rows=f"{SLIPS}/records.csv",
        summary=f"{SLIPS}/summary.csv",
    log:
        "results/logs/publish_slips.log",
    localrule: True
    conda:
        ENVIRONMENT
    params:
        keep=SLIP_TABLES,
    message:
        "Keeping the tables of the slips in git"
    shell:
        "(mkdir -p {params.keep:q} && cp {input.rows:q} {input.summary:q} {params.keep:q}) > {log:q} 2>&1"
