"""`sonicvacuum paper …`: from simulated cards to figures, ledger and report of the reproduction."""

from sonicvacuum.cli import Verbs

paper = Verbs(
    name="paper",
    help="The reproduction of the paper: metrics, ledger, figures and report.",
    short_help="The reproduction of the paper, step by step.",
    verbs={
        "observe": "sonicvacuum_paper.cli.observe:observe",
        "metrics": "sonicvacuum_paper.cli.metrics:metrics",
        "uncertainty": "sonicvacuum_paper.cli.uncertainty:uncertainty",
        "rivals": "sonicvacuum_paper.cli.rivals:rivals",
        "ledger": "sonicvacuum_paper.cli.ledger:ledger",
        "audit": "sonicvacuum_paper.cli.ledger:audit",
        "draw": "sonicvacuum_paper.cli.draw:draw",
        "digitised": "sonicvacuum_paper.cli.draw:digitised",
        "report": "sonicvacuum_paper.cli.report:report",
        "runs": "sonicvacuum_paper.cli.runs:runs",
        "animate": "sonicvacuum_paper.cli.animate:animate",
        "publish": "sonicvacuum_paper.cli.publish:publish",
        "timings": "sonicvacuum_paper.cli.timings:timings",
    },
)
