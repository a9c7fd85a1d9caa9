"""The independent side of schema_corpus.sh: ruamel.yaml (YAML 1.2) and jsonschema (draft 7) judge what our reader judged."""
import glob
import json
import subprocess
import sys

from jsonschema import Draft7Validator
from ruamel.yaml import YAML

program, source = sys.argv[1:3]
wrong = 0
judged = 0


def fail(text):
    global wrong
    wrong += 1
    if wrong < 20:
        print("schema_corpus:", text)


def verdict(validator, text):
    """good or bad, and why bad."""
    try:
        document = YAML(typ="safe", pure=True).load(text)
    except Exception as error:  # whatever the parser raises, it refuses
        return "bad", repr(error)[:200]
    errors = [f"{'.'.join(map(str, e.absolute_path))}: {e.message}" for e in validator.iter_errors(document)]
    return ("bad", errors[0][:200]) if errors else ("good", "")


for kind in ("scene-dem", "scene-sph", "campaign"):
    schema = json.load(open(f"{source}/schemas/{kind}.schema.json"))
    Draft7Validator.check_schema(schema)
    validator = Draft7Validator(schema)
    # What each folder promises: (our reader, the schema). Folder `reader` holds what no schema can know: dimensions,
    # ranges behind a unit, conditions across documents.
    for folder, ours_expected, theirs_expected in (("good", "good", "good"), ("bad", "bad", "bad"), ("reader", "bad", "good")):
        files = sorted(glob.glob(f"{source}/tests/unit/corpus/{kind}/{folder}/*.*"))
        if folder == "good":
            engine = kind.removeprefix("scene-")
            shipped = f"{source}/campaign/examples/*.yaml" if kind == "campaign" else f"{source}/engine/{engine}/scenes/*.yaml"
            files += sorted(glob.glob(shipped))
        if len(files) < 3:
            fail(f"only {len(files)} documents in {kind}/{folder}")
        if not files:
            continue
        lines = subprocess.run([program, "judge", kind, *files], capture_output=True, text=True, check=True).stdout
        for line in lines.splitlines():
            ours, path = line.split(" ", 1)
            theirs, why = verdict(validator, open(path, "rb").read())
            judged += 1
            if (ours, theirs) != (ours_expected, theirs_expected):
                fail(f"{path}: reader says {ours}, schema says {theirs} ({why}); expected {ours_expected} and {theirs_expected}")

seen = {}
for kind in ("scene-dem", "scene-sph"):
    scene_validator = Draft7Validator(json.load(open(f"{source}/schemas/{kind}.schema.json")))
    generated = subprocess.run([program, "generated", kind], capture_output=True, text=True, check=True).stdout
    for entry in generated.split("%%\n"):
        if not entry:
            continue
        ours, text = entry.split("\n", 1)
        theirs, why = seen[text] if text in seen else verdict(scene_validator, text)
        seen[text] = theirs, why
        judged += 1
        if ours != theirs:
            fail(f"reader says {ours}, schema says {theirs} ({why}) of\n{text}")
    verdicts = [v for t, (v, _) in seen.items() if f"engine: {kind.removeprefix('scene-')}\n" in t]
    if verdicts.count("good") < 200 or verdicts.count("bad") < 500:
        fail(f"{kind}: too few generated documents: {len(verdicts)}")
good = [v for v, _ in seen.values()].count("good")
print(f"schema_corpus: {judged} documents judged ({len(seen)} generated, {good} of them good), {wrong} disagreements")
sys.exit(wrong != 0)
