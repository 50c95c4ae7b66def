"""Gauge readings and metrics of each card, and all metrics in one table."""

for number, (batch, names) in enumerate(CARD_BATCHES.items()):

    rule:
        name:
            f"observe_{number}"
        input:
            cards=expand("results/cards/{card}.json", card=names),
            histories=expand("results/histories/{card}.npz", card=names),
        output:
            signals=expand("results/signals/{card}.csv", card=names),
            metrics=expand("results/metrics/{card}.csv", card=names),
        log:
            f"results/logs/observe/{batch}.log",
        benchmark:
            f"results/benchmarks/observe/{batch}.tsv"
        conda:
            ENVIRONMENT
        params:
            sources=sources("paper observe"),
        message:
            f"Reading the gauges of {batch}"
        shell:
            "sonicvacuum paper observe {input.cards:q} --histories results/histories --signals results/signals"
            " --metrics results/metrics 2> {log:q}"


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
