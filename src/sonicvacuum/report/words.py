"""The sentences of a record's page: what was found, in words that can be read aloud.

Every sentence is made from `verdict.json`, `model.json` and the tables beside them, and from nothing else.
"""

from collections.abc import Collection, Mapping

from sonicvacuum.discover.draws import AVERAGED, LINEAR, PLACES, SAMPLED, VALLEY, pareto_k
from sonicvacuum.discover.judge.explanations import key
from sonicvacuum.discover.verdict import Verdict
from sonicvacuum.effects import CATALOGUE, Catalogue
from sonicvacuum.report.phrases import chance, in_words, joined, share

# Explanations less probable than this are told only where few are, and than the second are no rivals.
LEAST_TOLD, LEAST_RIVAL = 0.005, 0.01
# With more than this share of what it and its rivals have one effect is told first, and these are left open.
CLEARLY = 0.95


def drawn(draws) -> str:
    """How the intervals were found, "" without draws; `draws` as in `discover.draws.read`."""
    draws = {name: d for name, d in draws.items() if d.how != PLACES}
    if any(d.how == AVERAGED for d in draws.values()):
        rest = {name: d for name, d in draws.items() if d.how != AVERAGED}
        said = (
            "Explanations that have a parameter in common put it at different values: where that matters, "
            "the interval is of all of them, each by its probability, and may not hold the value told, which "
            "is that of the named one alone."
        )
        return f"{said} {drawn(rest)}".strip()
    one = next(iter(draws.values()), None)
    if one is None:
        return ""
    if one.how == VALLEY:
        return (
            "Two parameters nearly replace one another, and too few draws carried the weight: the intervals "
            "are of the valley that they leave, followed from end to end with all else at its best."
        )
    if one.how != SAMPLED:
        missed = any(d.how == LINEAR for d in draws.values())
        return (
            "The intervals are of profiles: too few draws carried the weight. Each parameter was held at a "
            "row of values, with all else at its best."
        ) + (
            " Where that did not hold the fit itself, the interval is that of its Gaussian." if missed else ""
        )
    return (
        f"{len(one.weight)} weighted draws are worth {one.effective:.0f} independent ones; their Pareto k is "
        f"{pareto_k(one.weight):.2g} (reliable below 0.7).".replace(" -", " −")
    )


def plain(explanation: str, catalogue: Catalogue = CATALOGUE) -> str:
    """An explanation as people say it: `tsuji + unknown` is `damping with constant restitution and something
    unknown`.
    """
    said = {"none": "nothing missing", "unknown": "something unknown"}
    names = [n.strip() for n in explanation.split("+")]
    return joined([said.get(n) or _title(n, catalogue) for n in names])


def placed(explanation: str, places: Mapping[str, int | str], catalogue: Catalogue = CATALOGUE) -> str:
    """The same with the bead, contact, gauge or material of each effect that has one in `places`."""
    said = []
    for name in explanation.split("+"):
        where = catalogue.effect(name).sits if name in places else None
        said.append(plain(name, catalogue) + (_at(where, places[name]) if where else ""))
    return joined(said)


def _at(where, place):
    """Where an effect sits, in words."""
    if where == "material":
        return f" of {place}"
    return f" at {'gauge' if where == 'sensor' else where} {place}"


def _title(name, catalogue):
    title = catalogue.effect(name).title if name in catalogue else name
    return f"{title[0].lower()}{title[1:]}"


def effects_of(verdict: Verdict) -> list[str]:
    """What was named, without `unknown`."""
    return [name for name in verdict.named if name != "unknown"]


def headline(verdict: Verdict, catalogue: Catalogue = CATALOGUE) -> str:
    """What is missing, and how sure that is; the catalogue knows what is named."""
    found, odds = effects_of(verdict), verdict.probabilities
    unknown = "unknown" in verdict.named
    if not found and not unknown:
        return _nothing(verdict, catalogue)
    if not found:
        return (
            "Something is missing, and it is unknown: a real misfit is left that no effect of the catalogue, "
            f"nor any set of them that was tried, explains. That it is none of them is "
            f"{in_words(odds.get('unknown', 0.0))}."
        )
    told = [_told(catalogue.effect(name), verdict) for name in found]
    if len(found) == 1 and verdict.confusable:
        text = _one_of(verdict, told[0], catalogue)
    elif len(found) == 1:
        text = f"What is missing: {told[0]}. That is {in_words(verdict.probability or 0.0)}."
    elif unknown and verdict.probability is not None and verdict.probability < max(odds.values()):
        return _nearest_set(verdict, told, found)
    else:
        text = f"{_counted(found)} effects are missing: {'; '.join(told)}."
        sure = verdict.probability
        text += (
            f" No single effect does: {_singles(odds, catalogue)}."
            if sure is None
            else f" That is {in_words(sure)}.{_exchanged(verdict, catalogue)}"
        )
    return text + (" Even so, a misfit is left that nothing of the catalogue explains." if unknown else "")


def _told(one, verdict):
    """An effect with what is missing; of one bead, contact, gauge or material with which one."""
    places = verdict.parameters.get(one.id, {})
    found = [value for key, value in places.items() if key == one.sits]
    named = [v.name or f"{v.value:g}" for v in found if v.name or one.sits in ("bead", "contact")]
    return f"{one.title}{''.join(_at(one.sits, name) for name in named)} ({one.id}): {one.missing}"


def _exchanged(verdict, catalogue):
    """What may stand in place of one effect of a set, and how probable it is that one of these sets is there;
    "" where nothing may.
    """
    odds, total, parts = verdict.probabilities, verdict.probability, []
    for own, *others in verdict.confusable:
        if own not in verdict.named:
            continue
        each = [odds.get(key([other if n == own else n for n in verdict.named]), 0.0) for other in others]
        told = [
            plain(n, catalogue) + (f" ({share(p)} in its place)" if p >= LEAST_TOLD else "")
            for n, p in zip(others, each, strict=True)
        ]
        parts.append(f"{plain(own, catalogue)} from {joined(told, 'or')}")
        total += sum(each)
    if not parts:
        return ""
    text = f" These data cannot tell {joined(parts, 'nor')}"
    if total - verdict.probability < LEAST_TOLD:
        return f"{text}."
    return f"{text}: one or the other is {in_words(min(1.0, total))}."


def _nearest_set(verdict, told, found):
    """A set beside something unknown that is not the likeliest explanation."""
    odds = verdict.probabilities
    one = sum(odds.get(key([name, "unknown"]), 0.0) for name in found)
    return (
        "Something is missing that nothing of the catalogue explains. "
        f"{_counted(told)} of its effects come nearest to it together: {'; '.join(told)}. "
        f"That these are there, and something unknown beside them, has the probability "
        f"{share(verdict.probability)}; that one of them is {share(one)}; "
        f"that it is something unknown alone {share(odds.get('unknown', 0.0))}."
    )


def _counted(several):
    return _COUNTS.get(len(several), str(len(several)))


_COUNTS = {2: "Two", 3: "Three", 4: "Four", 5: "Five", 6: "Six"}


def _one_of(verdict, told, catalogue):
    """A single effect with others that these data cannot tell from it."""
    members, each = verdict.confusable[0], _each(verdict, verdict.confusable[0])
    if _clearly(each):
        return f"What is missing: {told}. That is {in_words(each[0])}; {_open(verdict, catalogue)}"
    return (
        f"What is missing is one of {_names(members, catalogue)}, which these data cannot tell apart: "
        f"together {in_words(min(1.0, sum(each)))}. Most probable among them, {share(each[0])}: {told}."
    )


def _each(verdict, members):
    """Probability of a single effect that is named, first, and of those that may stand in its place."""
    beside = ["unknown"] if "unknown" in verdict.named else []
    return [verdict.probabilities.get(key([name, *beside]), 0.0) for name in members]


def _clearly(each):
    """Whether the first of some effects, each with its probability, is far more probable than the others."""
    return each[0] > CLEARLY * sum(each)


def _open(verdict, catalogue):
    """What data do not decide against in place of a single effect, far less probable though it is."""
    others = verdict.confusable[0][1:]
    return f"{_names(others, catalogue)} in its place {'is' if len(others) == 1 else 'are'} not ruled out."


def _nothing(verdict, catalogue):
    odds = verdict.probabilities
    best = max(odds, key=odds.get)
    text = "Nothing is named: the nominal model explains these data as far as they go."
    if best == "none":
        if verdict.sees_nothing:
            return f"{text} That says little: no effect of the catalogue would show in them."
        what = "That nothing is missing"
        if verdict.not_testable:
            what = "That none of the effects that these data could show is missing"
        if odds["none"] >= 0.5:
            return f"{text} {what} is {in_words(odds['none'])}."
        chance = f"has the probability {share(odds['none'])}"
        return f"{text} {what} {chance}, more than any single rival, less than all together."
    against = f"{share(odds[best])} against {share(odds.get('none', 0.0))} for none"
    likeliest = plain(best, catalogue)
    return f"Nothing is named: the likeliest explanation, {likeliest} ({against}), did not pass all tests."


def _singles(odds, catalogue):
    best = max(odds, key=odds.get)
    if best == "unknown":
        return f"that something else is needed is {in_words(odds[best])}"
    return f"the likeliest is {plain(best, catalogue)}, {share(odds[best])}"


def _names(ids, catalogue, last="or"):
    return joined([plain(name, catalogue) for name in ids], last)


def law(verdict: Verdict, catalogue: Catalogue = CATALOGUE) -> str:
    """The free-form contact law, where one was needed; else empty."""
    found = verdict.law
    if not found:
        return ""
    near = [f"{plain(n.effect, catalogue)} ({n.distance:.2f})" for n in found.nearest[:3]]
    far = f"{found.depth_um[-1]:.3g} µm and {found.speed_m_s[-1]:.3g} m/s"
    text = (
        f"What is left is described by a contact law without a name: {found.formula}. Contacts of beads "
        f"went as far as {far}; beyond what all contacts went through, what it adds to Hertz stays as it is."
    )
    if near:
        scale = "with their distance from it (0: the same, 1: no nearer than Hertz)"
        text += f" The nearest named laws, {scale}: {joined(near)}."
    if found.closed is not None:
        part = f"{100.0 * min(found.closed, 1.0):.0f} %" if found.closed > 0.0 else "nothing"
        text += f" On runs left out of its fit it closes {part} of what was left."
    return text


def alternatives(verdict: Verdict, catalogue: Catalogue = CATALOGUE) -> str:
    """What else it could be."""
    found = effects_of(verdict)
    alike = [(members[0], members[1:]) for members in verdict.confusable]
    parts = [
        f"These data cannot tell {plain(own, catalogue)} from {_names(others, catalogue)}."
        for own, others in alike
    ]
    if len(found) == 1 and alike and _clearly(_each(verdict, verdict.confusable[0])):
        parts = [f"By far the likeliest is {plain(found[0], catalogue)}; {_open(verdict, catalogue)}"]
    if found:
        beside, named = _beside(verdict, catalogue), _names(found, catalogue, "and")
        none = f"No {'other effect' if beside else 'rival'} comes near"
        parts = parts or [f"{none}: {named} can be told from every other effect that was fitted."]
        parts += beside
    elif verdict.sees_nothing:
        parts = ["Every effect of the catalogue may be there: these data test none."]
    else:
        parts = _nearest(verdict, catalogue)
    return " ".join(parts)


def _beside(verdict, catalogue):
    """What may hide beside what was named, and that something unknown, or nothing, may stand in its place."""
    own, parts = set(verdict.named), []
    odds = sorted(verdict.probabilities.items(), key=lambda item: -item[1])
    more = [
        f"{plain(' + '.join(sorted(names - own)), catalogue)} ({share(p)})"
        for names, p in ((set(name.split(" + ")), p) for name, p in odds)
        if own < names and "unknown" not in names - own and p >= LEAST_RIVAL
    ]
    if more:
        parts.append(f"Beside that there may be {joined(more[:3], 'or')}.")
    alone = verdict.probabilities.get("unknown", 0.0)
    if alone >= LEAST_RIVAL:
        parts.append(f"That it is something unknown instead has the probability {share(alone)}.")
    nothing = verdict.probabilities.get("none", 0.0)
    if nothing >= LEAST_RIVAL:
        slip = ", but a slip told above was made," if verdict.faults else ""
        parts.append(f"That nothing is missing{slip} has the probability {share(nothing)}.")
    return parts


def _nearest(verdict, catalogue):
    """What comes nearest where nothing was named, or something unknown alone."""
    odds = sorted(verdict.probabilities.items(), key=lambda item: -item[1])
    rivals = [(n, p) for n, p in odds if n not in ("none", "unknown") and p >= LEAST_RIVAL]
    if not verdict.named:  # what stands beside something unknown is no rival of nothing
        rivals = [(n, p) for n, p in rivals if "unknown" not in n]
    told = [(n, f"{plain(n, catalogue)} ({share(p)})") for n, p in rivals]
    single = [text for name, text in told if " + " not in name][:3]
    sets = [text for name, text in told if " + " in name][:2]
    some = f"The nearest single effect{'s' * (len(single) > 1)}: "
    parts = [f"{some}{joined(single)}." if single else "No single effect comes near."]
    return parts + ([f"The nearest set{'s' * (len(sets) > 1)}: {'; '.join(sets)}."] if sets else [])


# What a step leaves with a p-value from this on is no more than noise.
NOISE = 0.05


def decided(verdict: Verdict) -> list[str]:
    """What decided, and whether what each step leaves is noise."""
    # The first one decided; others say what else explains the data, or what was taken for granted.
    lines = [f"{'Besides' if k else 'Decisive'}: {reason}." for k, reason in enumerate(verdict.reasons)]
    return lines + [_leaves(_STEPS.get(step, step), p) for step, p in verdict.alarms.items()]


_STEPS = {
    "none": "the nominal model",
    "single": "the best single effect",
    "pair": "the best pair",
    "set": "the last set of effects",
}


def _leaves(model, p):
    if p < NOISE:
        return f"By chance alone, what {model} leaves would come about with probability {chance(p)}."
    # Of many shapes the least probable is asked for, so that chance often does as much for certain.
    beside = f": chance does as much with probability {chance(p)}" if p <= 0.995 else ""
    return f"{model[0].upper()}{model[1:]} leaves no more than noise would{beside}."


def unfitted(verdict: Verdict, fitted: Collection[str], catalogue: Catalogue = CATALOGUE) -> str:
    """Which of the sets that are told of were not fitted, and where their probability comes from, see
    `judge.behind`; "" where none are. `fitted` are explanations.
    """
    odds = sorted(verdict.probabilities.items(), key=lambda item: -item[1])
    if "unknown" in verdict.named:  # what hides beside something unknown is not asked
        return ""
    sets = [(name, p) for name, p in odds if " + " in name and "unknown" not in name and name not in fitted]
    told = [f"{plain(name, catalogue)} ({share(p)})" for name, p in sets if p >= LEAST_TOLD]
    if not told:
        return ""
    several = any(" + " in name for name in fitted)
    return (
        f"{'Other sets were not' if several else 'No pair of effects was'} fitted, as what is named leaves "
        "nothing significant: how probable it is that one more effect hides beside it was estimated from "
        f"slopes at its fit. So {'; '.join(told)}."
    )
