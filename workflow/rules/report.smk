"""The ledger of claims, the audit of assumptions, the page, and what of them is kept in git."""

CLAIMS = home("workflow/resources/claims.csv")
ASSUMPTIONS = home("workflow/resources/assumptions.csv")


rule ledger:
    input:
        metrics="results/metrics.csv",
        absent="results/absent.csv",
        claims=CLAIMS,
        uncertainty="results/uncertainty.csv",
    output:
        report("results/ledger.csv", category="Tables", caption="../report/ledger.rst"),
    log:
        "results/logs/ledger.log",
    benchmark:
        "results/benchmarks/ledger.tsv"
    conda:
        ENVIRONMENT
    params:
        sources=sources("paper ledger"),
        config=CONFIG_FILE,
        columns=CONFIG.ledger,
    message:
        "Holding the claims against the metrics"
    shell:
        "sonicvacuum paper ledger {input.metrics:q} --claims {input.claims:q} --config {params.config:q}"
        " --uncertainty {input.uncertainty:q} --out {output:q} 2> {log:q}"


rule audit:
    input:
        metrics="results/metrics.csv",
        absent="results/absent.csv",
        assumptions=ASSUMPTIONS,
    output:
        report("results/assumptions.csv", category="Tables", caption="../report/assumptions.rst"),
    log:
        "results/logs/audit.log",
    benchmark:
        "results/benchmarks/audit.tsv"
    conda:
        ENVIRONMENT
    params:
        sources=sources("paper audit"),
        config=CONFIG_FILE,
        columns=CONFIG.ledger,
    message:
        "Holding the assumptions against the metrics"
    shell:
        "sonicvacuum paper audit {input.metrics:q} --assumptions {input.assumptions:q} --config {params.config:q}"
        " --out {output:q} 2> {log:q}"


rule page:
    input:
        ledger="results/ledger.csv",
        assumptions="results/assumptions.csv",
        metrics="results/metrics.csv",
        claims=CLAIMS,
        figures=expand("figures/{figure}.svg", figure=FIGURES),
        tables=expand("figures/{figure}.csv", figure=FIGURES),
        cards=expand("results/cards/{card}.json", card=CARDS),
        own=expand("results/histories/{card}.npz", card=OWN),
        locks=LOCKS,
        discoveries=expand("results/discover/{record}/index.html", record=RECORDS),
        contours="results/identifiability.csv",
        contours_picture="results/identifiability.svg",
        experiments="results/experiments.csv",
        relaxation="results/relaxation.csv",
        losses="results/losses.csv",
        explained="results/explained.csv",
        blind_full=sorted(Path(STUDY_TABLES).glob("*.csv")),
        animations=expand("results/animations/{name}.svg", name=ANIMATIONS),
        linked=["results/runs.html", "results/blind.html"],
    output:
        page=report("results/report.html", category="Report", caption="../report/page.rst"),
        sure=report("results/sure.html", category="Report", labels={"page": "how sure"}),
    log:
        "results/logs/page.log",
    benchmark:
        "results/benchmarks/page.tsv"
    conda:
        ENVIRONMENT
    params:
        sources=sources("paper report"),
        figures=lambda wildcards, input: repeated("--figure", input.figures),
        cards=lambda wildcards, input: repeated("--card", input.cards),
        locks=lambda wildcards, input: repeated("--lock", input.locks),
        discoveries=lambda wildcards, input: repeated(
            "--discovery", [Path(path).parent for path in input.discoveries]
        ),
        blind_full=lambda wildcards, input: Path(input.blind_full[0]).parent,
        histories=repeated("--histories", ["results/histories"] if OWN else []),
        animations=lambda wildcards, input: repeated("--animation", input.animations),
        linked=lambda wildcards, input: repeated("--linked", [Path(path).name for path in input.linked]),
    message:
        "Writing the report"
    shell:
        "sonicvacuum paper report --ledger {input.ledger:q} --assumptions {input.assumptions:q}"
        " --metrics {input.metrics:q} --claims {input.claims:q} {params.figures:q}"
        " {params.cards:q} {params.locks:q} {params.discoveries:q} --blind-full {params.blind_full:q}"
        " {params.histories:q} {params.animations:q} {params.linked:q}"
        " --map {input.contours:q} --map-picture {input.contours_picture:q} --experiments {input.experiments:q}"
        " --relaxation {input.relaxation:q} --losses {input.losses:q} --explained {input.explained:q} --sure {output.sure:q} --out {output.page:q}"
        " 2> {log:q}"


rule runs:
    input:
        cards=expand("results/cards/{card}.json", card=CARDS),
        histories=expand("results/histories/{card}.npz", card=CARDS),
        metrics="results/metrics.csv",
    output:
        report("results/runs.html", category="Report", labels={"page": "every run"}),
    log:
        "results/logs/runs.log",
    benchmark:
        "results/benchmarks/runs.tsv"
    conda:
        ENVIRONMENT
    params:
        sources=sources("paper runs"),
    message:
        "Drawing every run over place and time"
    shell:
        "sonicvacuum paper runs {input.cards:q} --histories results/histories --metrics {input.metrics:q}"
        " --out {output:q} 2> {log:q}"


rule animate:
    output:
        "results/animations/{name}.svg",
    log:
        "results/logs/animate/{name}.log",
    benchmark:
        "results/benchmarks/animate/{name}.tsv"
    conda:
        ENVIRONMENT
    params:
        sources=sources("paper animate"),
    message:
        "Drawing the moving picture {wildcards.name}"
    shell:
        "sonicvacuum paper animate {wildcards.name:q} --out {output:q} 2> {log:q}"


rule timings:
    input:
        # Benchmark files are no outputs: this waits for the last rules and reads what stands there.
        "results/report.html",
    output:
        "results/benchmarks.csv",
    log:
        "results/logs/timings.log",
    conda:
        ENVIRONMENT
    params:
        sources=sources("paper timings"),
    message:
        "Summarising the time that each rule took"
    shell:
        "sonicvacuum paper timings results/benchmarks --out {output:q} 2> {log:q}"


# Run on purpose: ledger and naming of this run become those that later runs are compared with.
rule publish:
    input:
        ledger="results/ledger.csv",
        claims=CLAIMS,
        study="results/blind/small/score.csv",
    log:
        "results/logs/publish.log",
    localrule: True
    conda:
        ENVIRONMENT
    params:
        readme="README.md",
        reference="workflow/resources/reference/ledger.csv",
        guide="figures/README.md",
        naming="workflow/resources/reference/blind_small.csv",
        # Made by `make bench` only, on purpose.
        benchmark=repeated("--benchmark", filter(os.path.exists, ["results/bench.md"])),
        speeds="docs/benchmark.md",
    message:
        "Keeping the ledger in git and in the README"
    shell:
        "sonicvacuum paper publish --ledger {input.ledger:q} --claims {input.claims:q} --readme {params.readme:q}"
        " --guide {params.guide:q} --reference {params.reference:q} --study {input.study:q} --naming {params.naming:q}"
        " {params.benchmark:q} --speeds {params.speeds:q} 2> {log:q}"


# Figure tables and ledger made anew in clean folders, compared with those in git.
rule reproduce:
    log:
        "results/logs/reproduce.log",
    localrule: True
    conda:
        ENVIRONMENT
    message:
        "Making everything anew in clean folders"
    shell:
        "python workflow/scripts/reproduce.py 2>&1 | tee {log:q}"
