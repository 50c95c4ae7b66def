"""Files of cases, as `hide` and `discover` leave them: each in the folder of its case."""

import json


def put(folder, id, name, content):
    (folder / id).mkdir(parents=True, exist_ok=True)
    (folder / id / name).write_text(json.dumps(content))
