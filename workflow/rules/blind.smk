"""Blind test of discover: hide effects in records, discover without the truth, score against it.

Cases go through in batches, so that starting processes costs little. Truths lie beside the records, never in the
folders that discover is given.
"""

# Study → number of batches.
BATCHES = {"small": 4, "full": 84}
BLIND = "results/blind/{study}"


wildcard_constraints:
    study="small|full",
    batch="[0-9]+",


rule hide:
    input:
        sources=sources("card", "physics", "blind"),
    output:
        records=directory(f"{BLIND}/records/{{batch}}"),
        truth=directory(f"{BLIND}/truth/{{batch}}"),
    log:
        "results/logs/hide/{study}-{batch}.log",
    benchmark:
        "results/benchmarks/hide/{study}-{batch}.tsv"
    conda:
        ENVIRONMENT
    params:
        batches=lambda wildcards: BATCHES[wildcards.study],
    message:
        "Hiding effects in batch {wildcards.batch} of the {wildcards.study} study"
    shell:
        "sonicvacuum hide --study {wildcards.study} --batch {wildcards.batch}/{params.batches}"
        " --records {output.records} --truth {output.truth} > {log} 2>&1"


rule discover_hidden:
    input:
        records=f"{BLIND}/records/{{batch}}",
        sources=sources("card", "physics", "discover"),
    output:
        directory(f"{BLIND}/verdicts/{{batch}}"),
    log:
        "results/logs/discover_hidden/{study}-{batch}.log",
    benchmark:
        "results/benchmarks/discover_hidden/{study}-{batch}.tsv"
    conda:
        ENVIRONMENT
    message:
        "Discovering what is hidden in batch {wildcards.batch} of the {wildcards.study} study"
    shell:
        "sonicvacuum discover {input.records}/* --out {output} --no-figures > {log} 2>&1"


rule score:
    input:
        truth=lambda wildcards: expand(
            f"{BLIND}/truth/{{batch}}", study=wildcards.study, batch=range(BATCHES[wildcards.study])
        ),
        verdicts=lambda wildcards: expand(
            f"{BLIND}/verdicts/{{batch}}", study=wildcards.study, batch=range(BATCHES[wildcards.study])
        ),
        sources=sources("card", "blind"),
    output:
        score=f"{BLIND}/score.csv",
        summary=f"{BLIND}/summary.csv",
    log:
        "results/logs/score/{study}.log",
    benchmark:
        "results/benchmarks/score/{study}.tsv"
    conda:
        ENVIRONMENT
    params:
        folder=lambda wildcards: f"results/blind/{wildcards.study}",
    message:
        "Scoring the {wildcards.study} study"
    shell:
        "sonicvacuum score --truth {params.folder}/truth --verdicts {params.folder}/verdicts"
        " --out {output.score} --summary {output.summary} > {log} 2>&1"


rule blind_small:
    input:
        "results/blind/small/summary.csv",


rule blind_full:
    input:
        "results/blind/full/summary.csv",
