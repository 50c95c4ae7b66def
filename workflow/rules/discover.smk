"""What the nominal model lacks, record by record: verdict, extended model, tables, pictures and a page.

The pictures lie beside the tables; they are no outputs here, because which of them there are depends on what the
record holds.
"""

DISCOVERY = "results/discover/{record}"
FOUND = ["verdict.json", "model.json", *(f"{table}.csv" for table in TABLES), "index.html"]


rule discover:
    input:
        record=record_files,
        sources=sources("card", "physics", "discover", "pages"),
    output:
        found=expand(f"{DISCOVERY}/{{name}}", name=FOUND[:-1], allow_missing=True),
        page=report(f"{DISCOVERY}/index.html", category="Discovery", labels={"record": "{record}"}),
    log:
        "results/logs/discover/{record}.log",
    benchmark:
        "results/benchmarks/discover/{record}.tsv"
    conda:
        ENVIRONMENT
    params:
        folder=lambda wildcards: RECORDS[wildcards.record],
        out=lambda wildcards: f"results/discover/{wildcards.record}",
    message:
        "Discovering what the model of {wildcards.record} lacks"
    shell:
        "sonicvacuum discover {params.folder} --out {params.out} --threads {threads} > {log} 2>&1"
