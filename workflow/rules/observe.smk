"""Gauge readings and metrics of each card, and all metrics in one table."""


rule observe:
    input:
        card="results/cards/{card}.json",
        history="results/histories/{card}.npz",
        sources=sources("card", "physics", "observe"),
    output:
        signals="results/signals/{card}.csv",
        metrics="results/metrics/{card}.csv",
    log:
        "results/logs/observe/{card}.log",
    benchmark:
        "results/benchmarks/observe/{card}.tsv"
    message:
        "Reading the gauges of {wildcards.card}"
    shell:
        "sonicvacuum observe {input.card} {input.history} --signals {output.signals}"
        " --metrics {output.metrics} 2> {log}"


rule metrics:
    input:
        metrics=expand("results/metrics/{card}.csv", card=CARDS),
        sources=sources("card", "physics", "observe"),
    output:
        "results/metrics.csv",
    log:
        "results/logs/metrics.log",
    benchmark:
        "results/benchmarks/metrics.tsv"
    params:
        # The columns of the ledger decide which variants are compared.
        ledger=CONFIG.ledger,
    message:
        "Gathering the metrics of {CARDS}"
    shell:
        "sonicvacuum metrics {input.metrics} --config {CONFIG_FILE} --out {output} 2> {log}"
