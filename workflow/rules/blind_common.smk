"""What the rules of the blind study share: its parts and batches."""

# Study → number of batches, and how many of them are made. For a part of the full study, that is to see it run:
# `--config full_batches=1017 full_taken=2` makes four of its records in two jobs.
BATCHES = {
    "small": 4,
    "training": 4,
    "laws": 4,
    "nulls": 32,
    "beside": 6,
    "beside-training": 6,
    "again": 48,
    "full": int(config.get("full_batches", 100)),
}
TAKEN = BATCHES | {"again": 7, "full": int(config.get("full_taken", BATCHES["full"]))}
# Study → of how many batches ambiguous records get one more run, which takes two joint verdicts for every such record.
# Effects take turns among the cases, so that a batch holds every second one: an even number of batches holds all alike.
FOLLOWED = dict.fromkeys(BATCHES, 4) | {"nulls": 1, "again": 6, "full": 32}
BLIND = "results/blind/{study}"
# Asked only for the priors that a record may state, which hidden data never do: they stay when an effect changes.
CATALOGUE = ("sonicvacuum.effects",)
PICTURES = ["confusion", "accuracy", "reliability", "pit", "baselines"]
DETAILS = ["confusion", "accuracy", "reliability", "seconds", "parameters", "coverage", "pit"]
CHOICES = ["proposed", "random", "fresh"]


def batches(part):
    """Input function: the folders of all batches of a part (records, truth, verdicts, …) of a study."""
    return lambda wildcards: expand(
        f"{BLIND}/{part}/{{batch}}", study=wildcards.study, batch=range(TAKEN[wildcards.study])
    )


def some_batches(part):
    """The same of the batches of which ambiguous records are followed by one more run."""
    return lambda wildcards: expand(
        f"{BLIND}/{part}/{{batch}}",
        study=wildcards.study,
        batch=range(min(FOLLOWED[wildcards.study], TAKEN[wildcards.study])),
    )


def ideal(wildcards):
    """Tables of the ideal rule; the other studies are too small to be judged by it.

    `--config ideal_taken=16` asks it of the first batches only: it takes longer than the verdicts.
    """
    count = int(config.get("ideal_taken", TAKEN["full"])) if wildcards.study == "full" else 0
    return expand(f"{BLIND}/ideal/{{batch}}.csv", study=wildcards.study, batch=range(count))


def training(wildcards):
    """What the rules that learn need of the training family; the small study does without."""
    if wildcards.study != "full":
        return []
    parts = ["records", "truth", "verdicts"]
    return expand(
        f"{BLIND}/{{part}}/{{batch}}", study="training", part=parts, batch=range(BATCHES["training"])
    )
