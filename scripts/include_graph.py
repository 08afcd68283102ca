#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Checks and prints the architecture of the library and of the trainer.

    scripts/include_graph.py                 # the folders in layers: each depends only on lower layers
    scripts/include_graph.py --check         # every rule of RULES; exit code 1 if one is violated
    scripts/include_graph.py --dot           # the folders as a Graphviz graph
    scripts/include_graph.py --tree          # the folders with one line about each
    scripts/include_graph.py --compare REV   # the folders at REV and now, and where each file went
"""
import argparse
import itertools
import os
import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import cpp_outline
from cpp_outline import blank, line_at

RULES = """\
1. No file includes itself through others.
2. The entries of a folder, its files and its subfolders, do not depend on each other in a cycle. An entry
   depends on another if a header of it includes a header of the other. Sources (.cpp, .cu) close no cycle,
   because nothing includes them.
3. The trainer uses no name and no header of warpagg::detail.
4. Sizes stay within LIMITS.
5. docs/contributing/architecture.md describes every top-level folder."""


@dataclass(frozen=True)
class Component:
    name: str
    root: str  # relative to the repository


LIBRARY = Component("library", "include/warpagg")
TRAINER = Component("trainer", "examples/gaussian_splatting")
COMPONENTS = (LIBRARY, TRAINER)

# The interface header of each door of the trainer.
DOORS = ("readers/reader.hpp", "losses/loss.hpp", "densify/strategy.hpp", "features/feature.hpp",
         "writers/writer.hpp")


@dataclass(frozen=True)
class Limits:
    lines_of_file: int = 500
    lines_of_door: int = 100
    lines_of_function: int = 60  # in the trainer
    virtual_functions_of_engine: int = 12  # apart from the destructor
    fields_of_step_plan: int = 6


LIMITS = Limits()
ARCHITECTURE = "docs/contributing/architecture.md"
SOURCES = (".hpp", ".cpp", ".cu")


@dataclass(frozen=True)
class Violation:
    file: str
    line: int
    sentence: str

    def __str__(self):
        return f"{self.file}:{self.line}: {self.sentence}"


# Includes

@dataclass(frozen=True)
class Include:
    line: int
    target: str  # relative to the repository


def is_forwarding(path):
    """Whether a header does nothing but include the header that replaces it."""
    return path.suffix == ".hpp" and re.fullmatch(
        r"\s*#include <warpagg/[^>]+>\s*", blank(path.read_text(), keep_strings=True)) is not None


def sources(repository, component):
    """Its files without forwarding headers, relative to the repository."""
    files = sorted(p for p in (repository / component.root).rglob("*") if p.suffix in SOURCES)
    return [str(p.relative_to(repository)) for p in files if not is_forwarding(p)]


def written_includes(text):
    """Line and path of each include."""
    pattern = re.compile(r'^[ \t]*#[ \t]*include[ \t]*[<"]([^>"\n]+)[>"]', re.MULTILINE)
    for match in pattern.finditer(blank(text, keep_strings=True)):
        yield line_at(text, match.start()), match.group(1)


def file_graph(repository, component):
    """What each file of the component includes of it."""
    names = set(sources(repository, component))
    graph = {}
    for name in sorted(names):
        graph[name] = []
        for line, path in written_includes((repository / name).read_text()):
            beside = os.path.normpath(os.path.join(os.path.dirname(name), path))
            below = [os.path.normpath(os.path.join(root, path)) for root in (component.root, "include")]
            target = next((t for t in (beside, *below) if t in names), None)
            if target is not None:
                graph[name].append(Include(line, target))
    return graph


def with_parents(folders):
    """The folders and all folders that they are in, sorted."""
    return sorted({"/".join(f.split("/")[:n]) for f in folders for n in range(1, f.count("/") + 2)})


def headers_only(files):
    return {name: [i for i in includes if i.target.endswith(".hpp")] for name, includes in files.items()
            if name.endswith(".hpp")}


def child(name, folder):
    """The entry of `folder` that is the file or contains it: `losses/loss.hpp`, `losses/l1_ssim/`. Or None."""
    if not name.startswith(folder + "/"):
        return None
    entry, *below = name[len(folder) + 1:].split("/")
    return f"{folder}/{entry}" + ("/" if below else "")


def levels(files):
    """For each folder, what its entries include of each other, with one place where they do."""
    result = {}
    for name, includes in files.items():
        for folder in with_parents([os.path.dirname(name)]):
            graph = result.setdefault(folder, {})
            targets = graph.setdefault(child(name, folder), {})
            for include in includes:
                target = child(include.target, folder)
                if target is not None and target != child(name, folder):
                    graph.setdefault(target, {})
                    targets.setdefault(target, (name, include.line))
    return dict(sorted(result.items()))


def shortest_cycle(graph, start):
    """The nodes of a cycle through `start`, or None."""
    before, level = {}, [start]
    while level:
        following = []
        for node in level:
            for target in graph[node]:
                if target == start:
                    path = [node]
                    while path[-1] != start:
                        path.append(before[path[-1]])
                    return path[::-1]
                if target not in before:
                    before[target] = node
                    following.append(target)
        level = following
    return None


def cycles(graph):
    """A shortest cycle through each node that is on one, each cycle once."""
    found = {}
    for node in sorted(graph):
        cycle = shortest_cycle(graph, node)
        if cycle is not None:
            found.setdefault(frozenset(cycle), cycle)
    return list(found.values())


def reachable(graph, start):
    """The nodes that `start` depends on, directly or not."""
    found, left = set(), [start]
    while left:
        new = set(graph[left.pop()]) - found
        found |= new
        left += new
    return found


def layers(graph):
    """The nodes in layers: each depends only on layers before its own, or on a node that depends on it."""
    reach = {node: reachable(graph, node) for node in graph}
    left, result = set(graph), []
    while left:
        result.append(sorted(n for n in left if not any(m in left and n not in reach[m] for m in reach[n])))
        left.difference_update(result[-1])
    return result


# Rules

def check_cycles(repository, component):
    files = file_graph(repository, component)
    for cycle in cycles({name: [i.target for i in includes] for name, includes in files.items()}):
        line = next(i.line for i in files[cycle[0]] if i.target == cycle[1 % len(cycle)])
        yield Violation(cycle[0], line, "This file includes itself: " + " -> ".join([*cycle, cycle[0]]) +
                        ". Remove one include.")
    for folder, graph in levels(headers_only(files)).items():
        for cycle in cycles(graph):
            if not any(entry.endswith("/") for entry in cycle):
                continue  # files, and reported above
            places = [graph[a][b] for a, b in zip(cycle, [*cycle[1:], cycle[0]])]
            entries = [entry[len(folder) + 1:] for entry in [*cycle, cycle[0]]]
            yield Violation(*places[0], f"Entries of {folder}/ depend on each other: {' -> '.join(entries)}, by " +
                            ", ".join(f"{name[len(folder) + 1:]}:{line}" for name, line in places) +
                            ". Move what they share into a folder that none of them contains.")


def check_detail(repository):
    for name in sources(repository, TRAINER):
        text = (repository / name).read_text()
        code = blank(text)
        for match in re.finditer(r"\bwarpagg\s*::\s*(?:\w+\s*::\s*)*detail\b", code):
            yield Violation(name, line_at(code, match.start()),
                            "The trainer uses warpagg::detail, which may change. Use a public name.")
        for line, path in written_includes(text):
            if re.match(r"warpagg/(?:\w+/)*detail/", path):
                yield Violation(name, line, f"The trainer includes {path}, which may change. "
                                            "Include a public header.")


def check_files(repository):
    for component in COMPONENTS:
        for name in sources(repository, component):
            lines = len((repository / name).read_text().splitlines())
            if lines > LIMITS.lines_of_file:
                yield Violation(name, LIMITS.lines_of_file + 1,
                                f"The file has {lines} lines; the limit is {LIMITS.lines_of_file}. Split it.")
    for door in DOORS:
        path = repository / TRAINER.root / door
        if not path.exists():
            yield Violation(f"{TRAINER.root}/{door}", 1, "The interface header of this door does not exist.")
        elif (lines := len(path.read_text().splitlines())) > LIMITS.lines_of_door:
            yield Violation(f"{TRAINER.root}/{door}", LIMITS.lines_of_door + 1,
                            f"The interface has {lines} lines; the limit is {LIMITS.lines_of_door}. "
                            "Move helpers into another header.")


def check_functions(repository):
    for name in sources(repository, TRAINER):
        try:
            defined = cpp_outline.functions((repository / name).read_text())
        except ValueError as problem:
            yield Violation(name, 1, f"The braces of this file do not match ({problem}).")
            continue
        for function in defined:
            if function.lines > LIMITS.lines_of_function:
                yield Violation(name, function.line,
                                f"The function {function.name} has {function.lines} lines; "
                                f"the limit is {LIMITS.lines_of_function}. Split it.")


def check_engine(repository):
    rules = (
        ("class engine", cpp_outline.virtual_functions, LIMITS.virtual_functions_of_engine, "virtual functions"),
        ("struct step_plan", cpp_outline.fields, LIMITS.fields_of_step_plan, "fields"),
    )
    headers = [name for name in sources(repository, TRAINER) if name.endswith(".hpp")]
    for declaration, count, limit, noun in rules:
        for name in headers:
            text = (repository / name).read_text()
            found = cpp_outline.body_of(text, declaration)
            if found is None:
                continue
            if (number := count(found[1])) > limit:
                yield Violation(name, line_at(text, found[0]),
                                f"The {declaration} has {number} {noun}; the limit is {limit}. Move some out.")
            break
        else:
            yield Violation(TRAINER.root, 1, f"No header declares {declaration}. Correct this rule.")


def check_descriptions(repository):
    described = descriptions(repository)
    for component in COMPONENTS:
        below = {name[len(component.root) + 1:] for name in sources(repository, component)}
        for entry in sorted({name.split("/")[0] for name in below if "/" in name}):
            if f"{component.root}/{entry}" not in described:
                yield Violation(ARCHITECTURE, 1, f"No table describes {component.root}/{entry}/. Add a row.")
    for name, (line, _) in described.items():
        if not (repository / name).is_dir():
            yield Violation(ARCHITECTURE, line, f"The folder {name}/ does not exist. Remove its row.")


def check(repository):
    """All violations."""
    found = [v for component in COMPONENTS for v in check_cycles(repository, component)]
    for rule in (check_detail, check_files, check_functions, check_engine, check_descriptions):
        found += rule(repository)
    return found


# Output

def descriptions(repository):
    """Line and text about each folder that the page on the architecture has a row for."""
    path = repository / ARCHITECTURE
    rows = {}
    if path.exists():
        for number, line in enumerate(path.read_text().splitlines(), 1):
            row = re.match(r"\| \[`[^`]*`\]\(\.\./\.\./([^)]+?)/?\) \| ([^|]+?) \|", line)
            if row:
                rows[row.group(1)] = number, row.group(2)
    return rows


def about(repository, name, described):
    """One line about a folder: from the page on the architecture, or from what is named after the folder."""
    if name in described:
        return described[name][1]
    subject = rf"(?:\w+_)?{re.escape(os.path.basename(name))}(?:_\w+)?"
    pattern = re.compile(r"((?:^///[^\n]*\n)+)(?:template [^\n]*\n)?(?:class|struct|extern const \w+) " +
                         subject + r"\b", re.MULTILINE)
    for header in sorted((repository / name).glob("*.hpp"), key=lambda p: len(p.name)):
        if match := pattern.search(header.read_text()):
            words = " ".join(line[3:].strip() for line in match.group(1).splitlines())
            return re.split(r"(?<=\.)(?<!et al\.) ", words)[0]
    return ""


def print_layers(repository, component):
    files = file_graph(repository, component)
    for folder, graph in levels(headers_only(files)).items():
        if not folder.startswith(component.root) or not any(entry.endswith("/") for entry in graph):
            continue
        print(f"{folder}/")
        for number, layer in enumerate(layers(graph)):
            for entry in layer:
                used = ", ".join(sorted(name[len(folder) + 1:] for name in graph[entry]))
                print(f"  {number}  {entry[len(folder) + 1:]}" + (f" -> {used}" if used else ""))


def print_dot(repository):
    print("digraph folders {\n  rankdir=BT; node [shape=box];")
    for component in COMPONENTS:
        files = headers_only(file_graph(repository, component))
        edges = {(os.path.dirname(name), os.path.dirname(i.target))
                 for name, includes in files.items() for i in includes}
        print(f'  subgraph "cluster_{component.name}" {{ label="{component.root}";')
        for name in sorted({os.path.dirname(name) for name in files}):
            print(f'    "{name}" [label="{os.path.relpath(name, component.root)}"];')
        for a, b in sorted(edges):
            if a != b:
                print(f'    "{a}" -> "{b}";')
        print("  }")
    print("}")


def print_tree(repository):
    described = descriptions(repository)
    for component in COMPONENTS:
        print(f"{component.root}/")
        for name in with_parents(os.path.dirname(f) for f in sources(repository, component)):
            if name.startswith(component.root + "/"):
                label = "  " * (name.count("/") - component.root.count("/")) + os.path.basename(name) + "/"
                print(f"{label:<24}{about(repository, name, described)}".rstrip())


def git(repository, *arguments):
    return subprocess.run(["git", "-C", str(repository), *arguments], capture_output=True, text=True,
                          check=True).stdout.splitlines()


def renames(repository, revision):
    """Where each file of the revision is now, or None, as its commits moved it."""
    now = {name: name for name in git(repository, "ls-tree", "-r", "--name-only", revision)}
    origin = dict(now)  # by present name
    log = git(repository, "log", "--reverse", "--topo-order", "--no-merges", "-M", "--name-status",
              "--format=", f"{revision}..HEAD")
    for status, *paths in (line.split("\t") for line in log if line):
        if status.startswith("R") and paths[0] in origin:
            origin[paths[1]] = origin.pop(paths[0])
            now[origin[paths[1]]] = paths[1]
        elif status == "D" and paths[0] in origin:
            now[origin.pop(paths[0])] = None
    return now


def print_compare(repository, revision):
    roots = ("include/", "examples/", "tests/", "bench/")
    old = {n: t for n, t in renames(repository, revision).items() if n.startswith(roots)}
    new = [n for n in git(repository, "ls-tree", "-r", "--name-only", "HEAD") if n.startswith(roots)]

    def outline(names):
        counts = {}
        for name in names:
            counts[os.path.dirname(name)] = counts.get(os.path.dirname(name), 0) + 1
        return ["  " * f.count("/") + os.path.basename(f) + "/" + (f" {counts[f]}" if f in counts else "")
                for f in with_parents(counts)]

    print(f"Folders with their number of files, at {revision} and now:\n")
    for left, right in itertools.zip_longest(outline(old), outline(new), fillvalue=""):
        print(f"{left:<52}{right}".rstrip())
    print("\nMoved files:\n")
    moved = sorted((os.path.dirname(a), os.path.dirname(b), a, b) for a, b in old.items()
                   if b not in (None, a))
    for (before, after), group in itertools.groupby(moved, key=lambda m: m[:2]):
        print(f"{before}/ -> {after}/")
        for _, _, a, b in group:
            first, last = os.path.basename(a), os.path.basename(b)
            print(f"    {first}" + (f" -> {last}" if first != last else ""))
    print("\nRemoved files:\n")
    print("\n".join(f"    {name}" for name in sorted(n for n, t in old.items() if t is None)))
    print("\nNew files:\n")
    print("\n".join(f"    {name}" for name in sorted(set(new) - set(old.values()))))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0], epilog="Rules:\n" + RULES,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", type=Path, default=Path(__file__).resolve().parent.parent,
                        help="the repository (default: the one that contains this script)")
    action = parser.add_mutually_exclusive_group()
    action.add_argument("--check", action="store_true",
                        help="print each violation of a rule; exit code 1 if any")
    action.add_argument("--dot", action="store_true", help="print the folders as a Graphviz graph")
    action.add_argument("--tree", action="store_true", help="print the folders with one line about each")
    action.add_argument("--compare", metavar="REV",
                        help="print the folders at a revision and now, and moved files")
    options = parser.parse_args()
    if options.check:
        found = check(options.root)
        for violation in found:
            print(violation)
        return 1 if found else 0
    if options.dot:
        print_dot(options.root)
    elif options.tree:
        print_tree(options.root)
    elif options.compare:
        print_compare(options.root, options.compare)
    else:
        for component in COMPONENTS:
            print_layers(options.root, component)
    return 0


if __name__ == "__main__":
    sys.exit(main())
