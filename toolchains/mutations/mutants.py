# SPDX-License-Identifier: Apache-2.0
"""Mutants of a C++ source: the same file with one guard removed or turned round. Found by their text, not by a compiler:
what does not compile is left out by who tries them."""
import re
from dataclasses import dataclass

COMMENT_OR_TEXT = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', re.DOTALL)
DIRECTIVE = re.compile(r"^[ \t]*(?:#|static_assert|template|extern|using|return 0;).*$", re.MULTILINE)
OPPOSITE = {"<": ">=", ">=": "<", ">": "<=", "<=": ">", "==": "!=", "!=": "=="}
COMPARISON = re.compile(r" (<=|>=|<|>|==|!=) ")
CONDITION = re.compile(r"\b(?:if|while) (\()")
CONNECTION = re.compile(r"&&|\|\|")
NOT = re.compile(r"!(?=[\w(])")
CHOICE = re.compile(r"(?<!\?)\s\? ")
CALL = re.compile(r"(?<=[;{}\n])[ \t]*((?:this->)?[a-z][\w.]*\([^;{}]*\);)[ \t]*(?=\n)")
LIMITED = re.compile(r"\b(?:[\w]+::)*(bounded|clamp)(\()")


@dataclass(frozen=True)
class Mutant:
    path: str
    line: int
    was: str  # the lines that change
    now: str
    text: str  # of the whole file

    @property
    def name(self):
        """Stays the same where lines are added elsewhere in the file."""
        return f"{self.path}: {self.was}  =>  {self.now}"


def code_of(text):
    """The text with comments, strings and directives blanked: every place keeps its offset."""
    def blank(match):
        return re.sub(r"[^\n]", " ", match[0])
    return DIRECTIVE.sub(blank, COMMENT_OR_TEXT.sub(blank, text))


def closing(code, opening):
    depth = 0
    for place in range(opening, len(code)):
        depth += {"(": 1, "[": 1, "{": 1, ")": -1, "]": -1, "}": -1}.get(code[place], 0)
        if depth == 0:
            return place
    return None


def ends_operand(code, place, of_or):
    """Whether an operand of && (or of ||) cannot reach over `place`."""
    around = code[place - 1:place + 2]
    if "||" in around or ("&&" in around and not of_or):
        return True
    is_assignment = code[place] == "=" and code[place - 1] not in "<>=!" and code[place + 1] != "="
    is_colon = code[place] == ":" and ":" not in (code[place - 1], code[place + 1])
    return is_assignment or is_colon or code[place] in ";,?" or code[place - 7:place] == " return"


def end_of_operand(code, start, step, of_or):
    """The offset at which the operand ends that begins at `start`, read forwards (step 1) or backwards (step -1)."""
    inner, outer = ("([{", ")]}") if step > 0 else (")]}", "([{")
    depth = 0
    place = start
    while 0 < place < len(code) - 1:
        if depth == 0 and (code[place] in outer or ends_operand(code, place, of_or)):
            return place
        depth += (code[place] in inner) - (code[place] in outer)
        place += step
    return None


def operands(code):
    """Each operand of a && or ||, as (first, last + 1, what leaves the rest as it is)."""
    found = set()
    for match in CONNECTION.finditer(code):
        of_or = match[0] == "||"
        neutral = "false" if of_or else "true"
        left = end_of_operand(code, match.start() - 2, -1, of_or)
        right = end_of_operand(code, match.end() + 1, 1, of_or)
        if left is not None and right is not None:
            found |= {(left + 1, match.start(), neutral), (match.end(), right, neutral)}
    return found


def conditions(code):
    """The whole condition of each if, loop and choice, as (first, last + 1, may be made true)."""
    found = set()
    for match in CONDITION.finditer(code):
        end = closing(code, match.start(1))
        if end is not None:
            found.add((match.start(1) + 1, end, code[match.start()] == "i"))
    for match in CHOICE.finditer(code):
        left = end_of_choice(code, match.start() - 1)
        if left is not None:
            found.add((left + 1, match.start(), True))
    return found


def end_of_choice(code, start):
    """Where the condition before a ? begins: it may hold && and ||."""
    depth = 0
    for place in range(start, 7, -1):
        around = code[place - 1:place + 2]
        is_connection = "||" in around or "&&" in around
        if depth == 0 and (code[place] in "([{" or (not is_connection and ends_operand(code, place, True))):
            return place
        depth += (code[place] in ")]}") - (code[place] in "([{")
    return None


def edits(code):
    """Each change as (first, last + 1, new text). A comparison or a "not" inside a condition is not turned round as well:
    what fails without it, and what fails where the condition is always or never so, fails then, too."""
    parts = operands(code)
    wholes = conditions(code)
    found = set(parts)
    for first, last, may_be_true in wholes:
        found |= {(first, last, new) for new in (("true", "false") if may_be_true else ("false",))}
    inside = [(first, last) for first, last, _ in parts | wholes]

    def stands_alone(match):
        return not any(first <= match.start() < last for first, last in inside)

    found |= {(m.start(1), m.end(1), OPPOSITE[m[1]]) for m in COMPARISON.finditer(code) if stands_alone(m)}
    found |= {(m.start(), m.end(), "") for m in NOT.finditer(code) if stands_alone(m)}
    found |= {(m.start(1), m.end(1), ";") for m in CALL.finditer(code)}
    for match in LIMITED.finditer(code):
        found |= unlimited(code, match)
    return found


def unlimited(code, match):
    """bounded(parameters, x) and clamp(x, low, high) without their bounds."""
    end = closing(code, match.start(2))
    if end is None:
        return set()
    arguments, depth, first = [], 0, match.start(2) + 1
    for place in range(first, end + 1):
        if (code[place] == "," and depth == 0) or place == end:
            arguments.append(code[first:place].strip())
            first = place + 1
        depth += (code[place] in "([{") - (code[place] in ")]}")
    kept = {("bounded", 2): 1, ("clamp", 3): 0}.get((match[1], len(arguments)))
    return set() if kept is None else {(match.start(), end + 1, f"({arguments[kept]})")}


def lines_around(text, first, last):
    begin = text.rfind("\n", 0, first) + 1
    end = text.find("\n", last)
    return begin, len(text) if end < 0 else end


def mutants_of(path, text):
    """All mutants of a file, in the order of its lines."""
    code = code_of(text)
    made = {}
    for first, last, new in sorted(edits(code)):
        while text[first].isspace():
            first += 1
        while text[last - 1].isspace():
            last -= 1
        changed = text[:first] + new + text[last:]
        begin, end = lines_around(text, first, last)
        was = " ".join(text[begin:end].split())
        now = " ".join((text[begin:first] + new + text[last:end]).split())
        if was != now and changed not in made:
            made[changed] = Mutant(path, text.count("\n", 0, first) + 1, was, now, changed)
    return list(made.values())
