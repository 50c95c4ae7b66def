"""A finished run as an RO-Crate: what was run, on what, with what result, each file with its SHA-256.

Follows the profile Workflow Run RO-Crate 0.5 (https://w3id.org/ro/wfrun/workflow/0.5). `make crate` calls it,
and installs the extra `cluster`. The crate is a folder: to zip, to deposit, to read without this project.
"""

import argparse
import hashlib
import json
import mimetypes
from collections.abc import Iterable
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from urllib.parse import unquote

import yaml

PROFILES = {
    "https://w3id.org/ro/wfrun/process/0.5": "Process Run Crate",
    "https://w3id.org/ro/wfrun/workflow/0.5": "Workflow Run Crate",
    "https://w3id.org/workflowhub/workflow-ro-crate/1.0": "Workflow RO-Crate",
}
# The profiles build on this version; what it has no words for (sha256) stands in their own context.
VERSION, TERMS = "1.1", "https://w3id.org/ro/terms/workflow-run/context"
INPUTS = ("config.yaml", "requirements.lock", "requirements-build.lock", "workflow/resources/claims.csv")
INPUTS += ("workflow/resources/assumptions.csv",)
MORE = ("workflow/resources/measured/*/*.yaml", "workflow/resources/measured/*/*.csv")
PRODUCTS = ("figures/*.csv", "figures/*.svg", "figures/*.png", "results/*.csv", "results/report.html")
PRODUCTS += tuple(
    f"results/discover/*/{name}" for name in ("verdict.json", "model.json", "*.csv", "index.html")
)
PRODUCTS += ("figures/provenance.json", "results/provenance.json", "results/discover/*/provenance.json")


def described(crate, root: Path, patterns: Iterable[str]) -> list:
    """Files added to a crate under their own paths, with size, kind and SHA-256; in order of their paths."""
    found = sorted({path for pattern in patterns for path in root.glob(pattern) if path.is_file()})
    entities = []
    for path in found:
        name = path.relative_to(root).as_posix()
        about = {
            "name": name,
            "contentSize": str(path.stat().st_size),
            "encodingFormat": mimetypes.guess_type(name)[0] or "text/plain",
            "sha256": hashlib.sha256(path.read_bytes()).hexdigest(),
        }
        entities.append(crate.add_file(path, name, properties=about))
    return entities


def times(root: Path) -> tuple[str, str]:
    """Start and end of the run, from what Snakemake keeps of each product."""
    records = [
        json.loads(path.read_bytes()) for path in (root / ".snakemake/metadata").rglob("*") if path.is_file()
    ]
    spans = [(r["starttime"], r["endtime"]) for r in records if r.get("starttime") and r.get("endtime")]
    if not spans:
        raise SystemExit("no finished run here: make")
    stamp = [datetime.fromtimestamp(t, UTC) for t in (min(s for s, _ in spans), max(e for _, e in spans))]
    return tuple(t.isoformat(timespec="seconds") for t in stamp)


def build(root: Path):
    """The crate of the run in a folder.

    Raises:
        SystemExit: where nothing has been made.
    """
    from rocrate.model import ContextEntity, Person
    from rocrate.rocrate import ROCrate

    crate, citation = (
        ROCrate(version=VERSION),
        yaml.safe_load((root / "CITATION.cff").read_text(encoding="utf-8")),
    )
    crate.metadata.extra_contexts.append(TERMS)
    crate.name, crate.description = citation["title"], citation["abstract"]
    crate.license = "https://spdx.org/licenses/MIT"
    author = crate.add(Person(crate, "#developers", properties={"name": "sonicvacuum developers"}))
    profiles = [
        crate.add(
            ContextEntity(
                crate, url, {"@type": ["CreativeWork", "Profile"], "name": name, "version": url[-3:]}
            )
        )
        for url, name in PROFILES.items()
    ]
    crate.root_dataset["conformsTo"] = profiles
    crate.root_dataset["author"] = author
    workflow = crate.add_workflow(
        root / "workflow/Snakefile",
        "workflow/Snakefile",
        main=True,
        lang="snakemake",
        properties={"name": "pipeline"},
    )
    workflow["programmingLanguage"]["version"] = version("snakemake")
    described(crate, root, ["Snakefile", "workflow/rules/*.smk"])
    used = described(crate, root, (*INPUTS, *MORE))
    made = described(crate, root, PRODUCTS)
    begun, ended = times(root)
    about = {"@type": "CreateAction", "name": "make", "startTime": begun, "endTime": ended}
    action = crate.add(ContextEntity(crate, "#run", about))
    action["instrument"], action["object"], action["result"] = workflow, used, made
    action["agent"] = author
    crate.root_dataset["mentions"] = [action]
    return crate


def faults(folder: Path) -> list[str]:
    """What is wrong with a crate: files missing or changed, and what is absent that the profile asks for."""
    graph = json.loads((folder / "ro-crate-metadata.json").read_text(encoding="utf-8"))["@graph"]
    entities = {entity["@id"]: entity for entity in graph}
    found = [
        f"./: no {key}"
        for key in ("name", "description", "license", "datePublished")
        if key not in entities["./"]
    ]
    for name, about in entities.items():
        if "sha256" in about:
            path = folder / unquote(name)  # an id is an address: spaces and the like are escaped in it
            if not path.is_file():
                found.append(f"{name}: missing")
            elif hashlib.sha256(path.read_bytes()).hexdigest() != about["sha256"]:
                found.append(f"{name}: not the file that is described")
    main = entities.get(entities["./"].get("mainEntity", {}).get("@id"), {})
    if "ComputationalWorkflow" not in main.get("@type", []):
        found.append("mainEntity: no ComputationalWorkflow")
    actions = [entity for entity in graph if entity["@type"] == "CreateAction"]
    for action in actions:
        found += [
            f"{action['@id']}: no {key}" for key in ("instrument", "object", "result") if not action.get(key)
        ]
        used = [one for key in ("object", "result") for one in action.get(key, [])]
        found += [f"{one['@id']}: not described" for one in used if one["@id"] not in entities]
    return found + ([] if actions else ["no CreateAction"])


def main() -> None:
    """Write the crate of the run in the working folder, and look it through."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, required=True)
    out = parser.parse_args().out
    build(Path.cwd()).write(out)
    if found := faults(out):
        raise SystemExit("\n".join(found))


if __name__ == "__main__":
    main()
