#!/usr/bin/python3 -IS
"""Doxygen's input filter: prints a header whose comments Doxygen reads.

A block of // lines above a declaration, and a comment behind a member, become documentation; the first block that stands alone
is the file's. Comments within functions stay what they are. Indented lines are formulas and tables, printed as they stand.
"""

import re
import sys
from pathlib import Path

# What opens a scope whose members are documented; else a brace opens a function or an initializer.
SCOPE = re.compile(r"(?:inline )?(?:namespace|class|struct|union|enum)\b")


def code_of(line):
    """The line without strings, characters and comments."""
    line = re.sub(r'"(?:\\.|[^"\\])*"', '""', line)
    line = re.sub(r"(?<![0-9a-fA-F])'(?:\\.|[^'\\])'", "' '", line)
    return line.partition("//")[0]


def without_template(statement):
    """Without "template <...>" and attributes before it."""
    statement = re.sub(r"\[\[.*?\]\]", "", statement).strip()
    while statement.startswith("template"):
        depth, start = 0, statement.find("<")
        for place in range(start, len(statement)):
            depth += {"<": 1, ">": -1}.get(statement[place], 0)
            if depth == 0:
                break
        statement = statement[place + 1 :].strip()
    return statement


class Scopes:
    """Which braces are open."""

    def __init__(self):
        self.open, self.statement = [], ""

    def documented(self):
        return all(self.open)

    def between_statements(self):
        return not self.statement.strip()

    def read(self, code):
        if code.lstrip().startswith("#"):
            return
        for letter in code + " ":
            if letter == "{":
                self.open.append(bool(SCOPE.match(without_template(self.statement))))
            elif letter == "}" and self.open:
                self.open.pop()
            self.statement = "" if letter in "{};" else self.statement + letter
        if re.fullmatch(r"\s*(public|private|protected):\s*", self.statement):
            self.statement = ""


def escaped(text):
    return re.sub(r"`([^`]+)`", r"<code>\1</code>", re.sub(r"([\\@<>&#%\"])", r"\\\1", text))


def documentation(lines):
    """The text of a comment as Doxygen's lines."""
    listed = verbatim = False
    for line in lines:
        indented = line.startswith("  ") and not listed
        if indented != verbatim and (line or verbatim):
            # An empty line ends the brief description, which else goes on to a full stop in the formula.
            yield from ("", "\\verbatim") if indented else ("\\endverbatim", "")
            verbatim = indented
        listed = line.startswith("- ") or (listed and line.startswith("  "))
        yield line if verbatim else escaped(line)
    if verbatim:
        yield "\\endverbatim"


def filtered(lines):
    scopes, file_seen, place = Scopes(), False, 0
    while place < len(lines):
        line = lines[place]
        indent = line[: len(line) - len(line.lstrip())]
        if line.lstrip().startswith("//"):
            end = place
            while end < len(lines) and lines[end].lstrip().startswith("//"):
                end += 1
            block = [text.strip().lstrip("/").removeprefix(" ") for text in lines[place:end]]
            alone = end == len(lines) or not lines[end].strip()
            if alone and not file_seen and not scopes.open:
                file_seen = True
                yield "/// \\file"
                yield "///"
                yield from (f"/// {text}" for text in documentation(block))
            elif not alone and scopes.documented() and scopes.between_statements():
                yield from (f"{indent}/// {text}" for text in documentation(block))
            else:
                yield from lines[place:end]
            place = end
            continue
        code = code_of(line)
        inside = scopes.documented()
        scopes.read(code)
        if inside and scopes.documented() and re.search(r"[;,\w]\s*$", code) and line.rstrip() != code.rstrip():
            before, _, text = line.partition("//")
            yield f"{before}///< {escaped(text.strip())}"
        else:
            yield line
        place += 1


if __name__ == "__main__":
    print("\n".join(filtered(Path(sys.argv[1]).read_text().splitlines())))
