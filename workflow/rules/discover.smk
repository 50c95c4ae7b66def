"""What the nominal model lacks, record by record: verdict, extended model and tables; then the pictures and a page.

The pictures lie beside the tables; they are no outputs here, because which of them there are depends on what the
record holds.
"""

DISCOVERY = "results/discover/{record}"
FOUND = [
    "verdict.json",
    "model.json",
    "given.json",
    *(f"{table}.csv" for table in ["where", "candidates", "gap", "limits", "traces"]),
]


rule discover:
    input:
        record=record_files,
    output:
        expand(f"{DISCOVERY}/{{name}}", name=FOUND, allow_missing=True),
    log:
        "results/logs/discover/{record}.log",
    benchmark:
        "results/benchmarks/discover/{record}.tsv"
    # The longest jobs, which most others wait for, are not to be the last.
    priority: 2
    conda:
        ENVIRONMENT
    params:
        sources=sources("discover", without=PAGES),
        folder=lambda wildcards: RECORDS[wildcards.record],
        out=lambda wildcards: f"results/discover/{wildcards.record}",
    message:
        "Discovering what the model of {wildcards.record} lacks"
    shell:
        "sonicvacuum discover {params.folder:q} --out {params.out:q} --no-figures --threads {threads:q} > {log:q} 2>&1"


rule record_page:
    input:
        expand(f"{DISCOVERY}/{{name}}", name=FOUND, allow_missing=True),
    output:
        table=f"{DISCOVERY}/parameters.csv",
        page=report(f"{DISCOVERY}/index.html", category="Discovery", labels={"record": "{record}"}),
    log:
        "results/logs/record_page/{record}.log",
    benchmark:
        "results/benchmarks/record_page/{record}.tsv"
    conda:
        ENVIRONMENT
    params:
        sources=sources("page"),
        out=lambda wildcards: f"results/discover/{wildcards.record}",
    message:
        "Writing the page of {wildcards.record}"
    shell:
        "sonicvacuum page {params.out:q} 2> {log:q}"
