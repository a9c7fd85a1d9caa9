"""The part of house.sh that reads words: quotations in documents, names of inputs and results, house words.

usage: house.py PROGRAM BUILD SOURCE
"""
import csv
import glob
import io
import json
import os
import re
import subprocess
import sys

program, build, source = sys.argv[1:4]
os.chdir(source)
FOLDERS = ("schemas", "engine", "analysis", "db", "campaign")
checked = 0
failures = 0


def fail(text, pending=False):
    """pending: known places that are still to be mended are told, not counted."""
    global failures
    failures += not pending
    print("house:", "not yet an error: " * pending + text)


def read(path):
    with open(path, encoding="utf-8", errors="replace") as file:
        return file.read()


def files(*endings, folders=FOLDERS):
    """Files of the tree by ending, sorted; those of the root for folder '.'."""
    found = [name for name in os.listdir(".") if os.path.isfile(name)] if "." in folders else []
    for folder in folders:
        if folder != ".":
            found += glob.glob(f"{folder}/**/*", recursive=True)
    return sorted(name for name in found if name.endswith(endings))


def line_of(text, offset):
    return text.count("\n", 0, offset) + 1


# ---- documents: what they quote exists ----

def command_exists(word):
    known = command_exists.known
    if word not in known:
        known[word] = subprocess.run([program, "help", word], capture_output=True).returncode == 0
    return known[word]


command_exists.known = {}


def build_targets():
    text = subprocess.run(["cmake", "--build", build, "--target", "help"], capture_output=True, text=True).stdout
    return set(re.findall(r"^(?:\.\.\. )?([\w.-]+)(?::.*)?$", text, re.M))


def presets():
    document = json.loads(read("CMakePresets.json"))
    return {p["name"] for kind in ("configurePresets", "buildPresets", "testPresets") for p in document[kind]}


def is_path(token):
    """A path of the repository or the name of one of its files; not a user's file, and not a pattern to fill in."""
    if re.search(r"[<>${}|=:\"'(),…]|\.\.\.|^[-/~.]|^build/|[A-Z]{4}", token) and not os.path.exists(token):
        return False
    first = token.split("/")[0]
    if "/" in token:
        return first in FOLDERS + ("tests",)
    return token.endswith((".c", ".h", ".md", ".sh", ".py")) and not token.startswith("*")


def path_exists(token, names):
    token = token.rstrip("/")
    if "/" in token or "*" in token:
        return bool(glob.glob(token))
    return token in names


def check_documents():
    global checked
    names = {os.path.basename(name) for name in files("", folders=FOLDERS + ("tests", "."))}
    targets, preset_names = build_targets(), presets()
    for document in files(".md", folders=FOLDERS + ("tests", ".")):
        text = read(document)
        here = os.path.dirname(document)
        quotations = [(m.start(), m.group(1)) for m in re.finditer(r"```[^\n]*\n(.*?)```", text, re.S)]
        inline = re.sub(r"```.*?```", lambda m: re.sub(r"[^\n]", " ", m.group()), text, flags=re.S)
        quotations += [(m.start(), m.group(1)) for m in re.finditer(r"`([^`\n]+)`", inline)]
        for offset, quotation in quotations:
            place = f"{document}:{line_of(text, offset)}"
            for word in re.findall(r"(?<![\w./-])(?:\./)?(?:build/\w+/)?clast ([a-z][a-z-]*)\b(?![.:])", quotation):
                checked += 1
                if not command_exists(word):
                    fail(f"{place}: there is no command `clast {word}`")
            for target in re.findall(r"--target[ =]([\w.-]+)", quotation):
                checked += 1
                if target not in targets and not target.endswith("..."):
                    fail(f"{place}: there is no build target {target}")
            for preset in re.findall(r"--preset[ =]([\w.-]+)", quotation):
                checked += 1
                if preset not in preset_names:
                    fail(f"{place}: there is no preset {preset}")
            for token in re.findall(r"\S+", quotation):
                token = token.rstrip(".,;")
                if not is_path(token):
                    continue
                checked += 1
                if not path_exists(token, names) and not (here and path_exists(f"{here}/{token}", names)):
                    fail(f"{place}: there is no {token}")
        for match in re.finditer(r"\]\(([^)#\s]+)(?:#[^)]*)?\)", inline):
            target = match.group(1)
            if re.match(r"[a-z]+:", target):
                continue
            checked += 1
            if not os.path.exists(os.path.join(here, target)):
                fail(f"{document}:{line_of(text, match.start())}: the link's target {target} does not exist")


# ---- names of inputs and results ----

ENDINGS = (".c", ".h", ".yaml", ".db", ".png", ".svg", ".h5", ".hdf", ".hdf5", ".json")  # of file names in examples

def literals(path):
    """(line, string literal) of a C file, comments and includes left out."""
    text = re.sub(r"/\*.*?\*/", lambda m: re.sub(r"[^\n]", " ", m.group()), read(path), flags=re.S)
    for number, line in enumerate(text.split("\n"), 1):
        if not line.startswith("#include"):
            for match in re.finditer(r'"((?:[^"\\]|\\.)*)"', line):
                yield number, match.group(1)


def check_names():
    """A path in any text exists; outside of the engines no text but an example names a result: rows name it."""
    global checked
    table = subprocess.run([program, "explain", "--csv"], capture_output=True, text=True, check=True).stdout
    rows = list(csv.DictReader(io.StringIO(table)))
    paths = {row["path"] for row in rows}
    sections = {path[:end] for path in paths for end in (m.start() for m in re.finditer(r"\.", path))}
    results = {row["path"].replace(".", "_") for row in rows if row["of"].endswith(("results", "outcome"))}
    results = {name for name in results if "_" in name}
    if len(paths) < 200 or len(results) < 50:
        fail(f"only {len(paths)} paths and {len(results)} results found")
    for path in files(".c", ".h"):
        has_rows = "FIELD_TABLE(" in read(path) or path.endswith("_rows.h")
        for number, text in literals(path):
            for token in re.findall(r"(?<![\w./-])[a-z]\w*(?:\.[a-zA-Z0-9]\w*)*", text):
                checked += 1
                known = token in paths or token in sections
                if "." in token and token.split(".")[0] in sections and not known and not token.endswith(ENDINGS):
                    fail(f'{path}:{number}: no input or result is called "{token}"')
                if token in results and not (has_rows or path.startswith("engine/") or "clast " in text):
                    fail(f'{path}:{number}: "{token}" is named outside of its row: take the name from the table', path.startswith("db/"))


# ---- words ----

# Private words of this house that have no legitimate use in it.
HOUSE_WORDS = ("mourn", "mourned", "bury", "buried", "dearest", "veneer", "so much of it as", "what stands there", "say goodbye")


def check_words():
    global checked
    pattern = re.compile(r"\b(" + "|".join(word.replace(" ", r"\s+") for word in HOUSE_WORDS) + r")\b", re.I)
    for path in files(".c", ".h", ".md", ".sh", ".yaml", ".txt", folders=FOLDERS + ("tests", ".")):
        text = read(path)
        checked += 1
        for match in pattern.finditer(text):
            fail(f'{path}:{line_of(text, match.start())}: house word "{match.group()}": say it plainly', True)


check_documents()
check_names()
check_words()
if checked < 1000:
    fail(f"looked at too little ({checked} things)")
print(f"house: {checked} quotations, names and words checked, {failures} broken")
sys.exit(failures != 0)
