"""Where each product comes from, in a file beside it."""


rule provenance:
    input:
        # All but the times, which differ from run to run.
        products=[path for path in PRODUCTS if path != "results/benchmarks.csv"],
        given=[CONFIG_FILE, *LOCKS],
        script=home("workflow/scripts/provenance.py"),
    output:
        expand("{folder}/provenance.json", folder=PUBLISHED),
    log:
        "results/logs/provenance.log",
    localrule: True
    conda:
        ENVIRONMENT
    message:
        "Writing where each product comes from"
    shell:
        "python {input.script:q} {input.products:q} --out {output:q} --given {input.given:q} 2> {log:q}"
