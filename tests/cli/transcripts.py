#!/usr/bin/env python3
"""Runs the commands of a transcript again and compares what they say: transcripts.py FILE (tests/cli/transcripts.sh).

A line "$ COMMAND" is a command of a shell. What follows is its standard output, then its standard error with "! " before
each line, then "exit CODE" unless the code is 0. Text must be the same byte for byte. Numbers with a decimal point or an
exponent may differ by 1e-6 of themselves, because libraries of mathematics differ in last bits; the file keeps ten of
their digits. Times of a clock or a processor, and facts of the machine, are words such as TIME.

With CLAST_RENEW=1 the file is written anew. Read what `git diff` shows: each changed line is a changed answer.
"""
import os
import re
import subprocess
import sys

NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+(?:e[-+]?\d+)?|e[-+]?\d+)(?!\w)")
VOLATILE = [
    (re.compile(r"\d{4}-\d\d-\d\d[T ]\d\d:\d\d(:\d\d(\.\d+)?)?Z?"), "TIME"),
    (re.compile(r"in [\d.]+ (?:ms|s|min) \([\d.]+ (?:ms|s|min) of processor time"), "in TIME (TIME of processor time"),
    (re.compile(r"runs, about\s+[\d.]+ (?:ms|s|min)(?: \d+ s)?"), "runs, about TIME"),
    (re.compile(r"^(\s*\"(?:cpu_time|wall_time|cpu_s\w*|seconds|.*_cpu_s)\": )[-\d.e+]+", re.M), r"\1TIME"),
]


def short(match):
    return f"{float(match.group()):.10g}" if len(match.group()) > 12 else match.group()


def run(command):
    done = subprocess.run(["bash", "-c", command], capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=300)
    text = done.stdout + ("" if done.stdout.endswith("\n") or not done.stdout else "\n")
    text += "".join(f"! {line}\n" for line in done.stderr.splitlines() if not re.match(r"\s*\d+%  ", line))
    text += f"exit {done.returncode}\n" if done.returncode else ""
    for pattern, word in VOLATILE:
        text = pattern.sub(word, text)
    return NUMBER.sub(short, text)


def same(a, b):
    if a == b:
        return True
    x, y = NUMBER.findall(a), NUMBER.findall(b)
    return NUMBER.sub("#", a) == NUMBER.sub("#", b) and all(
        abs(float(p) - float(q)) <= 1e-6 * max(abs(float(p)), abs(float(q))) for p, q in zip(x, y))


def main():
    path = sys.argv[1]
    with open(path, encoding="utf-8") as file:
        parts = re.split(r"^(\$ .*\n)", file.read(), flags=re.M)
    out, changed = parts[0], 0
    for command, before in zip(parts[1::2], parts[2::2]):
        before, blank = (before[:-1], "\n") if before.endswith("\n\n") or before == "\n" else (before, "")
        now = run(command[2:])
        if not same(before, now):
            changed += 1
            old, new = before.splitlines(), now.splitlines()
            print(f"CHANGED: {command}", *(f"  pinned: {a}\n  now:    {b}\n" for a, b in zip(old + ["(nothing)"] * len(new), new + ["(nothing)"] * len(old))
                  if not same(a, b) and (a, b) != ("(nothing)",) * 2), sep="", end="")
            if changed == 10 and not os.environ.get("CLAST_RENEW"):
                sys.exit("10 commands changed; the others were not run")
        out += command + (before if same(before, now) else now) + blank
    if os.environ.get("CLAST_RENEW"):
        with open(path, "w", encoding="utf-8") as file:
            file.write(out)
        return
    print(f"{len(parts) // 2} commands, {changed} changed")
    sys.exit(bool(changed))


main()
