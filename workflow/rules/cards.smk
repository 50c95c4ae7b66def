"""One resolved card for each variant of each case."""


rule card:
    input:
        sources=sources("card"),
    output:
        "results/cards/{card}.json",
    log:
        "results/logs/card/{card}.log",
    benchmark:
        "results/benchmarks/card/{card}.tsv"
    conda:
        ENVIRONMENT
    params:
        config=CONFIG_FILE,
        case=lambda wildcards: wildcards.card.split(".")[0],
        variant=lambda wildcards: wildcards.card.split(".")[1],
        # The card's own text, so that an edit of config.yaml reruns the cards that it changes and no other.
        resolved=resolved,
    message:
        "Resolving {wildcards.card}"
    shell:
        "sonicvacuum card --config {params.config} --case {params.case} --variant {params.variant}"
        " --out {output} 2> {log}"
