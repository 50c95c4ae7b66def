"""`sonicvacuum blind …`: hide effects, score what `discover` makes of the records, try simpler rules."""

from sonicvacuum.cli import Verbs

blind = Verbs(
    name="blind",
    help="The blind test of discover: data with hidden effects, their score, and simpler rules beside it.",
    short_help="The blind test of discover, on data with hidden effects.",
    verbs={
        "hide": "sonicvacuum_blind.cli.hide:hide",
        "ideal": "sonicvacuum_blind.cli.ideal:ideal",
        "score": "sonicvacuum_blind.cli.score:score",
        "tables": "sonicvacuum_blind.cli.score:tables",
        "slips": "sonicvacuum_blind.cli.slips:slips",
        "slips-score": "sonicvacuum_blind.cli.slips:slips_score",
        "extras": "sonicvacuum_blind.cli.extras:extras",
        "extras-score": "sonicvacuum_blind.cli.extras:extras_score",
        "follow": "sonicvacuum_blind.cli.follow:follow",
        "foretold": "sonicvacuum_blind.cli.foretold:foretold",
        "resolved": "sonicvacuum_blind.cli.resolved:resolved",
        "calibrate": "sonicvacuum_blind.cli.calibrate:calibrate",
        "baselines": "sonicvacuum_blind.cli.baselines:baselines",
        "draw": "sonicvacuum_blind.cli.draw:draw",
        "page": "sonicvacuum_blind.cli.page:page",
        "publish": "sonicvacuum_blind.cli.publish:publish",
    },
)
