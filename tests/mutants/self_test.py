"""The test of the mutator (unit.mutants): mutations of single lines, and a toy whose mutants and verdicts are known."""
import collections
import glob
import importlib.machinery
import importlib.util
import json
import os
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
sys.dont_write_bytecode = True
import operators

COUNT = 18  # mutants of the toy
failures = 0


def check(what, found, expected):
    global failures
    if found != expected:
        failures += 1
        print(f"{what}:\n  found    {found}\n  expected {expected}")


def of_line(line, before="  int y = 1;"):
    """Mutations of one line in a function."""
    found = dict(operators.mutations(f"int f(int a, int b) {{\n{before}\n{line}\n}}\n"))
    return [f"{kind}: {after.strip()}" for kind, after in found.get(3, [])]


def check_operators():
    check("relation, negation", of_line("  if (a < b)"), ["relation: if (a <= b)", "relation: if (a > b)", "negation: if (!(a < b))"])
    check("logic", of_line("  while (a && b) {"), ["logic: while (a || b) {", "negation: while (!(a && b)) {"])
    check("a statement", of_line("  a += b;"), ["arithmetic: a -= b;", "deletion: ;", "early return: return 0; a += b;"])
    check("a return of a value", of_line("  return b;"), ["early return: return 0; return b;"])
    check("a branch", of_line("  go(a);", "  if (b)"), ["deletion: ;", "early return: return 0;"])
    check("whole numbers", of_line("      a[2], 0, 1u,"),
          ["constant: a[3], 0, 1u,", "constant: a[0], 0, 1u,", "constant: a[2], 1, 1u,", "constant: a[2], 0, 0u,", "constant: a[2], 0, 2u,"])
    check("real numbers", of_line("      1.5e3,"), ["constant: (2 * 1.5e3),", "constant: (0.5 * 1.5e3),"])
    check("the size of a buffer", of_line("  , text[64]"), [])
    check("a pointer, a cast, a string, a comment", of_line('  , (char *)&a, *b, "1 < 2" /* 3 < 4 */'), [])
    check("part of a statement", [line for line in of_line("      b);", "  go(a,")], [])
    check("a preprocessor line", of_line("#if A < 2 \\\n || B > 3"), [])


def check_toy(folder):
    source = f"{folder}/toy"
    shutil.copytree(f"{HERE}/toy", source)
    command = [f"{HERE}/run", "--source", source, "--seed", "162", "--count", str(COUNT), "--minutes", "5"]
    ran = subprocess.run(command, capture_output=True, text=True)
    check("return code", (ran.returncode, ran.stderr), (0, ""))
    with open(glob.glob(f"{source}/build/mutants/*.jsonl")[0], encoding="utf-8") as file:
        mutants = [json.loads(line) for line in file]
    count = collections.Counter(mutant["verdict"] for mutant in mutants)
    for mutant in mutants:
        if mutant["verdict"] in ("killed", "survived"):
            expected = "killed" if "/* killed */" in mutant["before"] else "survived"
            check(f"verdict of {mutant['before'].strip()} -> {mutant['after'].strip()}", mutant["verdict"], expected)
    check("mutants that count", count["killed"] + count["survived"], COUNT)
    check("killed by", {mutant["test"] for mutant in mutants if mutant["verdict"] == "killed"}, {"unit.test_toy"})
    check("verdicts", set(count) >= {"killed", "survived", "same object"}, True)
    check("operators", {mutant["operator"] for mutant in mutants},
          {"relation", "arithmetic", "logic", "constant", "negation", "deletion", "early return"})
    with open(f"{source}/toy.c") as one, open(f"{source}/build/mutants/tree-0/toy.c") as other:
        check("the copy afterwards", other.read(), one.read())
    ran = subprocess.run([*command[:-3], str(COUNT + 1), "--minutes", "5"], capture_output=True, text=True)
    check("lines printed by a run that goes on", len(ran.stdout.splitlines()), 2)  # one mutant, and the sum
    return mutants


def check_report(mutants):
    loader = importlib.machinery.SourceFileLoader("report", f"{HERE}/report")
    report = importlib.util.module_from_spec(importlib.util.spec_from_loader("report", loader))
    loader.exec_module(report)
    check("interval of 80 of 98", [round(x) for x in report.wilson(80, 98)], [73, 88])
    kept = [mutant for mutant in mutants if mutant["verdict"] in ("killed", "survived")]
    lived = [mutant for mutant in kept if mutant["verdict"] == "survived"]
    page = report.measured(kept, {})
    check("survivors not judged", page.count("not judged"), len(lived))
    page = page.replace("not judged", "equivalent: x | y")
    check("judgements stay", report.measured(kept, report.judgements(page)).count("equivalent: x | y"), len(lived))


check_operators()
with tempfile.TemporaryDirectory() as scratch:
    check_report(check_toy(scratch))
print(f"mutants: {failures} of the checks failed")
sys.exit(failures != 0)
