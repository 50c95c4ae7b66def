"""`sonicvacuum export`: the law of one ball on a wall in the parameters of other simulators."""

from pathlib import Path

import click

from sonicvacuum.cli import existing
from sonicvacuum.cli.helped import WRITTEN, verb
from sonicvacuum.cli.own_effects import catalogue, own_effects
from sonicvacuum.schema_errors import likely

NAMES = ("lammps", "liggghts", "yade", "mujoco", "drake", "all")


@verb(
    "sonicvacuum export found/model.json --record my-record",
    "sonicvacuum export --law tsuji --alpha 0.1 --mass_g 4 --diameter_mm 10 --material brass --speeds 0.1 1",
    context_settings={"ignore_unknown_options": True},
    short_help="Write the contact law of one ball for other simulators.",
)
@click.argument("words", nargs=-1, type=click.UNPROCESSED, metavar="[MODEL]")
@click.option("--record", type=click.Path(), help="Record of one ball (beads: 0) that the model is of.")
@click.option("--law", help="Instead of MODEL: id of an effect; its parameters follow as --NAME VALUE.")
@click.option("--mass_g", type=click.FloatRange(min=0.0, min_open=True), help="Of the ball, if no --record.")
@click.option("--diameter_mm", type=click.FloatRange(min=0.0, min_open=True), help="Of the ball.")
@click.option("--material", help="Of the ball; see sonicvacuum materials.")
@click.option("--wall", help="Material of the wall; by default the ball's.")
@click.option(
    "--speeds",
    nargs=2,
    type=click.FloatRange(min=0.0, min_open=True),
    metavar="LOW HIGH",
    help="Impact speeds in m/s that matter; by default those of the record.",
)
@click.option("--to", type=click.Choice(NAMES), default="all", show_default=True, help="Simulator.")
@click.option(
    "--error",
    type=click.FloatRange(min=0.0, min_open=True),
    default=0.01,
    show_default=True,
    help="Of restitution, within which a nearest law counts as agreeing.",
)
@click.option("--out", type=WRITTEN, help="File to write; default: standard output.")
@click.option("--json", "as_json", is_flag=True, help="For programs.")
@own_effects
def export(words, record, law, to, error, out, as_json, own, speeds, **ball):
    """Write the contact law of one ball for LAMMPS, LIGGGHTS, YADE, MuJoCo and Drake.

    MODEL is the model.json of discover; or --law kuwabara-kono --time_us 2, say.

    Coefficients get their errors, and limits are told, from the verdict.json beside the model.
    """
    import msgspec

    from sonicvacuum.blas import one_thread
    from sonicvacuum.export import session
    from sonicvacuum.export.result import text
    from sonicvacuum.files import replacing
    from sonicvacuum.outputs import check_apart

    model = _path(words)
    check_apart([out], [model, _beside(model), record, *own])
    known = catalogue(own)
    asked = _asked(model, record, law, speeds, ball, _given(words[1:] if model else words), known)
    names = tuple(session.SIMULATORS) if to == "all" else (to,)
    found = one_thread(session.export)(asked, names, error, known)
    shown = (
        msgspec.json.format(msgspec.json.encode(found), indent=1).decode() + "\n" if as_json else text(found)
    )
    if out is None:
        click.echo(shown, nl=False)
        return
    with replacing(out) as stream:
        stream.write(shown)


def _asked(model, record, law, speeds, ball, parameters, known):
    """What is exported, from the options."""
    from dataclasses import replace

    from sonicvacuum.discover.compare import read_model
    from sonicvacuum.discover.verdict import Verdict
    from sonicvacuum.export import session
    from sonicvacuum.files import read_json
    from sonicvacuum.records import read

    if (model is None) == (law is None):
        raise click.UsageError("give either MODEL or --law, not both" if law else "give MODEL, or --law")
    if parameters and not law:
        raise click.UsageError(f"no such option: --{next(iter(parameters))}")
    effects = _law(law, parameters, known) if law else {}
    if record:
        found = read_model(model, known) if model else None
        beside = _beside(model)
        verdict = read_json(beside, Verdict) if beside and beside.exists() else None
        asked = session.of_record(read(record), found, effects, verdict)
        return replace(asked, speeds=speeds) if speeds else asked
    if model:
        raise click.UsageError("a MODEL needs --record: it says which ball and which speeds")
    missing = [f"--{k}" for k in ("mass_g", "diameter_mm", "material") if ball[k] is None]
    missing += [] if speeds else ["--speeds"]
    if missing:
        raise click.UsageError(f"give --record, or the ball: {', '.join(missing)} missing")
    return session.by_hand(
        **(ball | {"wall": ball["wall"] or ball["material"]}), speeds=speeds, effects=effects
    )


def _beside(model):
    """The verdict that is read beside a model, if it is there."""
    return Path(model).parent / "verdict.json" if model else None


def _path(words):
    """The MODEL among the words left over: the first, if it is no option; None without one."""
    if not words or words[0].startswith("--"):
        return None
    return existing().convert(words[0], None, click.get_current_context())


def _law(name, parameters, known):
    """Effect → parameters; those left out are the effect's typical values only where they shape it."""
    if name == "none":
        return {}
    if name not in known:
        cure = likely(name, ("none", *known.ids)) or f"one of none, {', '.join(known.ids)}"
        raise click.UsageError(f"--law {name}: no such effect; {cure}")
    one = known.effect(name)
    own = [p.name for p in one.parameters]
    for key, value in parameters.items():
        if key not in (*own, one.sits):
            raise click.UsageError(f"no such option: --{key}; {name} has {', '.join(f'--{p}' for p in own)}")
        told = one.parameter(key).refused(value) if key in own else None
        if told:  # before what else is missing is asked for
            raise click.UsageError(f"--{key}: {told}")
    needed = [p.name for p in one.parameters if p.switches and p.name not in parameters]
    if needed:
        raise click.UsageError(f"--law {name} needs --{needed[0]}")
    return {name: parameters}


def _given(words):
    """The options that only a law knows, --NAME VALUE each."""
    found, left = {}, list(words)
    while left:
        word = left.pop(0)
        name, equals, value = word.removeprefix("--").partition("=")
        value = value if equals else (left.pop(0) if left else "")
        try:
            if not word.startswith("--"):
                raise ValueError
            found[name] = float(value)
        except ValueError:
            raise click.UsageError(
                f"unexpected: {word} {value}; parameters of a law are --NAME NUMBER"
            ) from None
    return found
