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
    assert re.match(r"\.(\\\"|TH |SH |SS |TP 15$|nr HY 0$|ad l$|br$|EX$|EE$)|[^.']|$", line), f"{number}: {line}"
    assert not re.search(r"\\f[BI](?!.*\\fR)", line), f"{number}: the font stays changed: {line}"
    example = line == ".EX" or (example and line != ".EE")
    if not line.startswith((r".\"", ".TH")):
        rest = re.sub(r"\\(-|&|f[BRI]|\((rs|aq|dq|ga|ha|ti))", " ", line)
        assert not re.search(r"[\\`'^~]|[^ -~]", rest), f"{number}: something unescaped: {line}"
        assert not re.search("-" if example else r"(?<![A-Za-z])-|-(?![A-Za-z])", rest), f"{number}: a literal dash unescaped: {line}"
page = re.sub(r"\\(-|&|f[BRI]|\(..)", lambda m: escapes[m.group()], "\n".join(lines))

def ask(*arguments):
    return subprocess.run([clast, *arguments], capture_output=True, text=True, check=True).stdout

found = re.findall(r"^  ([a-z]+) {2,}\S", ask("help"), re.M)
assert ".SH DESCRIPTION\n.EX\n" + ask("help") + ".EE\n" in page
for name in found:
    assert f".SS clast {name}\n.EX\n" + ask(name, "--help") + ".EE\n" in page, name
getenv = subprocess.run(["grep", "-rhoE", r'getenv\("[A-Z_]+"\)', "--include=*.c", source + "/engine", source + "/campaign"],
                        capture_output=True, text=True, check=True).stdout
read = {n for n in re.findall(r'"(.*?)"', getenv) if not n.startswith(("OMPI_", "PMI", "OMP_"))} # launchers'; only recorded
told = set(re.findall(r"\.TP 15\n(\S+)", page.split(".SH ENVIRONMENT\n")[1].split(".SH ")[0]))
assert told == read, (told, read)
assert found == [word for word in ask("completion", "bash", "--", "").split() if word[0] != "-"], found
print(len(found), "commands")
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
