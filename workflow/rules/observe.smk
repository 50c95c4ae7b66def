"""Gauge readings and metrics of each card, and all metrics in one table."""


rule observe:
    input:
        card="results/cards/{card}.json",
        history="results/histories/{card}.npz",
    output:
        signals="results/signals/{card}.csv",
        metrics="results/metrics/{card}.csv",
    log:
        "results/logs/observe/{card}.log",
    benchmark:
        "results/benchmarks/observe/{card}.tsv"
    conda:
        ENVIRONMENT
    params:
        sources=sources("paper observe"),
    message:
        "Reading the gauges of {wildcards.card}"
    shell:
        "sonicvacuum paper observe {input.card:q} {input.history:q} --signals {output.signals:q}"
        " --metrics {output.metrics:q} 2> {log:q}"


rule metrics:
    input:
        metrics=expand("results/metrics/{card}.csv", card=CARDS),
    output:
        metrics="results/metrics.csv",
        absent="results/absent.csv",
    log:
        "results/logs/metrics.log",
    benchmark:
        "results/benchmarks/metrics.tsv"
    conda:
        ENVIRONMENT
    params:
        sources=sources("paper metrics"),
        config=CONFIG_FILE,
        # The columns of the ledger decide which variants are compared.
        ledger=CONFIG.ledger,
    message:
        "Gathering the metrics of all cards"
    shell:
        "sonicvacuum paper metrics {input.metrics:q} --config {params.config:q} --out {output.metrics:q} 2> {log:q}"
