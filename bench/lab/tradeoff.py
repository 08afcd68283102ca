#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""What accuracy costs in training, for one scene: held-out PSNR against time for each option that trades one for the
other, alone and then those together that pay; the Pareto front, and the command line of each point on it.

    bench/lab/tradeoff.py run --program build/bench/bench/lab/lab --data SCENE --seeds 0 1 2 \\
        --output tradeoff.json -- -i 7000 --device cuda
    bench/lab/tradeoff.py table tradeoff.json
    bench/lab/tradeoff.py plot tradeoff.json tradeoff.svg          # needs matplotlib

SCENE is a folder or synthetic:NAME[,PARAMETER=VALUE...]; the options after -- are those of every run. The program is
the lab's, since some knobs are its options --gradient and --accumulate. All knobs of a seed take turns, and times are
beside the default's of the same seed. --kernels adds what bench/lab/kernel_knobs.py has built. A knob pays if it reaches
more PSNR than more or fewer iterations do in the time it takes. "again" is the default once more: what differs between
the two is noise.
"""
import argparse
import json
import math
import pathlib
import re
import shlex
import statistics
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))  # bench
from environment import environment, own_and_passed_on  # noqa: E402
from markdown_tables import markdown  # noqa: E402
from lab import kernel_knobs  # noqa: E402
from scenes import by, spread, where  # noqa: E402
from train import add_run, measure  # noqa: E402

DEFAULT, AGAIN, HALF, DOUBLE = "default", "again", "half", "double"
MOST_TOGETHER = 4
# Pairs of options that the trainer refuses, or of which one implies the other.
EXCLUDES = {"--gradient": {"--accumulate", "--deterministic"}, "--deterministic": {"--accumulate"},
            "--budget": {"--densify-grad-threshold"}, "--quality": {"--sh-lr"}}


def parsed(words):
    """The values of each option, by its name."""
    options = {}
    for word in words:
        if re.match("--?[a-z]", word):
            name, _, value = word.partition("=")
            name = "-i" if name == "--iterations" else name.replace("_", "-")
            options[name] = [value] if value else []
        elif options:
            options[next(reversed(options))].append(word)
        else:
            raise SystemExit(f"'{word}' follows no option")
    return options


def words(options):
    return [word for name, values in options.items() for word in (name, *values)]


def knobs(n):
    """By name, the options of each for runs of about n iterations."""
    accumulate = {way: f"--accumulate {way}" for way in ("f64", "compensated", "fixed", "binned", "exact")}
    lines = {AGAIN: "", **accumulate, "deterministic": "--deterministic",
             HALF: f"-i {max(n // 2, 1)}", DOUBLE: f"-i {2 * n}",
             "no direction": "--sh-degree 0", "degree 2": "--sh-degree 2",
             "direction every 4th": "--sh-update-interval 4", "direction faster": "--sh-lr 5e-4",
             "direction later": "--sh-degree-interval 1000", "not coarse to fine": "--num-downscales 0",
             "grow less": "--densify-grad-threshold 2e-4", "grow more": "--densify-grad-threshold 6e-5",
             "not pruned": "--prune-share 0", "pruned more": "--prune-share 0.4", "opacity not shared": "--no-revised-opacity",
             "fast": f"--quality fast -i {max(n * 5 // 7, 1)}"}
    return {name: parsed(line.split()) for name, line in lines.items()}


def excluded(one, other):
    return any(EXCLUDES.get(a, set()) & set(y) for x, y in ((one, other), (other, one)) for a in x)


def together(names, n):
    """Those of `names`, the best first, that can be had at once: two, three and more, and all in half and twice the time."""
    known, chosen, merged = knobs(n), [], {}
    for name in names:
        if len(chosen) < MOST_TOGETHER and not set(merged) & set(known[name]) and not excluded(merged, known[name]):
            chosen.append(name)
            merged.update(known[name])
    merge = lambda some, length: {k: v for name in some for k, v in knobs(length)[name].items()}
    found = {" + ".join(chosen[:k]): merge(chosen[:k], n) for k in range(2, len(chosen) + 1)}
    for name, length in ((HALF, max(n // 2, 1)), (DOUBLE, 2 * n)) if chosen else ():
        found[" + ".join([*chosen, name])] = {"-i": [str(length)], **merge(chosen, length)}
    return found


def turns(arguments, common, some, programs={}):
    """Runs by default and by each knob in `some`, and how their times stand to the default's of the same seed."""
    configurations = {name: words({**common, **own}) for name, own in {DEFAULT: {}, **some}.items()}
    runs = measure(arguments, configurations, programs)
    seconds = {r["seed"]: r["seconds"]["train"] for r in runs if r["options"] == DEFAULT}
    return [{**r, "ratio": r["seconds"]["train"] / seconds[r["seed"]],
             "milliseconds_per_iteration": 1000 / r["iterations_per_second"]} for r in runs]


def after_that_time(lengths, ratio):
    """The PSNR of runs that are only shorter or longer, at a time between theirs; None if they do not say."""
    ends = sorted((math.log(p["ratio"]), p["psnr"]) for p in lengths)
    if len(ends) < 3 or len({x for x, _ in ends}) < 3 or not ends[0][0] <= math.log(ratio) <= ends[2][0]:
        return None
    (x0, y0), (x1, y1) = ends[:2] if math.log(ratio) < ends[1][0] else ends[1:]
    return y0 + (y1 - y0) * (math.log(ratio) - x0) / (x1 - x0)


def apart(some, others):
    return min(some) > max(others) or max(some) < min(others)


def points(runs):
    """Of each knob: its medians, how they stand to the default's, what is beyond the spread, and whether it is on the front,
    where none stands that does not gain PSNR or time beyond the spread: a front is not made of noise."""
    sets = by("options", runs)
    middle = lambda same, pick: statistics.median(pick(r) for r in same)
    found = [{"name": name, "runs": same, "ratio": middle(same, lambda r: r["ratio"]),
              "psnr": middle(same, lambda r: r["psnr"])} for name, same in sets.items()]
    default = found[0]
    lengths = [p for p in found if p["name"] in (HALF, DEFAULT, DOUBLE)]
    reference = {key: [r[key] for name in (DEFAULT, AGAIN) for r in sets.get(name, [])] for key in ("psnr", "ratio")}
    reference["ratio"] += [1 / r["ratio"] for r in sets.get(AGAIN, [])]  # the default may as well have been the slower one
    several = len({r["seed"] for r in runs}) > 1
    for p in found:
        p["to_default"] = p["psnr"] - default["psnr"]
        plain = after_that_time(lengths, p["ratio"])
        p["above_length"] = None if plain is None else p["psnr"] - plain
        p["beyond"] = [key for key in ("psnr", "ratio") if several and apart([r[key] for r in p["runs"]], reference[key])]
        p["several"] = several
        gains = {"psnr": p["to_default"] > 0, "ratio": p["ratio"] < 1}
        p["better"] = p["name"] == DEFAULT or p["name"] != AGAIN and any(gains[key] for key in (p["beyond"] if several else gains))
    for p in found:
        p["front"] = p["better"] and not any(
            q["better"] and q["ratio"] <= p["ratio"] and q["psnr"] >= p["psnr"]
            and (q["ratio"], q["psnr"]) != (p["ratio"], p["psnr"]) for q in found)
    return found


def paying(runs):
    """The knobs that reach more PSNR than a run of that length does, by more than seeds differ; the best first."""
    seeds = [r["psnr"] for r in runs if r["options"] == DEFAULT]
    noise = max(seeds) - min(seeds)
    able = [p for p in points(runs) if p["name"] in knobs(1) and p["better"] and (p["above_length"] or 0) > noise]
    return [p["name"] for p in sorted(able, key=lambda p: -p["above_length"])]


def run(arguments):
    common = parsed(arguments.options)
    n = int(common.setdefault("-i", ["7000"])[0])
    alone = {name: own for name, own in knobs(n).items() if not excluded(common, own)}
    unknown = set(arguments.knobs) - set(alone)
    if unknown:
        raise SystemExit(f"no such knob, or not with these options: {', '.join(sorted(unknown))}; there are {', '.join(alone)}")
    alone = {name: own for name, own in alone.items() if name in (arguments.knobs or alone) or name == AGAIN}
    kernels = kernel_knobs.programs_in(arguments.kernels) if arguments.kernels else {}
    if arguments.kernels and not kernels:
        raise SystemExit(f"{arguments.kernels} has none of what bench/lab/kernel_knobs.py builds")
    runs = turns(arguments, common, {**alone, **dict.fromkeys(kernels, {})}, kernels)
    combined = together(paying(runs), n)
    if combined:
        runs += turns(arguments, common, combined)
    chosen = {DEFAULT: {}, **alone, **dict.fromkeys(kernels, {}), **combined}
    result = {"bench": "tradeoff", "program": pathlib.Path(arguments.program).name, "data": arguments.data,
              **environment(arguments.commit), "device": runs[0]["device"], "seeds": arguments.seeds,
              "options": words(common), "knobs": {name: words(own) for name, own in chosen.items()},
              "kernels": {name: kernel_knobs.knobs()[name][0] for name in kernels}, "runs": runs}
    pathlib.Path(arguments.output).write_text(json.dumps(result, indent=1) + "\n")
    print(table(result))


def command(result, name):
    options = {**parsed(result["options"]), **parsed(result["knobs"][name])}
    return shlex.join([result["program"], "train", "-d", result["data"], "-o", "OUTPUT", "--eval", *words(options)])


def table(result):
    """The points as Markdown, and the command line of each on the front."""
    found = points(result["runs"])
    rows = []
    for i, p in enumerate(found):
        column = lambda pick, form: spread([pick(r) for r in p["runs"]], form)
        beyond = " and ".join({"psnr": "PSNR", "ratio": "time"}[b] for b in p["beyond"]) or "nothing"
        own = " ".join(result["knobs"][p["name"]])
        what = result["kernels"].get(p["name"], f"`{own}`" if own else "")
        rows.append([str(i), p["name"], what, column(lambda r: r["seconds"]["train"], "{:.2f}"),
                     column(lambda r: r["ratio"], "{:.2f}"), column(lambda r: r["psnr"], "{:.2f}"), f"{p['to_default']:+.2f}",
                     "" if p["above_length"] is None else f"{p['above_length']:+.2f}",
                     "" if p["name"] == DEFAULT else beyond if p["several"] else "one seed", "**yes**" if p["front"] else "no"])
    head = ["", "knob", "options", "loop, s", "times the default's", "held-out PSNR, dB", "to the default's", "to as long a run's",
            "beyond the spread", "on the front"]
    front = sorted((p for p in found if p["front"]), key=lambda p: p["ratio"])
    built = lambda p: ", built by bench/lab/kernel_knobs.py" if p["name"] in result["kernels"] else ""
    lines = "".join(f"{command(result, p['name'])}  # {p['name']}{built(p)}: {p['ratio']:.2f}, {p['psnr']:.2f} dB\n" for p in front)
    return (markdown(head, rows) + f"\n`{' '.join(result['options'])}`, {pathlib.Path(result['data']).name}, {where(result)}.\n\n"
            f"The front, from the fastest:\n\n```sh\n{lines}```\n")


def plot(arguments):
    import matplotlib
    matplotlib.use("Agg")
    matplotlib.rcParams["svg.hashsalt"] = "warpagg"  # the same file from the same figures
    from matplotlib import pyplot
    result = json.loads(pathlib.Path(arguments.file).read_text())
    found = points(result["runs"])
    figure, axis = pyplot.subplots(figsize=(9, 6))
    for i, p in enumerate(found):
        bars = {key: [[p[key] - min(r[key] for r in p["runs"])], [max(r[key] for r in p["runs"]) - p[key]]] for key in ("ratio", "psnr")}
        axis.errorbar(p["ratio"], p["psnr"], bars["psnr"], bars["ratio"], ecolor="0.6", elinewidth=0.7, color="black", marker="so"[i > 0],
                      markersize=6, markerfacecolor="black" if p["front"] else "white", linestyle="", label=f"{i}  {p['name']}")
        axis.annotate(str(i), (p["ratio"], p["psnr"]), (4, 4), textcoords="offset points", fontsize=8)
    front = sorted((p["ratio"], p["psnr"]) for p in found if p["front"])
    axis.plot(*zip(*front), "k-", linewidth=1, label="front")
    seconds = statistics.median(r["seconds"]["train"] for r in found[0]["runs"])
    axis.set(xscale="log", xlabel=f"seconds in the loop, times the default's ({seconds:.2f} s)", ylabel="held-out PSNR, dB",
             title=f"{pathlib.Path(result['data']).name}, {' '.join(result['options'])}")
    axis.xaxis.set_major_locator(matplotlib.ticker.LogLocator(subs=(1, 2, 5)))
    axis.xaxis.set_major_formatter("{x:g}")
    axis.xaxis.set_minor_formatter(matplotlib.ticker.NullFormatter())
    axis.grid(alpha=0.2)
    axis.legend(fontsize=7, loc="center left", bbox_to_anchor=(1.01, 0.5), title="filled: on the front", title_fontsize=7)
    figure.text(0.5, 0.0, where(result), fontsize=6, ha="center")
    figure.savefig(arguments.plot, bbox_inches="tight", metadata={"Date": None})


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    runner = add_run(commands, run)
    runner.add_argument("--data", required=True, help="the scene: a folder, or synthetic:NAME")
    runner.add_argument("--kernels", help="the folder that bench/lab/kernel_knobs.py has built")
    runner.add_argument("--knobs", nargs="+", default=[], help="of the options these alone, by the names of the table")
    shower = commands.add_parser("table")
    shower.add_argument("file")
    shower.set_defaults(action=lambda arguments: print(table(json.loads(pathlib.Path(arguments.file).read_text())), end=""))
    plotter = commands.add_parser("plot")
    plotter.add_argument("file")
    plotter.add_argument("plot")
    plotter.set_defaults(action=plot)
    own, passed_on = own_and_passed_on()
    arguments = parser.parse_args(own)
    arguments.options = passed_on[0] if passed_on else []
    arguments.action(arguments)


if __name__ == "__main__":
    main()
