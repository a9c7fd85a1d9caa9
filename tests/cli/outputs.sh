#!/usr/bin/env bash
# No output replaces a store, a campaign or an input. Every option and operand of every command that takes a value is tried,
# as the help lists them, so that a new one is tried by itself.
. "$(dirname "$0")/lib.bash"

tiny self 'keep: {fields: first 1}'
sed -i 's/1 ms}/0.2 ms}/; s/per_point: 3/per_point: 2/' self.yaml
sed 's/: self/: other/; s/self.db/other.db/' self.yaml >other.yaml
"$clast" scenes disc-explosion >scene.yaml
for name in self other; do "$clast" run $name.yaml -j 1 --quiet >out 2>err || fail "no store $name.db"; done
"$clast" simulate scene.yaml --set body.diameter='8 cm' --set stop.end_time='0.1 ms' --fields fields.h5 >out 2>err || fail "no fields"
printf 'name: one\nsource: a run of the program\nshots:\n  - measured:\n      - {quantity: largest_fraction, value: 0.5, error: 0.01}\n' >measured.yaml
printf 'mass (g)\n1\n2\n5\n9\n' >masses.csv

python - "$clast" <<'PY' >tried || { cat tried; fail "an output replaced a file"; }
import os, re, shutil, subprocess, sys

clast = sys.argv[1]
tried = refused = 0
failures = []


def run(*words):
    return subprocess.run([clast, *words], capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=60)


def read(name):
    with open(name, "rb") as file:
        return file.read()


# Stores are also called like pictures and tables. A hard link and a symbolic link lead to the other store.
kept = {}
for ending in (".db", ".png", ".csv"):
    for name in ("self", "other"):
        if ending != ".db":
            shutil.copy(name + ".db", name + ending)
        kept[name + ending] = None
    os.link("other" + ending, "hard" + ending)
    os.symlink("other" + ending, "soft" + ending)
for name, copy in (("self.yaml", "campaign.png"), ("scene.yaml", "scene.png")):
    shutil.copy(name, copy)
    kept[name] = kept[copy] = None
fields = "self-fields/" + sorted(os.listdir("self-fields"))[-1]
for name in ("measured.yaml", "fields.h5", "masses.csv", fields):
    kept[name] = None
kept = {name: read(name) for name in list(kept) + ["hard.db", "soft.db", "hard.png", "soft.png", "hard.csv", "soft.csv"]}
os.mkdir("folder")


def attempt(words, victim, must):
    """Runs a command. Every kept file stays as it was, and the exit code is one of `must` if that is given."""
    global tried, refused
    tried += 1
    try:
        done = run(*words)
        code, message = done.returncode, " ".join(done.stderr.rpartition("clast: error: ")[2].split("\n")).strip()
    except subprocess.TimeoutExpired:
        code, message = "none in 60 s", ""
    changed = [name for name in kept if not os.path.isfile(name) or read(name) != kept[name]]
    for link in ("soft.db", "soft.png", "soft.csv"):
        if not os.path.islink(link):
            changed.append(link + " (no link any more)")
    if changed or (must and code not in must):
        failures.append(f"clast {' '.join(words)}: exit {code}, changed: {', '.join(changed) or 'nothing'}: {message}")
    if must and 74 in must:
        refused += 1
        known = os.path.basename(victim) in message
        if code == 74 and not (known and "name another" in message):
            failures.append(f"clast {' '.join(words)}: the message lacks the file or what to do: {message}")
    for name in changed:
        name = name.split()[0]
        if os.path.lexists(name):
            os.unlink(name)
        if name.startswith("hard"):
            os.link(name.replace("hard", "other"), name)
        elif name.startswith("soft"):
            os.symlink(name.replace("soft", "other"), name)
        else:
            with open(name, "wb") as file:
                file.write(kept[name])


INPUTS = {"STORE": "self.db", "A": "self.db", "B": "other.db", "STORE...": "self.db", "CAMPAIGN.yaml": "self.yaml",
          "MEASURED.yaml": "measured.yaml", "SCENE": "scene.yaml", "SCENE|CAMPAIGN.yaml": "scene.yaml",
          "FIELDS.hdf": "fields.h5", "FIELDS.hdf[.series": "fields.h5", "RUN": "1", "scene|campaign": "scene", "SHELL": "bash"}
OUTPUTS = {"PICTURE.png": "drawn.png", "TARGET.csv": "made.csv", "TARGET": "made"}
OWN = {"sensitivity": ["self.db", "self.yaml"], "merge": ["merged.db", "self.db"]}  # a store or a new file: their own rules
NEEDED = {"plot": ["-x", "strain"], "map": ["-x", "strain", "-y", "angle"], "export": ["--per", "run"]}
NONE = {"NAME", "WORD...", "RUN...", "PATH|WORD|SCENE", "NAME|FILE", "COMMAND", "SQL"}


def victims(picture, reads, ending=None):
    """Files that stand in the way of an output, and the exit codes that are right. Names of documents end in .yaml; a
    document with another name is known by the command that reads it."""
    ending = ending or (".png" if picture else ".db")
    for name in ("self", "other", "hard", "soft", "./other", "folder/../hard", os.path.abspath("other")):
        yield name + ending, {74}
    yield fields, {64, 74} if picture else {74}
    for name, copy in (("self.yaml", "campaign.png"), ("scene.yaml", "scene.png")):
        yield name, {64, 74} if ending != ".db" else {74}
        if name in reads:
            yield copy, {74}


def with_inputs(words, victim):
    """The same command with the victim as its input, where that is another name of the input."""
    of = {"campaign.png": "self.yaml", "scene.png": "scene.yaml", "self.png": "self.db"}.get(victim)
    return [("./" + victim if word == of else word) for word in words]


commands = re.findall(r"^  ([a-z]+)  +\S", run("help").stdout, re.M)
assert len(commands) > 25, commands
files = set()
for command in commands:
    text = run("help", command).stdout
    usage = re.search(r"usage: clast \w+ (?:\[OPTIONS\] ?)?(.*)", text).group(1)
    operands, places = [], []
    for word in OWN[command] if command in OWN else re.findall(r"\[[^]]*\]|\S+", usage):
        word = word if word.endswith("...") else word.strip("[]")
        if word in OUTPUTS:
            places.append((len(operands), word))
        if command in OWN or word not in NONE:
            operands.append(word if command in OWN else {**INPUTS, **OUTPUTS}[word])
    base = NEEDED.get(command, [])
    for place, word in places:
        for victim, must in victims(word == "PICTURE.png", operands, ".csv" if word == "TARGET.csv" else None):
            line = with_inputs(operands, victim)
            line[place] = victim
            attempt([command, *base, *line], victim, must)
    for name, value in re.findall(r"^  (?:-\w,|   ) --([a-z-]+) (\S+)", text, re.M):
        is_file = re.search(r"FILE|PAGE", value) and name not in ("with", "store", "token")
        if name == "store":  # a store of this name is its purpose
            for victim in ("self.yaml", "scene.yaml", "campaign.png", "x-wal", "x-shm", "x-journal"):
                if command != "plan":
                    attempt([command, *base, *operands, "--store", victim], victim, {64, 65, 74})
            continue
        if not is_file:
            if command != "serve":
                attempt([command, *base, *operands, f"--{name}", "other.db"], "other.db", None)
            continue
        files.add(f"{command} --{name}")
        for victim, must in victims("png" in value or name == "picture", operands):
            attempt([command, *base, *with_inputs(operands, victim), f"--{name}", victim], victim, must)

for mode in ([], ["--bits"], ["--csv"], ["--crate"], ["--per", "point", "--jsonl"]):
    for victim, must in victims(False, ["self.db"]):
        attempt(["export", "self.db", victim, *mode], "", {64, 74})
assert {"simulate --fields", "simulate --restart", "replay --fields", "report --output", "converge --picture",
        "spectrum --picture"} <= files, files
assert tried > 250 and refused > 100, (tried, refused)
print(f"{tried} commands, {len(files)} options that name an output, {len(failures)} faults")
print("\n".join(failures))
sys.exit(bool(failures))
PY
ok "$(head -1 tried)"

# The refusal comes before the work: these runs would take days.
long=(--set body.diameter='8 m' --set stop.end_time='1000 s')
expect 74 timeout 20 "$clast" simulate scene.yaml "${long[@]}" --fields other.db
expect 74 timeout 20 "$clast" simulate scene.yaml "${long[@]}" --restart other.db
cp other.db disc-explosion_000004.hdf
expect 74 timeout 20 "$clast" simulate scene.yaml "${long[@]}" --snapshots 6
says "disc-explosion_000004.hdf"
cmp -s other.db disc-explosion_000004.hdf || fail "a snapshot replaced a store"
expect 74 timeout 20 "$clast" converge ./scene.yaml "${long[@]}" --knob grains --picture other.png --store new.db
expect 64 timeout 20 "$clast" converge ./scene.yaml "${long[@]}" --knob grains --picture curve.bmp --store new.db
expect 74 timeout 20 "$clast" converge ./scene.yaml "${long[@]}" --knob grains --picture new.png --store ./new.png
[ ! -e new.png ] && [ ! -e new.db ] || fail "a store was made"

# Two outputs with one name, also through links and other spellings.
expect 64 "$clast" simulate scene.yaml --fields one.png --picture one.png
says "two outputs"
expect 64 "$clast" simulate scene.yaml --fields one.png --picture ./one.png
touch one.png && ln one.png two.png
expect 64 "$clast" simulate scene.yaml --fields one.png --picture two.png
expect 0 "$clast" simulate scene.yaml --set body.diameter='8 cm' --set stop.end_time='0.1 ms' --fields /dev/null

# Inputs that a document or an option names; files beside a store; files that come with another output.
printf 'threshold.strain\n2 %%\n5 %%\n' >points.csv
printf 'name: listed\nscene: disc-explosion\nset: {body.diameter: 8 cm, stop.end_time: 0.1 ms}\ndesign: {file: points.csv}\nseeds: {per_point: 2}\nstore: listed.db\n' >listed.yaml
ln points.csv points.png
expect 65 "$clast" converge listed.yaml --knob grains --picture points.png # an error in the line of the document
says "this command reads it"
cp masses.csv masses.dat
expect 74 "$clast" spectrum self.db --with masses.dat --picture masses.png --keep-script --by ''
cmp -s masses.csv masses.dat && [ ! -e masses.gp ] && [ ! -e masses.png ] || fail "data of a chart replaced the measured masses"
for ending in wal shm journal; do
  expect 74 "$clast" export self.db self.db-$ending --bits
  expect 64 "$clast" export self.db copy.db-$ending
  expect 64 "$clast" merge copy.db-$ending self.db
done
mkdir tables && cp other.db tables/points.csv
expect 74 "$clast" export self.db tables --csv
cmp -s other.db tables/points.csv && [ "$(ls tables)" = points.csv ] || fail "--csv changed the folder"
expect 74 "$clast" export self.db other.yaml --bits # a campaign that this command does not read
expect 0 "$clast" export self.db rows.json --per run --jsonl
expect 0 "$clast" export self.db rows.json --per run --jsonl
expect 0 "$clast" export self.db points.json --per point --jsonl
expect 0 "$clast" export self.db points.json --per point --jsonl

# A name that is free again, the file of a killed writer, and a link in the place of the temporary file.
expect 0 "$clast" report self.db -o page.html
expect 0 "$clast" report self.db -o page.html
echo half >page.html.unfinished
expect 0 "$clast" report self.db -o page.html
[ ! -e page.html.unfinished ] || fail "the file of a killed writer stayed"
cp other.db before
ln -s other.db page.html.unfinished
expect 0 "$clast" report self.db -o page.html
cmp -s other.db before && [ -L page.html.unfinished ] || fail "a link was followed"
rm page.html.unfinished && ln other.db page.html.unfinished
expect 0 "$clast" report self.db -o page.html
cmp -s other.db before || fail "a hard link was followed"
rm page.html.unfinished

# What is open already is written, not replaced.
"$clast" export self.db /dev/stdout --per run >by_name.csv 2>err || fail "export to /dev/stdout"
"$clast" export self.db --per run >direct.csv 2>err
cmp -s by_name.csv direct.csv && [ -L /dev/stdout ] || fail "/dev/stdout"
ok "an open file is written"
[ -z "$(find . -name '*.unfinished')" ] || fail "an unfinished file was left behind"
done_after 34
