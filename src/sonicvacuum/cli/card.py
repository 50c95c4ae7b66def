"""`sonicvacuum card`, `materials`, `effects`, `schema`: what will be simulated, and with which numbers."""

import json

import click

from sonicvacuum.cli import existing
from sonicvacuum.cli.helped import PLACE, WRITTEN, places_of, verb
from sonicvacuum.cli.own_effects import catalogue, own_effects
from sonicvacuum.files import InputError, replacing
from sonicvacuum.outputs import check_apart


@verb(
    "sonicvacuum card --case fig3a --variant matched --out card.json",
    "sonicvacuum card --case fig3a.nominal --case fig3a.matched --out cards",
    short_help="Resolve a case of config.yaml into a card (JSON, SI units).",
)
@click.option("--config", "path", default="config.yaml", show_default=True, type=existing())
@click.option(
    "--case",
    "cases",
    multiple=True,
    help="A case, or CASE.VARIANT, once or more; without it, all are listed.",
)
@click.option("--variant", default="nominal", show_default=True, help="Of cases that are given without one.")
@click.option("--model", type=existing(), help="model.json of discover, where the cases ask for one.")
@click.option("--out", type=PLACE, help="File to write, of several the folder; default: standard output.")
@own_effects
def card(path, cases, variant, model, out, own):
    """Resolve cases of the configuration into cards (JSON, SI units).

    One is written to OUT, several to OUT/CASE.VARIANT.json. All are resolved before the first is written.
    """
    from sonicvacuum import config as configuration

    config = configuration.read(path)
    if not cases:
        click.echo("\n".join(configuration.card_names(config)))
        return
    names = [case if "." in case else f"{case}.{variant}" for case in cases]
    if len(names) > 1 and out is None:
        raise InputError("several cases: give --out with the folder to write their cards to")
    places = places_of(out, names, ".json") if out else []
    check_apart(places, [path, model, *own])
    texts = [_text(config, path, name, model, own) for name in names]
    if not places:
        click.echo(texts[0], nl=False)
    for place, text in zip(places, texts, strict=bool(places)):
        with replacing(place, "wb") as stream:
            stream.write(text)


def _text(config, path, name, model, own) -> bytes:
    """The card of a case and variant, as it is written."""
    from sonicvacuum import config as configuration
    from sonicvacuum.card import dump

    case, _, variant = name.partition(".")
    resolved = configuration.card(config, case, variant, path)
    wanted = configuration.model(config, case, variant, path)
    if (wanted is None) != (model is None):
        raise InputError(f"{path}: cases.{case}: variant {variant}: {_cure(wanted)}")
    if wanted:
        from sonicvacuum.cli.model import with_model

        resolved = with_model(resolved, model, catalogue(own), wanted)
    if resolved.effects:
        from sonicvacuum.simulation import set_up

        try:
            set_up(resolved, catalogue=catalogue(own))  # an effect that does not exist is best known now
        except InputError as error:
            raise InputError(f"{path}{f' with {model}' if model else ''}: {error}") from None
    return dump(resolved)


def _cure(wanted):
    if wanted is None:
        return "takes no model; leave --model out, or give the variant the key model"
    return f"takes the model of {wanted.record}; give --model with the model.json that discover wrote for it"


@verb("sonicvacuum materials")
def materials():
    """Print the built-in table of materials with its sources."""
    from sonicvacuum.materials import MATERIALS

    click.echo(f"{'name':18} {'E/GPa':>7} {'error':>6} {'nu':>6} {'kg/m3':>7} {'yield/MPa':>9}  source")
    for name, m in MATERIALS.items():
        strength = "" if m.yield_strength is None else f"{m.yield_strength / 1e6:g}"
        elastic = f"{m.modulus / 1e9:7g} {m.modulus_rel_sigma:6g} {m.poisson:6g}"
        click.echo(f"{name:18} {elastic} {m.density:7g} {strength:>9}  {m.source}")


@verb(
    "sonicvacuum effects",
    "sonicvacuum effects kuwabara-kono",
    "sonicvacuum effects --effects my_law.py",
    short_help="List the catalogue of effects, or tell all about one.",
)
@click.argument("name", required=False)
@own_effects
def effects(name, own):
    """List the catalogue of effects, or tell all about the one with id NAME; check effects of your own."""
    known = catalogue(own)
    if name is None:
        for e in known:
            taken = ", ".join([*(p.name for p in e.parameters), *([e.sits] if e.sits else [])])
            click.echo(f"{e.id:18} {e.missing} ({taken})")
        return
    if name not in known:
        raise InputError(f"effect {name!r} is not in the catalogue; {known.meant(name)}")
    e = known.effect(name)
    for title in (
        "title",
        "missing",
        "equation",
        "energy",
        "reference",
        "signature",
        "when_to_use",
        "when_not",
    ):
        click.echo(f"{title.replace('_', ' '):12} {getattr(e, title)}")
    for p in e.parameters:
        off = "shapes only" if p.off is None else "as recorded" if callable(p.off) else f"off at {p.off:g}"
        click.echo(f"{p.name:12} {p.help}; {p.unit}, {off}, searched from {p.low:g} to {p.high:g}")
    if e.sits:
        click.echo(f"{e.sits:12} where it sits" + ("" if e.places else ", where the beads are of several"))


@verb("sonicvacuum schema --out config.schema.json", short_help="JSON schema of config.yaml, for editors.")
@click.option("--out", type=WRITTEN, help="File to write; default: standard output.")
def schema(out):
    """JSON schema of the configuration, for editors that complete and check while typing."""
    from sonicvacuum import config as configuration

    text = json.dumps(configuration.schema(), indent=1, sort_keys=True) + "\n"
    if out is None:
        click.echo(text, nl=False)
        return
    with replacing(out) as stream:
        stream.write(text)
