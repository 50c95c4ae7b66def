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
    params:
        case=lambda wildcards: wildcards.card.split(".")[0],
        variant=lambda wildcards: wildcards.card.split(".")[1],
        # The card's own text, so that an edit of config.yaml reruns the cards that it changes and no other.
        resolved=resolved,
    message:
        "Resolving {wildcards.card}"
    shell:
        "sonicvacuum card --config {CONFIG_FILE} --case {params.case} --variant {params.variant}"
        " --out {output} 2> {log}"
