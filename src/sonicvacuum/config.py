"""`config.yaml`: the cases to simulate and what to make of them, checked before any job runs."""

import re
from pathlib import PurePosixPath
from typing import Annotated, Any

import msgspec
from msgspec import Meta, Struct

from sonicvacuum.card import Card, CaseBlock, ModelBlock, Name, merged, resolve, variant_names
from sonicvacuum.files import InputError, check_values, convert, read_yaml
from sonicvacuum.laboratory.ranges import LaboratoryError
from sonicvacuum.schema_errors import explain


class Config(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The top level of `config.yaml`.

    Attributes:
        cases: name → block, see `sonicvacuum.card.CaseBlock`.
        ledger: column of the ledger → the variants that stand for it, the first that a case has being taken;
            optional, for cases that no statement of the paper is about.
        discover: folders of the records in which `discover` looks for what is missing.
    """

    cases: Annotated[dict[Name, dict[str, Any]], Meta(min_length=1)]
    ledger: dict[Name, list[Name]] = {}
    discover: list[str] = []

    @property
    def records(self) -> dict[str, str]:
        """Name of a record, that of its folder → the folder."""
        return {PurePosixPath(folder).name: folder for folder in self.discover}


def read(path) -> Config:
    """The configuration in a file, every case resolved once.

    Raises:
        InputError: naming the file, the key, the value and the cure.
    """
    content = read_yaml(path)
    check_values(content, path)
    config = convert(content, Config, path)
    for place, folder in enumerate(config.discover):
        _check_folder(folder, f"{path}: discover[{place}]")
        if config.records[PurePosixPath(folder).name] != folder:
            raise InputError(
                f"{path}: discover[{place}]: is {folder!r}; another record has that folder name: rename one"
            )
    _check_spelling(f"{path}: cases", config.cases)
    for case, block in config.cases.items():
        _check_variants(block, f"{path}: cases.{case}")
        for variant in variant_names(block):
            card(config, case, variant, path)
            _check_model(config, case, variant, path)
        _check_spelling(f"{path}: cases.{case}.variants", variant_names(block))
    return config


def _check_spelling(key, names):
    """Names become files, and some file systems take capitals for small letters."""
    seen: dict[str, str] = {}
    for name in names:
        if (other := seen.setdefault(name.lower(), name)) != name:
            raise InputError(f"{key}: {name!r} and {other!r} would be one file on some systems; rename one")


def _check_folder(folder, key):
    """Names that the workflow takes for something else; all others are only ever passed on quoted."""
    if PurePosixPath(folder).name in ("", ".."):
        raise InputError(f"{key}: is {folder!r}; write the path such that it ends with the folder's name")
    if folder.startswith("-"):
        raise InputError(f"{key}: is {folder!r}, which looks like an option; write ./{folder}")
    if re.search(r"[{}\x00-\x1f\x7f]", folder) or folder != folder.strip():
        raise InputError(
            f"{key}: is {folder!r}; Snakemake takes no braces, control characters or spaces at the ends in "
            "names: rename the folder"
        )


def _check_model(config, case, variant, path):
    wanted = model(config, case, variant, path)
    if wanted and wanted.record not in config.records:
        raise InputError(
            f"{path}: cases.{case}: variant {variant}: model.record: is {wanted.record!r}; "
            f"no such record under discover; known: {', '.join(config.records) or 'none'}"
        )


def model(config: Config, case: str, variant: str, path="config.yaml") -> ModelBlock | None:
    """What a variant takes from the model of a record; None for most."""
    written = merged(config.cases[case], variant).get("model")
    if not written:
        return None
    return convert(written, ModelBlock, path, f"{_written(config.cases[case], case, variant, 'model')}.model")


def _written(block, case, variant, key):
    """The block in which a key such as `chain.bead.mass_g` of a variant's case was written: the variant's
    overrides, where these go as deep as the case does.
    """
    steps = re.split(r"[.\[]", key)

    def depth(content):
        for count, step in enumerate(steps):
            if not isinstance(content, dict) or step not in content:
                return count
            content = content[step]
        return len(steps)

    own = depth((block.get("variants") or {}).get(variant))
    place = f"cases.{case}"
    return f"{place}.variants.{variant}" if 0 < own >= depth(block) else place


def card(config: Config, case: str, variant: str, path="config.yaml") -> Card:
    """The resolved card of one variant of one case; InputError where there is none or it is not sound."""
    if case not in config.cases:
        raise InputError(f"{path}: cases.{case}: no such case; known: {', '.join(config.cases)}")
    written = config.cases[case]
    _check_variants(written, f"{path}: cases.{case}")
    if variant not in variant_names(written):
        known = ", ".join(variant_names(written))
        raise InputError(f"{path}: cases.{case}: no variant {variant!r}; known: {known}")
    block = _block(written, case, variant, path)
    try:
        return resolve(case, variant, block)
    except LaboratoryError as error:
        raise InputError(f"{path}: {_written(written, case, variant, error.key)}.{error}") from None


def _check_variants(case, key):
    """Variants are names of files, each with overrides of what the case itself says."""
    variants = case.get("variants")
    if variants is not None and not (
        isinstance(variants, dict) and all(isinstance(v, dict | None) for v in variants.values())
    ):
        raise InputError(f"{key}.variants: expected name: {{overrides}}, one line each")
    for name, changes in (variants or {}).items():
        if not (isinstance(name, str) and re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9_-]{,99}", name)):
            raise InputError(
                f"{key}.variants: {name!r} becomes a file's name: use letters, digits, _, - (at most 100)"
            )
        _check_overrides(case, changes or {}, key, f"variants.{name}")


def _check_overrides(base, changes, key, variant):
    """Keys can only be laid over keys: what stands there in their place would go unread."""
    for name, change in changes.items():
        below = base.get(name)
        if not isinstance(change, dict) or below is None:
            continue
        if not isinstance(below, dict):
            raise InputError(f"{key}.{name}: is {below!r}; write keys and values, as {variant} does")
        _check_overrides(below, change, f"{key}.{name}", variant)


def _block(written, case, variant, path) -> CaseBlock:
    """A case with the overrides of a variant; InputError where a key was written that is not sound."""
    content = merged(written, variant)
    try:
        return msgspec.convert(content, CaseBlock)
    except msgspec.ValidationError as error:
        told = explain(error, content, "", "", CaseBlock)
        place = _written(written, case, variant, told.partition(":")[0])
        raise InputError(f"{path}: {place}.{told}") from None


def card_names(config: Config) -> list[str]:
    """`case.variant` of every card, in order."""
    return [f"{case}.{variant}" for case, block in config.cases.items() for variant in variant_names(block)]


def schema() -> dict[str, Any]:
    """JSON schema of `config.yaml`, for editors; made from the types that check it."""
    (whole, case), parts = msgspec.json.schema_components([Config, CaseBlock], ref_template="#/$defs/{name}")
    parts["Config"]["properties"]["cases"]["additionalProperties"] = case
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **whole, "$defs": parts}
