"""One resolved card for each variant of each case, with the model that discover made where it asks for one.

A process makes all cards of a batch, so that there is a rule for each batch.
"""

for number, (batch, names) in enumerate(CARD_BATCHES.items()):

    rule:
        name:
            f"card_{number}"
        input:
            model=model_of(names[0]),
        output:
            expand("results/cards/{card}.json", card=names),
        log:
            f"results/logs/card/{batch}.log",
        benchmark:
            f"results/benchmarks/card/{batch}.tsv"
        conda:
            ENVIRONMENT
        params:
            sources=sources("card", without=() if model_of(names[0]) else MODEL),
            config=CONFIG_FILE,
            cases=repeated("--case", names),
            model=lambda wildcards, input: repeated("--model", input.model),
            out=place,
            # The cards' own text, so that an edit of config.yaml reruns the batches that it changes and no other.
            resolved=resolved(names),
        message:
            f"Resolving {batch}"
        shell:
            "sonicvacuum card --config {params.config:q} {params.cases:q} {params.model:q} --out {params.out:q} 2> {log:q}"
