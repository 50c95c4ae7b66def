"""What the paper leaves open of its experiment, drawn together; and what would tell the rival models apart."""


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


rule rivals:
    output:
        contours="results/identifiability.csv",
        picture=report("results/identifiability.svg", category="Figures", caption="../report/rivals.rst"),
        experiments=report("results/experiments.csv", category="Tables", caption="../report/rivals.rst"),
        relaxation=report("results/relaxation.csv", category="Tables", caption="../report/rivals.rst"),
    log:
        "results/logs/rivals.log",
    benchmark:
        "results/benchmarks/rivals.tsv"
    conda:
        ENVIRONMENT
    params:
        sources=sources("paper rivals"),
        config=CONFIG_FILE,
        cases=lambda wildcards: msgspec.json.encode([CONFIG.cases.get("fig3a"), CONFIG.ledger]).decode(),
    message:
        "Comparing the rival models of the coating"
    shell:
        "sonicvacuum paper rivals --config {params.config:q} --map {output.contours:q} --picture {output.picture:q}"
        " --experiments {output.experiments:q} --relaxation {output.relaxation:q} 2> {log:q}"
