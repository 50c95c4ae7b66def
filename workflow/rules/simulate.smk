"""Each card integrated at the chosen step and at half of it, those of a batch by one process."""

for number, (batch, names) in enumerate(CARD_BATCHES.items()):

    rule:
        name:
            f"simulate_{number}"
        input:
            cards=expand("results/cards/{card}.json", card=names),
        output:
            expand("results/histories/{card}.npz", card=names),
        log:
            f"results/logs/simulate/{batch}.log",
        benchmark:
            f"results/benchmarks/simulate/{batch}.tsv"
        conda:
            ENVIRONMENT
        params:
            sources=sources("simulate", without=MODEL),
            out=place,
        message:
            f"Simulating {batch}"
        shell:
            "sonicvacuum simulate {input.cards:q} --out {params.out:q} 2> {log:q}"
