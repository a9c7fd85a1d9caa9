"""The part of house.sh that reads words: quotations in documents, names of inputs and results, house words.

usage: house.py PROGRAM BUILD SOURCE
"""
import csv
import functools
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
FILE_ENDINGS = (".c", ".js", ".html", ".h", ".yaml", ".db", ".png", ".svg", ".h5", ".hdf", ".hdf5", ".json")
checked = 0
failures = 0


def fail(text):
    global failures
    failures += 1
    print("house:", text)


def check(good, text):
    global checked
    checked += 1
    if not good:
        fail(text)


def read(path):
    with open(path, encoding="utf-8", errors="replace") as file:
        return file.read()


def files(*endings, folders=FOLDERS):
    """Files of the tree by ending, sorted; those of the root for folder '.'."""
    found = [name for name in os.listdir(".") if os.path.isfile(name)] if "." in folders else []
    for folder in folders:
        if folder != ".":
            found += glob.glob(f"{folder}/**/*", recursive=True)
    return sorted(name for name in found if name.endswith(endings) and os.path.isfile(name))


def line_of(text, offset):
    return text.count("\n", 0, offset) + 1


# ---- what the program, the build and the tree know ----


@functools.cache
def help_of(command):
    """What `clast help COMMAND` prints; None when there is no such command."""
    result = subprocess.run([program, "help", command], capture_output=True, text=True)
    return result.stdout if result.returncode == 0 else None


@functools.cache
def known_paths():
    """Paths of inputs and results, names that code may not write down, and the sections that hold paths."""
    table = subprocess.run([program, "explain", "--csv"], capture_output=True, text=True, check=True).stdout
    rows = list(csv.DictReader(io.StringIO(table)))
    paths = {row["path"] for row in rows}
    results = {row["path"].replace(".", "_") for row in rows if row["of"].endswith(("results", "outcome"))}
    names = {name for name in results if "_" in name}
    names |= {row["path"] for row in rows if "." in row["path"] and row["of"].endswith(("scene", "results"))}
    sections = {path[: match.start()] for path in paths for match in re.finditer(r"\.", path)}
    check(len(paths) > 200 and len(names) > 250, f"only {len(paths)} paths and {len(names)} names found")
    return paths, names, sections


def unknown_paths(text):
    """Tokens that begin like a path of an input or result, but are none; names of files are left out."""
    paths, _, sections = known_paths()
    for token in re.findall(r"(?<![\w./-])[a-z]\w*(?:\.[a-zA-Z0-9]\w*)+", text):
        if token.split(".")[0] in sections and token not in paths | sections and not token.endswith(FILE_ENDINGS):
            yield token


@functools.cache
def build_targets():
    text = subprocess.run(["cmake", "--build", build, "--target", "help"], capture_output=True, text=True).stdout
    return set(re.findall(r"^(?:\.\.\. )?([\w.-]+)(?::.*)?$", text, re.M))


@functools.cache
def presets():
    document = json.loads(read("CMakePresets.json"))
    return {preset["name"] for kind in ("configure", "build", "test") for preset in document[f"{kind}Presets"]}


@functools.cache
def file_names():
    return {os.path.basename(name) for name in files("", folders=FOLDERS + ("tests", "."))}


# ---- documents: what they quote exists (contributing.sh checks their links) ----


def check_commands(place, quotation):
    """clast WORD --option, up to the end of the line, a pipe or a comment."""
    for word, rest in re.findall(r"(?<![\w./-])(?:\./)?(?:build/\w+/)?clast ([a-z][a-z-]*)\b(?![.:])([^\n|;&#]*)", quotation):
        check(help_of(word) is not None, f"{place}: there is no command `clast {word}`")
        for option in re.findall(r"(?<!\S)--[a-z-]+", rest):
            known = re.search(re.escape(option) + r"(?![\w-])", help_of(word) or option)
            check(known, f"{place}: clast {word} has no option {option}")


def check_build(place, quotation):
    for target in re.findall(r"--target[ =]([\w.-]+)", quotation):
        check(target in build_targets() or target.endswith("..."), f"{place}: there is no build target {target}")
    for preset in re.findall(r"--preset[ =]([\w.-]+)", quotation):
        check(preset in presets(), f"{place}: there is no preset {preset}")


def names_a_file(token):
    """A path of the repository or the name of one of its files; not a user's file, and not a pattern to fill in."""
    if re.search(r"[<>${}|=:\"'(),…]|\.\.\.|^[-/~.*]|^build/|[A-Z]{4}", token) and not os.path.exists(token):
        return False
    if "/" in token:
        return token.split("/")[0] in FOLDERS + ("tests",)
    return token.endswith((".c", ".h", ".md", ".sh", ".py"))


def check_files(place, here, quotation):
    for token in (word.rstrip(".,;/") for word in quotation.split()):
        if names_a_file(token):
            exists = token in file_names() or glob.glob(token) or glob.glob(os.path.join(here, token))
            check(exists, f"{place}: there is no {token}")


def check_documents():
    for document in files(".md", folders=FOLDERS + ("tests", ".")):
        text = read(document)
        here = os.path.dirname(document)
        outside = re.sub(r"```.*?```", lambda m: re.sub(r"[^\n]", " ", m.group()), text, flags=re.S)
        blocks = list(re.finditer(r"```[^\n]*\n(.*?)```", text, re.S)) + list(re.finditer(r"`([^`\n]+)`", outside))
        for match in blocks:
            place = f"{document}:{line_of(text, match.start())}"
            check_commands(place, match.group(1))
            check_build(place, match.group(1))
            check_files(place, here, match.group(1))
            for token in unknown_paths(match.group(1)):
                fail(f'{place}: no input or result is called "{token}"')


def check_helps():
    """The help of a command quotes commands, too: in its lines between backquotes, and in its examples."""
    for path in files(".txt", folders=("campaign/commands",)):
        text = read(path)
        for match in re.finditer(r"`([^`\n]+)`|^(clast .*)$", text, re.M):
            check_commands(f"{path}:{line_of(text, match.start())}", match.group(1) or match.group(2))


# ---- names of inputs and results in the code ----


def literals(path):
    """(line, string literal) of a C file, comments and includes left out."""
    text = re.sub(r"/\*.*?\*/", lambda m: re.sub(r"[^\n]", " ", m.group()), read(path), flags=re.S)
    for number, line in enumerate(text.split("\n"), 1):
        if not line.startswith("#include"):
            for match in re.finditer(r'"((?:[^"\\]|\\.)*)"', line):
                yield number, match.group(1)


def check_names():
    """A path in any text exists. Outside of the engines no text is the name of an input, and none but an example has the
    name of a result in it: their rows have them."""
    _, names, _ = known_paths()
    for path in files(".c", ".h"):
        may_name = path.startswith("engine/") or "FIELD_TABLE(" in read(path)
        for number, text in literals(path):
            unknown = list(unknown_paths(text))
            check(not unknown, f"{path}:{number}: no input or result is called {', '.join(unknown)}")
            named = (set(re.findall(r"\w+", text)) | {text}) & names
            check(may_name or not named or "clast " in text,
                  f"{path}:{number}: {', '.join(sorted(named))}: named outside of its row; take the name from the table")


def check_modules():
    """The head of a module of sph lists its inputs, with its bodies' materials as material.NAME; each has a row."""
    paths, _, sections = known_paths()
    for path in files(".h", folders=("engine/sph/modules",)):
        text = read(path)
        if "_module = {" not in text:
            continue
        listed = re.findall(r"^ \*   ((?:[a-z_]+\.[\w.*]+(?:, )?)+)(?=  | \*/|$)", text[: text.index("*/") + 2], re.M)
        check(listed, f"{path}: the head lists no input of the module")
        for name in ", ".join(listed).split(", "):
            full = re.sub(r"^material\.", "target.material.", name)
            known = full in paths or (full.endswith(".*") and full[:-2] in sections)
            check(known, f"{path}: the head lists {name}, but no input is called so")


# ---- texts made of parts ----


def statements_of(name, code):
    """(offset, what stands before it in its statement, arguments, the code after it) of every call; `name` is a regular
    expression."""
    for match in re.finditer(rf"\b(?:{name})\(", code):
        at, depth, start, arguments = match.end(), 1, match.end(), []
        while depth and at < len(code):
            if code[at] == '"':
                at = re.compile(r'"(?:[^"\\]|\\.)*"').match(code, at).end()
                continue
            depth += {"(": 1, ")": -1}.get(code[at], 0)
            if depth == 0 or (depth == 1 and code[at] == ","):
                arguments.append(code[start:at])
                start = at + 1
            at += 1
        before = re.split(r"[;{}]", code[max(0, match.start() - 200) : match.start()])[-1]
        yield match.start(), before, arguments, code[at : at + 400]


def check_texts():
    """A text that is made of parts is made by text_append() (schemas/text.h), which never leaves its array. What snprintf
    returns is no offset: it is the length that the text would have had. A text of SQL that may be cut must not run."""
    for path in files(".c", ".h"):
        code = re.sub(r"/\*.*?\*/", lambda m: re.sub(r"[^\n]", " ", m.group()), read(path), flags=re.S)

        def refuse(offset, text):
            fail(f"{path}:{line_of(code, offset)}: {text}")

        for match in re.finditer(r"\b(strn?cpy|stpn?cpy|strn?cat|v?sprintf)\(", code):
            refuse(match.start(), f"{match.group(1)}() knows no size of its array: use snprintf or text_append")
        if path == "schemas/text.c":
            continue
        for offset, before, arguments, after in statements_of("v?snprintf", code):
            check(True, "")
            if "+" in re.sub(r"\[[^\]]*\]", "", arguments[0]):
                refuse(offset, "snprintf into the middle of an array: use text_append")
            if path.startswith("db/") and re.search(r'"[^"]*\b(SELECT|INSERT|UPDATE|DELETE|FROM|WHERE)\b', "".join(arguments)):
                refuse(offset, "a text of SQL that may be cut: use answer_to, sql_executef or sql_preparef")
            kept = re.search(r"(\w+)\s*([+|-]?)=\s*(\([\w ]+\)\s*)?$", before)
            bound = kept and re.search(rf"\b{kept.group(1)}\s*(>=|<(?!<))", after)
            returned = re.search(r"\breturn\s+(\([\w ]+\)\s*)?$", before) and not re.match(r"\s*(>=|<(?!<))", after)
            if returned or (kept and (kept.group(2) or not bound)):
                refuse(offset, "the length that snprintf returns is not compared with the size of the array: use text_append")


def check_choices():
    """Words of a row's choices stand at the numbers of their enum (FIELD_WORDS), not in an order of their own."""
    lists = 0
    for path in files(".c", ".h"):
        text = read(path)
        for name in re.findall(r"(?:\bCHOICE\([\w.]+|\.choices =),? (\w+),", text):
            lists += 1
            check(not re.search(r"\b" + name + r"\[\] = \{\s*\"", text), f"{path}: {name}: write the words by FIELD_WORDS()")
    check(lists > 15, f"only {lists} lists of choices found")


# ---- circles ----

# A unit is NAME.c with NAME.h. Inside a room the units form no circle of includes, but for these, which should become
# fewer: a file and its own parts, mostly.
CIRCLES = (
    "schemas/document schemas/document_tree",
    "engine/mesh/build engine/mesh/mesh",
    "db/store/internal db/store/store",
)


def includes_of_units(folder):
    graph = {}
    for path in files(".c", ".h", folders=(folder,)):
        unit = path[:-2]
        to = {name[:-2] for name in re.findall(r'^#\s*include "([^"]+\.h)"', read(path), re.M)}
        graph.setdefault(unit, set()).update(other for other in to if other != unit and other.startswith(folder + "/"))
    return graph


def circles(graph):
    """The sets of units that include each other, directly or through others (Tarjan 1972)."""
    number, lowest, stack, found = {}, {}, [], []

    def visit(unit):
        number[unit] = lowest[unit] = len(number)
        stack.append(unit)
        for other in graph.get(unit, ()):
            if other not in number:
                visit(other)
                lowest[unit] = min(lowest[unit], lowest[other])
            elif other in stack:
                lowest[unit] = min(lowest[unit], number[other])
        if lowest[unit] == number[unit]:
            members = stack[stack.index(unit):]
            del stack[stack.index(unit):]
            if len(members) > 1:
                found.append(frozenset(members))

    for unit in sorted(graph):
        if unit not in number:
            visit(unit)
    return found


def check_circles():
    assert circles({"a": {"b"}, "b": {"c"}, "c": {"a", "d"}, "d": set()}) == [frozenset("abc")]
    allowed = {frozenset(line.split()) for line in CIRCLES}
    found = [circle for folder in FOLDERS for circle in circles(includes_of_units(folder))]
    for circle in found:
        check(any(circle <= known for known in allowed), "a circle of includes: " + " ".join(sorted(circle)))
    for known in allowed:
        check(known in found, "this circle of includes is gone or smaller; shorten CIRCLES: " + " ".join(sorted(known)))


# ---- words ----

# Private words of this house that have no legitimate use in it.
HOUSE_WORDS = ("mourn", "mourned", "bury", "buried", "dearest", "of the latter", "therein", "whereby", "so much of it as", "what stands there", "say goodbye")


def check_words():
    pattern = re.compile(r"\b(" + "|".join(word.replace(" ", r"\s+") for word in HOUSE_WORDS) + r")\b", re.I)
    for path in files(".c", ".h", ".md", ".sh", ".yaml", ".txt", folders=FOLDERS + ("tests", ".")):
        text = read(path)
        for match in pattern.finditer(text):
            fail(f'{path}:{line_of(text, match.start())}: house word "{match.group()}": say it plainly')


check_documents()
check_helps()
check_names()
check_modules()
check_texts()
check_choices()
check_circles()
check_words()
check(checked > 1000, f"looked at too little ({checked} things)")
print(f"house: {checked} quotations and names checked, {failures} broken")
sys.exit(failures != 0)
