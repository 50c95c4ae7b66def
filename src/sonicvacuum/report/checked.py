"""`record check`: what is in records, what of it looks wrong, and what `discover` would do with them.

The search cuts and thins long traces and looks them through for slips of the laboratory before it fits
anything; the check does the same, so that it says beforehand what the verdict will be made from.
"""

import json

from sonicvacuum import plugins
from sonicvacuum.discover.faults.examine import examine
from sonicvacuum.discover.model import window
from sonicvacuum.discover.model.present import refused
from sonicvacuum.records import Record, read
from sonicvacuum.records.commands import summary
from sonicvacuum.records.extent import check_expected
from sonicvacuum.records.review import Review, content, review
from sonicvacuum.report.bench import slip


def check(folders, as_json: bool = False, limits: bool = True) -> str:
    """Summaries of the records in folders, one after the other, or JSON (format 1, SI units).

    Raises:
        InputError: for the first that cannot be read, or (`limits`) whose nominal model asks for more than a
            computer gives, before anything is said of another.
    """
    records = [read(folder) for folder in folders]
    for record in records if limits else ():
        check_expected(record)
    if as_json:
        found = [content(looked_through(record)) for record in records]
        return json.dumps({"format": 1, "records": found}, indent=1, ensure_ascii=False, allow_nan=False)
    return "\n".join(summary(record, looked_through(record)) for record in records)


def looked_through(record: Record) -> Review:
    """The review of a record with what the search would do to its traces."""
    searched, treatment = window.fitted(record)
    slips = tuple(slip(found, (record,)) for found in examine(searched)[1])
    priors = tuple(f"{told} (discover refuses it)" for told in refused(record, plugins.catalogue()))
    return review(record, searched, treatment, (*slips, *priors))
