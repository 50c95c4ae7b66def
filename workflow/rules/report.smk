"""The ledger of claims, the audit of assumptions, the page, and what of them is kept in git."""

CLAIMS = "workflow/resources/claims.csv"
ASSUMPTIONS = "workflow/resources/assumptions.csv"
REFERENCE = "workflow/resources/reference/ledger.csv"


rule ledger:
    input:
        metrics="results/metrics.csv",
        claims=CLAIMS,
        sources=sources("card", "ledger"),
    output:
        report("results/ledger.csv", category="Tables", caption="../report/ledger.rst"),
    log:
        "results/logs/ledger.log",
    benchmark:
        "results/benchmarks/ledger.tsv"
    params:
        columns=CONFIG.ledger,
    message:
        "Holding the claims against the metrics"
    shell:
        "sonicvacuum ledger {input.metrics} --claims {input.claims} --config {CONFIG_FILE}"
        " --out {output} 2> {log}"


rule audit:
    input:
        metrics="results/metrics.csv",
        assumptions=ASSUMPTIONS,
        sources=sources("card", "ledger"),
    output:
        report("results/assumptions.csv", category="Tables", caption="../report/assumptions.rst"),
    log:
        "results/logs/audit.log",
    benchmark:
        "results/benchmarks/audit.tsv"
    params:
        columns=CONFIG.ledger,
    message:
        "Holding the assumptions against the metrics"
    shell:
        "sonicvacuum audit {input.metrics} --assumptions {input.assumptions} --config {CONFIG_FILE}"
        " --out {output} 2> {log}"


rule page:
    input:
        ledger="results/ledger.csv",
        assumptions="results/assumptions.csv",
        metrics="results/metrics.csv",
        claims=CLAIMS,
        figures=expand("figures/{figure}.svg", figure=FIGURES),
        captions=expand("workflow/report/{figure}.rst", figure=FIGURES),
        cards=expand("results/cards/{card}.json", card=CARDS),
        locks=LOCKS,
        template="src/sonicvacuum/report/page.html.j2",
        sources=sources("card", "report"),
    output:
        report("results/report.html", category="Report", caption="../report/page.rst"),
    log:
        "results/logs/page.log",
    benchmark:
        "results/benchmarks/page.tsv"
    params:
        figures=lambda wildcards, input: [f"--figure {path}" for path in input.figures],
        captions=lambda wildcards, input: [f"--caption {path}" for path in input.captions],
        cards=lambda wildcards, input: [f"--card {path}" for path in input.cards],
        locks=lambda wildcards, input: [f"--lock {path}" for path in input.locks],
    message:
        "Writing the report"
    shell:
        "sonicvacuum report --ledger {input.ledger} --assumptions {input.assumptions}"
        " --metrics {input.metrics} --claims {input.claims} {params.figures} {params.captions}"
        " {params.cards} {params.locks} --out {output} 2> {log}"


rule timings:
    input:
        # Benchmark files are no outputs: this waits for the last rules and reads what stands there.
        "results/report.html",
        sources=sources("report"),
    output:
        "results/benchmarks.csv",
    log:
        "results/logs/timings.log",
    message:
        "Summarising the time that each rule took"
    shell:
        "sonicvacuum timings results/benchmarks --out {output} 2> {log}"


rule publish:
    """Keep the present ledger in git as the reference and renew the README's table (run on purpose)."""
    input:
        "results/ledger.csv",
    localrule: True
    shell:
        "sonicvacuum publish --ledger {input} --readme README.md --reference {REFERENCE}"


rule reproduce:
    """Make figures' numbers and ledger anew in clean folders and compare them with those in git."""
    localrule: True
    shell:
        "python workflow/scripts/reproduce.py"
