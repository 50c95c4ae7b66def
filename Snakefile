"""The workflow, from the root of the project; all of it stands in workflow/Snakefile."""


include: "workflow/Snakefile"


# An include leaves it open what is made by default.
rule pipeline:
    default_target: True
    input:
        rules.all.input,
