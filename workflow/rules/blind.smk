"""Blind test of discover: hide effects in records, discover without the truth, score against it.

Cases go through in batches, so that starting processes costs little. Truths lie beside the records, never in the
folders that discover is given. Simpler rules see the same cases; two of them need what `make study` installs.
"""


wildcard_constraints:
    study="|".join(BATCHES),
    batch="[0-9]+",
    picture="|".join(PICTURES),
    choice="|".join(CHOICES),


rule hide:
    output:
        records=directory(f"{BLIND}/records/{{batch}}"),
        truth=directory(f"{BLIND}/truth/{{batch}}"),
    log:
        "results/logs/hide/{study}-{batch}.log",
    benchmark:
        "results/benchmarks/hide/{study}-{batch}.tsv"
    priority: 1
    conda:
        ENVIRONMENT
    params:
        sources=sources("blind hide", without=CATALOGUE),
        batches=lambda wildcards: BATCHES[wildcards.study],
    message:
        "Hiding effects in batch {wildcards.batch} of the {wildcards.study} study"
    shell:
        "sonicvacuum blind hide --study {wildcards.study:q} --batch {wildcards.batch:q}/{params.batches:q}"
        " --records {output.records:q} --truth {output.truth:q} > {log:q} 2>&1"


rule discover_hidden:
    input:
        records=f"{BLIND}/records/{{batch}}",
    output:
        directory(f"{BLIND}/verdicts/{{batch}}"),
    log:
        "results/logs/discover_hidden/{study}-{batch}.log",
    benchmark:
        "results/benchmarks/discover_hidden/{study}-{batch}.tsv"
    priority: 1
    conda:
        ENVIRONMENT
    params:
        sources=sources("discover", without=PAGES),
    message:
        "Discovering what is hidden in batch {wildcards.batch} of the {wildcards.study} study"
    shell:
        "sonicvacuum discover {input.records:q}/* --out {output:q} --no-figures --threads {threads:q} > {log:q} 2>&1"


# Known from the list of cases alone, while records are still being looked into.
rule ideal:
    output:
        f"{BLIND}/ideal/{{batch}}.csv",
    log:
        "results/logs/ideal/{study}-{batch}.log",
    benchmark:
        "results/benchmarks/ideal/{study}-{batch}.tsv"
    conda:
        ENVIRONMENT
    params:
        sources=sources("blind ideal", without=CATALOGUE),
        batches=lambda wildcards: BATCHES[wildcards.study],
    message:
        "Asking the ideal rule about batch {wildcards.batch} of the {wildcards.study} study"
    shell:
        "sonicvacuum blind ideal --study {wildcards.study:q} --batch {wildcards.batch:q}/{params.batches:q}"
        " --out {output:q} > {log:q} 2>&1"


rule score:
    input:
        truth=batches("truth"),
        verdicts=batches("verdicts"),
        ideal=ideal,
    output:
        f"{BLIND}/score.csv",
        f"{BLIND}/summary.csv",
        expand(f"{BLIND}/{{table}}.csv", table=DETAILS, allow_missing=True),
    log:
        "results/logs/score/{study}.log",
    benchmark:
        "results/benchmarks/score/{study}.tsv"
    conda:
        ENVIRONMENT
    params:
        sources=sources("blind score", without=CATALOGUE),
        folder=lambda wildcards: f"results/blind/{wildcards.study}",
        ideal=lambda wildcards, input: repeated("--ideal", input.ideal),
    message:
        "Scoring the {wildcards.study} study"
    shell:
        "sonicvacuum blind score --truth {params.folder:q}/truth --verdicts {params.folder:q}/verdicts {params.ideal:q}"
        " --out {params.folder:q}/score.csv --summary {params.folder:q}/summary.csv --tables {params.folder:q}"
        " > {log:q} 2>&1"


rule baselines:
    input:
        records=batches("records"),
        truth=batches("truth"),
        verdicts=batches("verdicts"),
        ideal=ideal,
        training=training,
        lock=home("requirements-study.lock"),
    output:
        f"{BLIND}/baselines.csv",
    log:
        "results/logs/baselines/{study}.log",
    benchmark:
        "results/benchmarks/baselines/{study}.tsv"
    conda:
        ENVIRONMENT
    params:
        sources=sources("blind baselines"),
        folder=lambda wildcards: f"results/blind/{wildcards.study}",
        ideal=lambda wildcards, input: repeated("--ideal", input.ideal),
        training=lambda wildcards, input: repeated(
            "--training", ["results/blind/training"] if input.training else []
        ),
    message:
        "Trying simpler rules on the {wildcards.study} study"
    shell:
        "sonicvacuum blind baselines --records {params.folder:q}/records --truth {params.folder:q}/truth"
        " --verdicts {params.folder:q}/verdicts {params.ideal:q} {params.training:q} --out {output:q} > {log:q} 2>&1"


rule draw_study:
    input:
        table=f"{BLIND}/{{picture}}.csv",
    output:
        svg=f"{BLIND}/{{picture}}.svg",
        png=f"{BLIND}/{{picture}}.png",
    log:
        "results/logs/draw_study/{study}-{picture}.log",
    conda:
        ENVIRONMENT
    params:
        sources=sources("blind draw"),
        folder=lambda wildcards, input: Path(input.table).parent,
    message:
        "Drawing {wildcards.picture} of the {wildcards.study} study"
    shell:
        "sonicvacuum blind draw {params.folder:q} --picture {wildcards.picture:q} > {log:q} 2>&1"


# The full study takes hours: its tables are kept in git and drawn from there.
rule draw_kept:
    input:
        table=f"{STUDY_TABLES}/{{picture}}.csv",
    output:
        svg="figures/blind_{picture}.svg",
        png="figures/blind_{picture}.png",
    log:
        "results/logs/draw_kept/{picture}.log",
    conda:
        ENVIRONMENT
    params:
        sources=sources("blind draw"),
        folder=lambda wildcards, input: Path(input.table).parent,
    message:
        "Drawing {wildcards.picture} of the full study as kept in git"
    shell:
        "sonicvacuum blind draw {params.folder:q} --picture {wildcards.picture:q} --out figures --prefix blind_ > {log:q} 2>&1"


rule blind_page:
    input:
        small="results/blind/small/summary.csv",
        full=sorted(Path(STUDY_TABLES).glob("*.csv")),
        pictures=expand("figures/{picture}.svg", picture=STUDY),
    output:
        report("results/blind.html", category="Report", labels={"page": "blind studies"}),
    log:
        "results/logs/blind_page.log",
    benchmark:
        "results/benchmarks/blind_page.tsv"
    conda:
        ENVIRONMENT
    params:
        sources=sources("blind page"),
        full=lambda wildcards, input: Path(input.full[0]).parent,
        pictures=lambda wildcards, input: repeated("--picture", input.pictures),
    message:
        "Writing the page of the blind studies"
    shell:
        "sonicvacuum blind page --small {input.small:q} --full {params.full:q} {params.pictures:q}"
        " --out {output:q} 2> {log:q}"


# The small study with what the default environment can draw; its baselines: blind_small_baselines.
rule blind_small:
    input:
        "results/blind/small/summary.csv",
        expand("results/blind/small/{picture}.svg", picture=PICTURES[:-1]),


rule blind_small_baselines:
    input:
        "results/blind/small/baselines.svg",


rule blind_full:
    input:
        "results/blind/full/summary.csv",
        expand("results/blind/full/{picture}.svg", picture=PICTURES),


# Run on purpose: the tables of this run become those that docs/study.md, README and report quote. What takes longer
# (simpler rules, one more run, fresh runs) is kept where it has been made.
rule publish_study:
    input:
        tables=expand("results/blind/full/{table}.csv", table=["summary", "score", *DETAILS]),
    log:
        "results/logs/publish_study.log",
    localrule: True
    conda:
        ENVIRONMENT
    params:
        page=home("docs/study.md"),
        readme=home("README.md"),
        folder=lambda wildcards, input: Path(input.tables[0]).parent,
        keep=STUDY_TABLES,
    message:
        "Keeping the blind study in git and in docs/study.md"
    shell:
        "sonicvacuum blind publish {params.folder:q} --page {params.page:q} --readme {params.readme:q} --keep {params.keep:q} > {log:q} 2>&1"


# One more run for each case left ambiguous: the one that its verdict proposes, or a random one.
rule follow:
    input:
        verdicts=f"{BLIND}/verdicts/{{batch}}",
    output:
        directory(f"{BLIND}/followed/{{choice}}/{{batch}}"),
    log:
        "results/logs/follow/{study}-{choice}-{batch}.log",
    benchmark:
        "results/benchmarks/follow/{study}-{choice}-{batch}.tsv"
    conda:
        ENVIRONMENT
    params:
        sources=sources("blind follow", without=CATALOGUE),
        batches=lambda wildcards: BATCHES[wildcards.study],
    message:
        "Making {wildcards.choice} runs for ambiguous cases in batch {wildcards.batch} of the {wildcards.study} study"
    shell:
        "sonicvacuum blind follow --study {wildcards.study:q} --batch {wildcards.batch:q}/{params.batches:q}"
        " --verdicts {input.verdicts:q} --choice {wildcards.choice:q} --records {output:q} > {log:q} 2>&1"


rule discover_followed:
    input:
        records=f"{BLIND}/records/{{batch}}",
        followed=f"{BLIND}/followed/{{choice}}/{{batch}}",
    output:
        directory(f"{BLIND}/joint/{{choice}}/{{batch}}"),
    log:
        "results/logs/discover_followed/{study}-{choice}-{batch}.log",
    benchmark:
        "results/benchmarks/discover_followed/{study}-{choice}-{batch}.tsv"
    conda:
        ENVIRONMENT
    params:
        sources=sources("discover", without=PAGES),
    message:
        "Discovering with {wildcards.choice} runs in batch {wildcards.batch} of the {wildcards.study} study"
    shell:
        '(mkdir -p {output:q}; for run in {input.followed:q}/*/; do [ -d "$run" ] || continue;'
        ' id=$(basename "$run");'
        ' sonicvacuum discover --together {input.records:q}/"$id" "$run" --out {output:q}/"$id" --no-figures'
        " --threads {threads:q}; done) > {log:q} 2>&1"


rule resolved:
    input:
        truth=batches("truth"),
        verdicts=batches("verdicts"),
        proposed=some_batches("followed/proposed"),
        proposed_joint=some_batches("joint/proposed"),
        random=some_batches("followed/random"),
        random_joint=some_batches("joint/random"),
    output:
        rows=f"{BLIND}/resolved.csv",
        summary=f"{BLIND}/resolved_summary.csv",
    log:
        "results/logs/resolved/{study}.log",
    benchmark:
        "results/benchmarks/resolved/{study}.tsv"
    conda:
        ENVIRONMENT
    params:
        sources=sources("blind resolved", without=CATALOGUE),
        folder=lambda wildcards: f"results/blind/{wildcards.study}",
    message:
        "Counting the ambiguous cases of the {wildcards.study} study that one more run decides"
    shell:
        "sonicvacuum blind resolved --truth {params.folder:q}/truth --verdicts {params.folder:q}/verdicts"
        " --proposed {params.folder:q}/followed/proposed {params.folder:q}/joint/proposed"
        " --random {params.folder:q}/followed/random {params.folder:q}/joint/random"
        " --out {output.rows:q} --summary {output.summary:q} > {log:q} 2>&1"


# A run that discover never had, of a part of the study: what the model found foretells of it, and the nominal one.
rule compare_fresh:
    input:
        verdicts=f"{BLIND}/verdicts/{{batch}}",
        followed=f"{BLIND}/followed/fresh/{{batch}}",
    output:
        directory(f"{BLIND}/foretold/{{batch}}"),
    log:
        "results/logs/compare_fresh/{study}-{batch}.log",
    benchmark:
        "results/benchmarks/compare_fresh/{study}-{batch}.tsv"
    conda:
        ENVIRONMENT
    params:
        sources=sources("compare"),
    message:
        "Comparing models with fresh runs in batch {wildcards.batch} of the {wildcards.study} study"
    shell:
        '(mkdir -p {output:q}; for run in {input.followed:q}/*/; do [ -d "$run" ] || continue;'
        ' id=$(basename "$run"); mkdir -p {output:q}/"$id";'
        ' sonicvacuum compare --model {input.verdicts:q}/"$id/model.json" "$run" --threads {threads:q}'
        ' --json {output:q}/"$id/compared.json"; done) > {log:q} 2>&1'


rule foretold:
    input:
        truth=batches("truth"),
        verdicts=batches("verdicts"),
        compared=some_batches("foretold"),
    output:
        rows=f"{BLIND}/fresh_rows.csv",
        summary=f"{BLIND}/fresh.csv",
    log:
        "results/logs/foretold/{study}.log",
    benchmark:
        "results/benchmarks/foretold/{study}.tsv"
    conda:
        ENVIRONMENT
    params:
        sources=sources("blind foretold", without=CATALOGUE),
        folder=lambda wildcards: f"results/blind/{wildcards.study}",
    message:
        "Counting what models of the {wildcards.study} study foretell of fresh runs"
    shell:
        "sonicvacuum blind foretold --truth {params.folder:q}/truth --verdicts {params.folder:q}/verdicts"
        " --compared {params.folder:q}/foretold --out {output.rows:q} --summary {output.summary:q} > {log:q} 2>&1"


rule blind_fresh:
    input:
        "results/blind/full/fresh.csv",


rule blind_resolved:
    input:
        "results/blind/full/resolved.csv",


# Contact laws from outside the catalogue: what models with a law of no particular form foretell of runs they never had.
rule blind_laws:
    input:
        "results/blind/laws/fresh.csv",


# A later method on a fresh seed: a part of the list of the full study. Run on purpose, as publish_study is.
rule publish_again:
    input:
        tables=expand(
            "results/blind/again/{table}.csv",
            table=["score", "parameters", "summary", "resolved_summary", "fresh"],
        ),
    log:
        "results/logs/publish_again.log",
    localrule: True
    conda:
        ENVIRONMENT
    params:
        page=home("docs/again.md"),
        keep=home("workflow/resources/reference/blind_again"),
        again="results/blind/again/again",
    message:
        "Keeping the fresh sample of the study in git and in docs/again.md"
    shell:
        "(mkdir -p {params.keep:q} && cp {input.tables:q} {params.keep:q}"
        " && sonicvacuum blind tables {params.keep:q} --out {params.again:q} --page {params.page:q}) > {log:q} 2>&1"


# Run on purpose, as publish_study is.
rule publish_laws:
    input:
        rows="results/blind/laws/fresh_rows.csv",
        summary="results/blind/laws/fresh.csv",
    log:
        "results/logs/publish_laws.log",
    localrule: True
    conda:
        ENVIRONMENT
    params:
        keep=home("workflow/resources/reference/laws"),
    message:
        "Keeping the tables of laws outside the catalogue in git"
    shell:
        "(mkdir -p {params.keep:q} && cp {input.rows:q} {params.keep:q}/records.csv"
        " && cp {input.summary:q} {params.keep:q}/summary.csv) > {log:q} 2>&1"
