"""What the paper leaves open of its experiment, drawn together: how probable each statement is under each model."""


rule uncertainty:
    input:
        claims=home("workflow/resources/claims.csv"),
    output:
        report("results/uncertainty.csv", category="Tables", caption="../report/uncertainty.rst"),
    log:
        "results/logs/uncertainty.log",
    benchmark:
        "results/benchmarks/uncertainty.tsv"
    conda:
        ENVIRONMENT
    params:
        sources=sources("paper uncertainty"),
        config=CONFIG_FILE,
        # An edit of a case or of the models makes it anew.
        cases=lambda wildcards: msgspec.json.encode([CONFIG.cases, CONFIG.ledger]).decode(),
    message:
        "Drawing what the paper leaves open"
    shell:
        "sonicvacuum paper uncertainty --claims {input.claims:q} --config {params.config:q} --out {output:q} 2> {log:q}"
