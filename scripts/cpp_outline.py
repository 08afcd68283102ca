# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Finds the functions, virtual functions and data members in C++ text that clang-format has laid out.

It counts braces instead of parsing. Macros that open or close a scope are not supported.
"""
import re
from dataclasses import dataclass


def blank(text, keep_strings=False):
    """The text with comments, and unless kept strings, replaced by spaces. Lines keep their numbers."""
    pattern = re.compile(r'//[^\n]*|/\*.*?\*/|R"(?P<delimiter>[^(\s]*)\(.*?\)(?P=delimiter)"'
                         r'|"(?:\\.|[^"\\\n])*"|(?<![0-9A-Za-z_])\'(?:\\.|[^\'\\\n])*\'', re.DOTALL)

    def spaces(match):
        if keep_strings and not match.group().startswith("/"):
            return match.group()
        return re.sub(r"[^\n]", " ", match.group())

    return pattern.sub(spaces, text)


def line_at(text, position):
    return text.count("\n", 0, position) + 1


def matching_brace(code, opening):
    """The position of the brace that closes the one at `opening`, or None."""
    depth = 0
    for match in re.compile(r"[{}]").finditer(code, opening):
        depth += 1 if match.group() == "{" else -1
        if depth == 0:
            return match.start()
    return None


def without_groups(text):
    """The text without whatever stands in parentheses, brackets and braces: `f(a[1]) {}` becomes `f() {}`."""
    short = {"(": "\1", "[": "\2", "{": "\3"}
    innermost = re.compile(r"\([^()\[\]{}]*\)|\[[^()\[\]{}]*\]|\{[^()\[\]{}]*\}")
    while (shorter := innermost.sub(lambda m: short[m.group()[0]], text)) != text:
        text = shorter
    return text.replace("\1", "()").replace("\2", "[]").replace("\3", "{}")


def without_template_lists(head):
    """The text without `template <...>` at its beginning, and how many characters that were."""
    skipped = 0
    while match := re.match(r"\s*(?:[A-Z][A-Z_]{3,}\s+)*template\s*<", head[skipped:]):
        position, angles, parentheses = skipped + match.end(), 1, 0
        while position < len(head) and angles > 0:
            character = head[position]
            parentheses += (character == "(") - (character == ")")
            if parentheses == 0:
                angles += (character == "<") - (character == ">")
            position += 1
        skipped = position
    macro = re.match(r"\s*(?:WARPAGG_EXEC_CHECK_DISABLE\s+)?", head[skipped:])
    return head[skipped + macro.end():], skipped + macro.end()


NOT_NAMES = r"\b(?:requires|decltype|alignas|noexcept|explicit|__attribute__|__launch_bounds__)\s*\(\)"


def function_name(signature):
    """The name before the first parameter list, or None."""
    match = re.search(r"(operator\s*(?:\(\)|[^\s(]+)|~?\w+)\s*\(\)",
                      re.sub(NOT_NAMES, " ", without_groups(signature)))
    return match.group(1) if match else None


def kind_of_brace(head):
    """What an opening brace begins after `head`, the text of its declaration so far."""
    flat = without_groups(without_template_lists(head)[0]).strip()
    if re.match(r"(?:inline\s+)?namespace\b|extern$", flat):
        return "scope"
    if re.search(r"(?:=|&&|\|\||\brequires)\s*requires\s*(?:\(\))?$", flat):
        return "value"  # a requires-expression
    flat = re.sub(NOT_NAMES, " ", flat).strip()
    if re.search(r"\b(?:class|struct|union|enum)\b[^()]*$", flat):
        return "scope"
    if re.search(r"(?<![=!<>+\-*/|&^])=(?!=)", flat) and not re.search(r"\boperator\b", flat):
        return "value"
    if function_name(head) is None:
        return "value"
    in_initializers = re.search(r"(?<!:):(?!:)", flat[flat.index("()"):])
    if in_initializers and re.search(r"[\w>]$", flat):
        return "value"  # `member{...}` in the list of initializers
    return "function"


@dataclass(frozen=True)
class Function:
    name: str
    line: int
    lines: int


def functions(text):
    """The functions that the text defines, members included. Lambdas belong to the function around them."""
    code = re.sub(r"^[ \t]*#(?:[^\n\\]|\\.|\\\n)*", lambda m: re.sub(r"[^\n]", " ", m.group()), blank(text),
                  flags=re.MULTILINE)
    found, begin, position, scopes = [], 0, 0, 0
    delimiter = re.compile(r"[;{}]")
    while match := delimiter.search(code, position):
        position = match.end()
        head = re.sub(r"\b(?:public|private|protected)\s*:(?!:)", lambda m: " " * len(m.group()),
                      code[begin:match.start()])
        if match.group() == ";" and head.count("(") > head.count(")"):
            continue
        if match.group() == ";":
            begin = position
        elif match.group() == "}":
            scopes -= 1
            if scopes < 0:
                raise ValueError(f"line {line_at(code, match.start())}: closing brace without opening brace")
            begin = position
        else:
            kind = "value" if head.count("(") > head.count(")") else kind_of_brace(head)
            if kind == "scope":
                scopes += 1
                begin = position
                continue
            end = matching_brace(code, match.start())
            if end is None:
                raise ValueError(f"line {line_at(code, match.start())}: opening brace without closing brace")
            position = end + 1
            if kind == "function":
                signature, skipped = without_template_lists(head)
                start = begin + skipped + len(signature) - len(signature.lstrip())
                first, last = line_at(code, start), line_at(code, end)
                found.append(Function(function_name(signature), first, last - first + 1))
                begin = position
    return found


def body_of(text, declaration):
    """Position and text of the braces of a class, without what stands in braces within; or None."""
    code = blank(text)
    match = re.search(declaration + r"\b[^;{]*\{", code)
    if match is None:
        return None
    end = matching_brace(code, match.end() - 1)
    body = code[match.end():end]
    while (flat := re.sub(r"\{[^{}]*\}", "", body)) != body:
        body = flat
    return match.start(), body


def virtual_functions(body):
    return len(re.findall(r"\bvirtual\b(?!\s*~)", body))


def fields(body):
    """How many data members a class without constructors has."""
    count = 0
    for declaration in without_groups(body).split(";"):
        while (flat := re.sub(r"<[^<>]*>|=[^,<>]*", "", declaration)) != declaration:
            declaration = flat
        if declaration.strip() and "()" not in declaration and \
                not re.match(r"\s*(?:using|static|friend)\b", declaration):
            count += 1 + declaration.count(",")
    return count
