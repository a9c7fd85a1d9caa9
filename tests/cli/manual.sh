#!/usr/bin/env bash
# The manual page: every command, option, example, exit code and environment variable is in it, installed or not, and roff reads it.
# Where there is neither groff (all of it: `man` needs that, too) nor mandoc, the last part is left out, and it says so.
. "$(dirname "$0")/lib.bash"

expect 0 "$clast" help --man
silent err
mv out clast.1
expect 64 "$clast" help --man run
one_error
cmp clast.1 "$build/man/man1/clast.1" || fail "the page the build made is another: build all first"
DESTDIR=$work/image cmake --install "$build" --prefix /usr >out 2>err || fail "cmake --install with DESTDIR"
[ -x image/usr/bin/clast ] || fail "the program is not installed" # cli.install checks the other files
ok "installed files"
cmp clast.1 image/usr/share/man/man1/clast.1 || fail "the installed page is another"

# Read back without a formatter: undo the escapes, and look for what the tables say in the part of each command.
cat >look.py <<'PY'
import re, subprocess, sys
clast, source = sys.argv[1:]
escapes = {"\\-": "-", "\\(rs": "\\", "\\(aq": "'", "\\(dq": '"', "\\(ga": "`", "\\(ha": "^", "\\(ti": "~", "\\&": "", "\\fB": "", "\\fR": "", "\\fI": ""}
lines = open("clast.1").read().split("\n")
example = False
for number, line in enumerate(lines, 1):
    assert re.match(r"\.(\\\"|TH |SH |SS |TP 15$|nr HY 0$|ad l$|br$|PP$|PD( 0)?$|RS 4$|RE$|EX$|EE$)|[^.']|$", line), f"{number}: {line}"
    assert not re.search(r"\\f[BI](?!.*\\fR)", line), f"{number}: the font stays changed: {line}"
    example = line == ".EX" or (example and line != ".EE")
    if not line.startswith((r".\"", ".TH")):
        rest = re.sub(r"\\(-|&|f[BRI]|\((rs|aq|dq|ga|ha|ti))", " ", line)
        assert not re.search(r"[\\`'^~]|[^ -~]", rest), f"{number}: something unescaped: {line}"
        assert not re.search("-" if example else r"(?<![A-Za-z])-|-(?![A-Za-z])", rest), f"{number}: a literal dash unescaped: {line}"
plain = [re.sub(r"\\(-|&|f[BRI]|\(..)", lambda m: escapes[m.group()], line) for line in lines]
sections, part = {}, None
for line in plain:
    if line.startswith(".SS clast "):
        part = sections.setdefault(line.split()[2], [])
    elif line.startswith(".SH "):
        part = sections.setdefault(line[4:], [])
    if part is not None:
        part.append(line)

def ask(*arguments):
    return subprocess.run([clast, *arguments], capture_output=True, text=True, check=True).stdout

words = lambda text: " ".join(text.replace("`", "").split())
options, found = 0, 0
for name, summary in re.findall(r"^  ([a-z]+) {2,}(\S.*)$", ask("help"), re.M):
    found += 1
    assert words(summary) in map(words, sections["COMMANDS"]), (name, summary)
    usage, doc, rows, examples, codes = re.fullmatch(
        r"usage: (.*?) *\n\n(.*)\n\noptions:\n(.*)\nexamples:\n(.*)\nexit codes:\n(.*)", ask(name, "--help"), re.S).groups()
    page = sections[name]
    assert page[0] == ".SS " + usage, (page[0], usage)
    assert words(doc) in words(" ".join(page)), (name, doc)
    tags = {}
    for i, line in enumerate(page):
        if line.startswith(".TP"):
            tags[page[i + 1]] = words(page[i + 2])
    wanted = {}
    for letter, flag, rest in re.findall(r"^  (-\w, |    )(--\S+(?: \S+)?)((?:  .*|\n {30}.*|$)(?:\n {30}.*)*)", rows, re.M):
        wanted[letter.strip() + (" " if letter.strip() else "") + flag] = words(rest)
    assert wanted.pop("-h, --help") and len(wanted) == len(re.findall(r"^  \S|^      --", rows, re.M)) - 1, (name, wanted)
    assert tags == wanted, (name, tags, wanted)
    options += len(wanted)
    shown = page[page.index(".EX") + 1:page.index(".EE")]
    assert shown == [line[2:] for line in examples.rstrip("\n").split("\n")], (name, shown)
    for code in codes.rstrip("\n").split("\n"):
        number, meaning = code.split(None, 1)
        at = sections["EXIT STATUS"].index(number)
        assert sections["EXIT STATUS"][at + 1] == meaning, code
getenv = subprocess.run(["grep", "-rhoE", r'getenv\("[A-Z_]+"\)', "--include=*.c", source + "/engine", source + "/campaign"],
                        capture_output=True, text=True, check=True).stdout
read = {n for n in re.findall(r'"(.*?)"', getenv) if not n.startswith(("OMPI_", "PMI", "OMP_"))} # launchers'; only recorded
told = {sections["ENVIRONMENT"][i + 1] for i, line in enumerate(sections["ENVIRONMENT"]) if line.startswith(".TP")}
assert told == read, (told, read)
assert found == len([word for word in ask("completion", "bash", "--", "").split() if word[0] != "-"]), found
print(found, "commands,", options, "options")
PY
python look.py "$clast" "$source" >out 2>err || fail "the page against the help"
ok "the page has all that the help has: $(cat out)"

readers=
if command -v mandoc >/dev/null; then
  mandoc -T lint -W warning clast.1 >out 2>err || fail "mandoc -T lint"
  readers=mandoc
fi
if command -v groff >/dev/null && [ -n "$(find -L /usr/share/groff -name an.tmac 2>/dev/null)" ]; then
  groff -ww -man -Tutf8 -rLL=100n clast.1 >out 2>err || fail "groff"
  silent err
  prints "clast retry out.db --status failed --time '1 h'"
  readers="$readers${readers:+, }groff"
fi
ok "read without a warning by: ${readers:-nobody (skipped: neither mandoc nor groff with its man macros on this machine)}"
done_after 5
