"""The engine against other codes: `make bench`, which first installs them; not part of the default target."""


rule bench:
    input:
        bench=Path(home("workflow/bench")).glob("*.[pc]*"),
    output:
        "results/bench.csv",
        "results/bench.md",
        expand(
            "results/bench_{table}.csv",
            table=["accuracy", "length", "lanes", "effects", "scaling", "inference"],
        ),
        expand("results/bench_{figure}.{kind}", figure=["accuracy", "cost"], kind=["svg", "png"]),
    log:
        "results/logs/bench.log",
    conda:
        ENVIRONMENT
    params:
        sources=sources("simulate", "discover", "blind hide", without=PAGES),
    message:
        "Measuring all codes in turns; this takes some minutes and wants an idle machine"
    shell:
        "(python workflow/bench/measure.py --out results && python workflow/bench/draw.py results) 2>&1 | tee {log:q}"


# Records of the small study and of a part of the training study: some hundred.
rule nested:
    input:
        records=[
            *expand("results/blind/small/records/{batch}", batch=range(BATCHES["small"])),
            "results/blind/training/records/0",
        ],
        program=home("workflow/bench/nested.py"),
    output:
        "results/nested.csv",
    log:
        "results/logs/nested.log",
    conda:
        ENVIRONMENT
    params:
        sources=sources("discover", without=PAGES),
    message:
        "Evidence by nested sampling beside that of the search; this takes an hour"
    shell:
        'for folder in {input.records:q}; do set -- "$@" "$folder"/*; done;'
        ' python {input.program:q} "$@" --out {output:q} 2>&1 | tee {log:q}'
