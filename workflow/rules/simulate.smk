"""Each card integrated at the chosen step and at half of it."""


rule simulate:
    input:
        card="results/cards/{card}.json",
    output:
        "results/histories/{card}.npz",
    log:
        "results/logs/simulate/{card}.log",
    benchmark:
        "results/benchmarks/simulate/{card}.tsv"
    conda:
        ENVIRONMENT
    params:
        sources=sources("simulate", without=MODEL),
    message:
        "Simulating {wildcards.card}"
    shell:
        "sonicvacuum simulate {input.card:q} --out {output:q} 2> {log:q}"
