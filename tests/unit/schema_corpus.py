"""The independent side of schema_corpus.sh: ruamel.yaml (YAML 1.2) and jsonschema (draft 7) judge what our reader judged."""
import functools
import glob
import json
import multiprocessing
import re
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


kinds = ("scene-dem", "scene-sph", "campaign")
validators = {kind: Draft7Validator(json.load(open(f"{source}/schemas/{kind}.schema.json"))) for kind in kinds}


@functools.cache
def value_of(text):
    return YAML(typ="safe", pure=True).load("x:" + text)["x"]


def read(text):
    """The document. Generated ones have few different values: each is read once, as the slow reader takes most of the time."""
    levels = [(-1, {})]
    lines = [re.fullmatch(r"( *)(\w+):(| .*)", line) for line in text.splitlines()] if isinstance(text, str) else [None]
    for line, after in zip(lines, [*lines[1:], None]):
        while line and len(line[1]) <= levels[-1][0]:
            levels.pop()
        if not line or line[2] in levels[-1][1]:  # of another form, or wrong
            return YAML(typ="safe", pure=True).load(text)
        nests = not line[3] and after and len(after[1]) > len(line[1])
        levels[-1][1][line[2]] = {} if nests else value_of(line[3])
        if nests:
            levels.append((len(line[1]), levels[-1][1][line[2]]))
    return levels[0][1]


def verdict(kind, text):
    """good or bad, and why bad."""
    try:
        document = read(text)
    except Exception as error:  # whatever the parser raises, it refuses
        return "bad", repr(error)[:200]
    for error in validators[kind].iter_errors(document):  # one is enough, and to find them all takes four times as long
        return "bad", f"{'.'.join(map(str, error.absolute_path))}: {error.message}"[:200]
    return "good", ""


for kind in kinds:
    Draft7Validator.check_schema(validators[kind].schema)
    # What each folder promises: (our reader, the schema). Folder `reader` holds what no schema can know: dimensions,
    # ranges behind a unit, conditions across documents.
    for folder, ours_expected, theirs_expected in (("good", "good", "good"), ("bad", "bad", "bad"), ("reader", "bad", "good")):
        files = sorted(glob.glob(f"{source}/tests/unit/corpus/{kind}/{folder}/*.*"))
        if folder == "good":
            engine = kind.removeprefix("scene-")
            shipped = f"{source}/campaign/examples/*.yaml" if kind == "campaign" else f"{source}/engine/{engine}/scene/builtin/*.yaml"
            files += sorted(glob.glob(shipped))
        if len(files) < 3:
            fail(f"only {len(files)} documents in {kind}/{folder}")
        if not files:
            continue
        lines = subprocess.run([program, "judge", kind, *files], capture_output=True, text=True, check=True).stdout
        for line in lines.splitlines():
            ours, path = line.split(" ", 1)
            theirs, why = verdict(kind, open(path, "rb").read())
            judged += 1
            if (ours, theirs) != (ours_expected, theirs_expected):
                fail(f"{path}: reader says {ours}, schema says {theirs} ({why}); expected {ours_expected} and {theirs_expected}")

seen = {}
with multiprocessing.Pool() as pool:  # YAML read in Python takes most of the time
    for kind in kinds[:2]:
        generated = subprocess.run([program, "generated", kind], capture_output=True, text=True, check=True).stdout
        entries = [entry.split("\n", 1) for entry in generated.split("%%\n") if entry]
        texts = list(dict.fromkeys(text for _, text in entries))
        theirs_of = dict(zip(texts, pool.starmap(verdict, [(kind, text) for text in texts], chunksize=100)))
        for ours, text in entries:
            theirs, why = theirs_of[text]
            judged += 1
            if ours != theirs:
                fail(f"reader says {ours}, schema says {theirs} ({why}) of\n{text}")
        verdicts = [v for v, _ in theirs_of.values()]
        if verdicts.count("good") < 200 or verdicts.count("bad") < 500:
            fail(f"{kind}: too few generated documents: {len(verdicts)}")
        seen.update(theirs_of)
good = [v for v, _ in seen.values()].count("good")
print(f"schema_corpus: {judged} documents judged ({len(seen)} generated, {good} of them good), {wrong} disagreements")
sys.exit(wrong != 0)
