"""One resolved card for each variant of each case, with the model that discover made where it asks for one."""


rule card:
    input:
        model=model_of,
    output:
        "results/cards/{card}.json",
    log:
        "results/logs/card/{card}.log",
    benchmark:
        "results/benchmarks/card/{card}.tsv"
    conda:
        ENVIRONMENT
    params:
        sources=lambda wildcards: sources("card", without=() if model_of(wildcards) else MODEL),
        config=CONFIG_FILE,
        case=lambda wildcards: wildcards.card.split(".")[0],
        variant=lambda wildcards: wildcards.card.split(".")[1],
        model=lambda wildcards, input: repeated("--model", input.model),
        # The card's own text, so that an edit of config.yaml reruns the cards that it changes and no other.
        resolved=resolved,
    message:
        "Resolving {wildcards.card}"
    shell:
        "sonicvacuum card --config {params.config:q} --case {params.case:q} --variant {params.variant:q}"
        " {params.model:q} --out {output:q} 2> {log:q}"
