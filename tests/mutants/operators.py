"""Mutations of one line of C: which changes are possible, and what the line becomes. Text only; nothing is compiled.

The code is formatted by clang-format: binary operators have spaces on both sides, and a function begins with a line
in column 0 that ends with ") {" and ends with "}" in column 0.
"""
import re

RELATIONS = {"<": ("<=", ">"), "<=": ("<", ">"), ">": (">=", "<"), ">=": (">", "<"), "==": ("!=",), "!=": ("==",)}
ARITHMETIC = {"+": "-", "-": "+", "*": "/", "/": "*", "%": "*", "+=": "-=", "-=": "+=", "*=": "/=", "/=": "*="}
LOGIC = {"&&": "||", "||": "&&"}
NUMBER = re.compile(r"(?<![\w.])(0[xX][0-9a-fA-F]+|\d+\.?\d*(?:[eE][+-]?\d+)?|\.\d+(?:[eE][+-]?\d+)?)([uUlLfF]*)(?![\w.])")
LEAST_BUFFER = 16  # A number in brackets from here on is the size of a buffer: one more or less changes nothing.


def masked(text):
    """The text with comments, strings, characters and preprocessor lines blanked. Columns and lines stay."""
    def blank(match):
        return re.sub(r"[^\n]", " ", match.group())
    text = re.sub(r'/\*.*?\*/|//[^\n]*|"(?:[^"\\\n]|\\.)*"|\'(?:[^\'\\\n]|\\.)*\'', lambda m: blank(m) if m.group()[0] == "/"
                  else m.group()[0] + blank(m)[1:-1] + m.group()[0], text, flags=re.S)
    return re.sub(r"^[ \t]*#(?:[^\n]*\\\n)*[^\n]*", blank, text, flags=re.M)


def replaced(line, start, end, new):
    return line[:start] + new + line[end:]


def numbers(line, code):
    for match in NUMBER.finditer(code):
        number, suffix = match.groups()
        in_brackets = code[: match.start()].endswith("[") and code[match.end():].startswith("]")
        if re.fullmatch(r"\d+|0[xX]\w+", number):
            value = int(number, 0 if number[:2] in ("0x", "0X") else 10)
            if in_brackets and value >= LEAST_BUFFER:
                continue
            news = {0: ["1"], 1: ["0", "2"]}.get(value, [str(value + 1), "0"])
            news = [new + suffix for new in news]
        elif float(number) == 0:
            news = ["1.0" + suffix]
        else:
            news = [f"(2 * {number}{suffix})", f"(0.5{'f' if suffix else ''} * {number}{suffix})"]
        for new in news:
            yield "constant", replaced(line, match.start(), match.end(), new)


def symbols(line, code):
    for match in re.finditer(r"(?<= )(<=|>=|==|!=|<|>|&&|\|\||[-+*/]=|[-+*/%])(?= |$)", code):
        old = match.group()
        kind = "relation" if old in RELATIONS else "logic" if old in LOGIC else "arithmetic"
        for new in RELATIONS.get(old) or ((LOGIC if kind == "logic" else ARITHMETIC)[old],):
            yield kind, replaced(line, match.start(), match.end(), new)


def negations(line, code):
    for match in re.finditer(r"\b(?:if|while) \(", code):
        depth, end = 1, match.end()
        while end < len(code) and depth:
            depth += {"(": 1, ")": -1}.get(code[end], 0)
            end += 1
        if depth == 0:
            yield "negation", replaced(line, match.end(), end - 1, f"!({line[match.end():end - 1]})")


def statements(line, code, before):
    """Of a line that is a whole statement, before being the line of code before it."""
    bare = code.strip()
    if not bare.endswith(";") or "{" in bare or "}" in bare or bare == ";" or re.match(r"(if|for|while|else|do|case|default)\b", bare):
        return
    if any(bare.count(a) != bare.count(b) for a, b in ("()", "[]")) or not re.search(r"([;{}):]|\belse)$", before):
        return
    indent = line[: len(line) - len(line.lstrip())]
    branch = re.search(r"(\)|\belse)$", before)
    if not bare.startswith("return "):  # without its value a function answers what a register happens to hold
        yield "deletion", indent + ";"
    yield "early return", indent + "return 0;" + ("" if branch else " " + line.strip())


def mutations(text):
    """(line number from 1, [(operator, new line), ...]) of every line that has a mutation."""
    lines, code, inside, before = text.split("\n"), masked(text).split("\n"), False, ""
    found = []
    for number, (line, bare) in enumerate(zip(lines, code), 1):
        changes = [*symbols(line, bare), *numbers(line, bare), *negations(line, bare)]
        if inside:
            changes += statements(line, bare, before)
        if re.match(r"[A-Za-z].*\) \{$|\{$|[ A-Za-z].*\) \{$", bare) and not inside:
            inside = True
        elif bare.startswith("}"):
            inside = False
        before = bare.rstrip() or before
        if changes:
            found.append((number, changes))
    return found
