"""Figures 3-6: first the numbers that are drawn, then the drawing made from them."""


rule draw:
    input:
        cards=lambda wildcards: expand("results/cards/{card}.json", card=drawn(wildcards.figure)),
        histories=lambda wildcards: expand("results/histories/{card}.npz", card=drawn(wildcards.figure)),
        points=sorted(map(str, Path(home("workflow/resources/digitised")).glob("*.yaml"))),
    output:
        table="figures/{figure}.csv",
        svg=report(
            "figures/{figure}.svg",
            category="Figures",
            caption="../report/figure.rst",
            labels={"figure": "{figure}"},
        ),
        png="figures/{figure}.png",
    log:
        "results/logs/draw/{figure}.log",
    benchmark:
        "results/benchmarks/draw/{figure}.tsv"
    conda:
        ENVIRONMENT
    params:
        sources=sources("paper draw"),
        points=lambda wildcards, input: repeated("--points", input.points),
        # Read by the caption file of Snakemake's own report.
        caption=lambda wildcards: Caption(wildcards.figure),
    message:
        "Drawing {wildcards.figure}"
    shell:
        "sonicvacuum paper draw {wildcards.figure:q} --cards results/cards --histories results/histories"
        " {params.points:q} --out figures 2> {log:q}"
