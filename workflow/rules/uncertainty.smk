"""What the paper leaves open of its experiment, drawn together; and what would tell the rival models apart."""


rule uncertainty:
    input:
        claims=home("workflow/resources/claims.csv"),
        named=expand("results/cards/{card}.json", card=[c for c in CARDS if c.endswith(".named")]),
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
        cases=lambda wildcards: text(CONFIG.cases, CONFIG.ledger),
        named=lambda wildcards, input: repeated("--named", input.named),
    message:
        "Drawing what the paper leaves open"
    shell:
        "sonicvacuum paper uncertainty --claims {input.claims:q} --config {params.config:q}"
        " {params.named:q} --out {output:q} 2> {log:q}"


rule rivals:
    input:
        record=home("workflow/resources/measured/daraio-nesterenko-2006-coated/record.yaml"),
    output:
        contours="results/identifiability.csv",
        picture=report("results/identifiability.svg", category="Figures", caption="../report/rivals.rst"),
        experiments=report("results/experiments.csv", category="Tables", caption="../report/rivals.rst"),
        relaxation=report("results/relaxation.csv", category="Tables", caption="../report/rivals.rst"),
        losses=report("results/losses.csv", category="Tables", caption="../report/rivals.rst"),
        explained=report("results/explained.csv", category="Tables", caption="../report/rivals.rst"),
    log:
        "results/logs/rivals.log",
    benchmark:
        "results/benchmarks/rivals.tsv"
    conda:
        ENVIRONMENT
    params:
        sources=sources("paper rivals"),
        config=CONFIG_FILE,
        cases=lambda wildcards: text(
            *(CONFIG.cases.get(case) for case in ("fig3a", "fig5a", "fig6b")), CONFIG.ledger
        ),
    message:
        "Comparing the rival models of the coating"
    shell:
        "sonicvacuum paper rivals --config {params.config:q} --map {output.contours:q} --picture {output.picture:q}"
        " --experiments {output.experiments:q} --relaxation {output.relaxation:q} --losses {output.losses:q}"
        " --record {input.record:q} --explained {output.explained:q} 2> {log:q}"
