"""Smooth systematic errors, and three and four effects: made, searched without the truth, counted.

Asked for by name (`make extras`); the tables of a run become those in git with publish_extras.
"""

EXTRAS = "results/blind_extras"
EXTRA_BATCHES = 8
EXTRA_TABLES = home("workflow/resources/reference/extras")


rule make_extras:
    output:
        records=directory(f"{EXTRAS}/records/{{batch}}"),
        truth=directory(f"{EXTRAS}/truth/{{batch}}"),
    log:
        "results/logs/make_extras/{batch}.log",
    benchmark:
        "results/benchmarks/make_extras/{batch}.tsv"
    conda:
        ENVIRONMENT
    params:
        sources=sources("blind extras", without=CATALOGUE),
        batches=EXTRA_BATCHES,
    message:
        "Making systematic errors and sets of effects, batch {wildcards.batch}"
    shell:
        "sonicvacuum blind extras --batch {wildcards.batch:q}/{params.batches:q}"
        " --records {output.records:q} --truth {output.truth:q} > {log:q} 2>&1"


rule discover_extras:
    input:
        records=f"{EXTRAS}/records/{{batch}}",
    output:
        directory(f"{EXTRAS}/verdicts/{{batch}}"),
    log:
        "results/logs/discover_extras/{batch}.log",
    benchmark:
        "results/benchmarks/discover_extras/{batch}.tsv"
    conda:
        ENVIRONMENT
    params:
        sources=sources("discover", without=PAGES),
    message:
        "Discovering what is missing beside them, batch {wildcards.batch}"
    shell:
        "sonicvacuum discover {input.records:q}/* --out {output:q} --no-figures --threads {threads:q} > {log:q} 2>&1"


rule score_extras:
    input:
        truth=expand(f"{EXTRAS}/truth/{{batch}}", batch=range(EXTRA_BATCHES)),
        verdicts=expand(f"{EXTRAS}/verdicts/{{batch}}", batch=range(EXTRA_BATCHES)),
    output:
        rows=f"{EXTRAS}/records.csv",
        summary=f"{EXTRAS}/summary.csv",
    log:
        "results/logs/score_extras.log",
    conda:
        ENVIRONMENT
    params:
        sources=sources("blind extras-score", without=CATALOGUE),
        truth=lambda wildcards, input: Path(input.truth[0]).parent,
        verdicts=lambda wildcards, input: Path(input.verdicts[0]).parent,
    message:
        "Counting effects that were named"
    shell:
        "sonicvacuum blind extras-score --truth {params.truth:q} --verdicts {params.verdicts:q}"
        " --out {output.rows:q} --summary {output.summary:q} > {log:q} 2>&1"


# Run on purpose, as publish_study is.
rule publish_extras:
    input:
        rows=f"{EXTRAS}/records.csv",
        summary=f"{EXTRAS}/summary.csv",
    log:
        "results/logs/publish_extras.log",
    localrule: True
    conda:
        ENVIRONMENT
    params:
        keep=EXTRA_TABLES,
    message:
        "Keeping the tables of systematic errors and sets in git"
    shell:
        "(mkdir -p {params.keep:q} && cp {input.rows:q} {input.summary:q} {params.keep:q}) > {log:q} 2>&1"
