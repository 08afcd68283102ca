#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""How often `inspect` or `train` decides right what a scene calls for: on synthetic scenes of known truth, and what they say of photos.

    bench/decisions.py run --program build/.../gaussian_splatting --data ../shared/data --scenes lego truck \\
        --output bench/results/decisions.json
    bench/decisions.py table bench/results/decisions.json

    bench/decisions.py run --train --program ... --output train.json -- -i 1500
    bench/decisions.py run --train --judge direction --program ... --output train.json -- -i 1500

With --train, the decisions are those with which a training ends, which may have revised them. Options after -- go to `train`.
--judge trains each mixture with held-out photos, by the decision, with an effect, and without it, and compares the PSNR: an
effect can help although the scene was made without it.
Pure scenes have one effect or noise; mixtures have each effect or not, by the seed, and each mixture comes with each noise.
"""
import argparse
import concurrent.futures
import json
import pathlib
import random
import subprocess
import tempfile
import time

from environment import environment, own_and_passed_on
from markdown_tables import markdown
from scenes import by

WORLDS = ["spheres", "alpha"]
BACKGROUND = "background"
CAUSES = {"direction": "gloss", "vignetting": "vignetting", "exposure": "exposure", "response": "response",
          "antialiasing": "scales", "sky": "sky", "poses": "poses", "motion": "blur", "moving": "moving", "masks": "passers",
          "depth": "depths", "lens": "fisheye"}
EFFECTS = [*CAUSES, BACKGROUND]
PURE = [{}, {"gloss": 1}, {"vignetting": 0.4}, {"exposure": 0.3}, {"exposure": 0.5, "response": 0.8},
        {"response": 0.8}, {"scales": 4}, {"sky": 0.8}, {"walls": 0.8}, {"poses": 1}, {"blur": 8}, {"moving": 0.2},
        {"passers": 0.1},
        {"depths": 0.05}, {"depths": 2}, {"fisheye": 60}, {"noise": 0.03}]
SKYLESS = "alpha"  # pixels without a surface are transparent
LACKED = {"sky", "walls", "vignetting", "response"}  # parameters that SKYLESS lacks
JUDGED = {"with": "+", "without": "-"}
TOLERANCE = 0.1  # dB that a decision may cost
RIGHT_DEPTHS = 0.05  # more noise hides the order of depths
MIXED = {"gloss": (0.3, 1), "vignetting": (0.2, 0.6), "exposure": (0.15, 0.5), "response": (0.6, 1), "scales": (3, 8),
         "sky": (0.3, 1), "poses": (0.6, 2), "blur": (6, 12), "moving": (0.1, 0.5), "passers": (0.05, 0.2),
         "depths": (0.01, 0.02), "fisheye": (50, 70)}


def synthetic(kind, world, parameters):
    """A scene and which effects it has by how it is made."""
    parameters = {name: value for name, value in parameters.items() if name not in LACKED or world != SKYLESS}
    given = [f"{name}={value:g}" for name, value in parameters.items() if value]
    truth = {effect: bool(parameters.get(cause)) for effect, cause in CAUSES.items()}
    truth["response"] = truth["response"] and truth["exposure"]  # otherwise, colors of the scene can have any curve
    truth["depth"] = truth["depth"] and parameters["depths"] <= RIGHT_DEPTHS
    return {"kind": kind, "scene": "synthetic:" + ",".join([world, *given]), "noise": parameters.get("noise", 0),
            "truth": {**truth, BACKGROUND: world == "alpha"}}


def pure():
    return [synthetic("pure", world, parameters) for world in WORLDS for parameters in PURE
            if LACKED.isdisjoint(parameters) or world != SKYLESS]


def mixtures(count, seed, noises):
    drawn = random.Random(seed)
    cases = []
    for _ in range(count):
        world = drawn.choice(WORLDS)
        parameters = {name: round(drawn.uniform(*ends), 2) for name, ends in MIXED.items() if drawn.random() < 0.5}
        cases += [synthetic("mixture", world, {**parameters, "noise": noise}) for noise in noises]
    return cases


def run_program(scene, command):
    try:
        done = subprocess.run(command, capture_output=True, text=True)
    except OSError as problem:
        raise SystemExit(f"'{command[0]}' does not run: {problem.strerror}") from None
    if done.returncode:
        raise SystemExit(f"{command[1]} failed with {scene}: {done.stderr.strip()}")


def trained(program, scene, options):
    """The metrics of a training."""
    with tempfile.TemporaryDirectory() as folder:
        run_program(scene, [program, "train", "-d", scene, "-o", folder, "-q", "--no-viewer", *options])
        return json.loads((pathlib.Path(folder) / "metrics.json").read_text())


def decisions_of(metrics):
    """By effect, whether a training ended with it, and why it began with or without it. Effects that follow from the
    files are missing."""
    revised = lambda e: (f"; revised from degree {e['sh_degree_at_first']} to {e['sh_degree']}" if "sh_degree_at_first" in e
                         else f"; half-way {e['reason_half_way']}" if "reason_half_way" in e else "")
    return {e["name"]: {"recommended": e["on"] and e.get("sh_degree", 1) > 0, "evidence": e["reason"] + revised(e)}
            for e in metrics["effects"] if e["name"] != BACKGROUND}


def psnr(metrics):
    return metrics.get("refined_psnr", metrics["psnr"])


def inspect(program, scene):
    """By effect, whether it is called for (None: undecided) and the evidence; and the seconds of the whole process."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "effects.json"
        start = time.monotonic()
        run_program(scene, [program, "inspect", "-d", scene, "-o", file])
        seconds = time.monotonic() - start
        found = json.loads(file.read_text())["effects"]
    return {"effects": {e["name"]: {key: e[key] for key in ("recommended", "evidence")} for e in found}, "seconds": seconds}


def decide(arguments, scene, kind):
    found = inspect(arguments.program, scene)
    if arguments.train:
        train = lambda *options: trained(arguments.program, scene, [*arguments.options, *options])
        judged = arguments.judge if kind == "mixture" else None
        metrics = train(*(["--eval"] if judged else []))
        found["effects"].update(decisions_of(metrics))
        if judged:
            found["psnr"] = {"automatic": psnr(metrics), **{
                name: psnr(train("--eval", "--effects", f"auto,{sign}{judged}")) for name, sign in JUDGED.items()}}
    return found


def run(arguments):
    output = pathlib.Path(arguments.output)
    real = [pathlib.Path(arguments.data or "") / scene for scene in arguments.scenes]
    if bool(arguments.data) != bool(real):
        raise SystemExit("--data is the folder of the --scenes: one is not without the other")
    if arguments.mixtures < 0:
        raise SystemExit(f"--mixtures is a number of scenes, not {arguments.mixtures}")
    for folder in [output.parent, *real]:
        if not folder.is_dir():
            raise SystemExit(f"there is no folder '{folder}'")
    if arguments.jobs < 1:
        raise SystemExit(f"--jobs is a number of processes, not {arguments.jobs}")
    runs = []
    cases = [*pure(), *mixtures(arguments.mixtures, arguments.seed, arguments.noises)]
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        for case, found in zip(cases, pool.map(lambda case: decide(arguments, case["scene"], case["kind"]), cases)):
            runs.append({**case, **found})
            print(case["scene"], "wrong: " + (", ".join(wrong(runs[-1])) or "none"), flush=True)
    for folder in real:
        runs.append({"kind": "real", "scene": folder.name, **decide(arguments, str(folder), "real")})
        print(folder.name, f"{runs[-1]['seconds']:.2f} s", flush=True)
    result = {"bench": "decisions", **environment(arguments.commit), "seed": arguments.seed,
              "train": arguments.options if arguments.train else None, "judged": arguments.judge, "runs": runs}
    aside = output.with_name(output.name + ".part")
    aside.write_text(json.dumps(result, indent=1) + "\n")
    aside.replace(output)


def recommended(one, effect):
    return one["effects"][effect]["recommended"] or False


def wrong(one):
    return [effect for effect, has in one["truth"].items() if recommended(one, effect) != has]


def counts(runs, effect):
    """How many runs have the effect and are said to, are only said to, and only have it."""
    pairs = [(recommended(r, effect), r["truth"][effect]) for r in runs]
    return tuple(pairs.count(pair) for pair in ((True, True), (True, False), (False, True)))


def share(part, whole):
    return f"{100 * part / whole:.0f} %" if whole else "none"


def said(one, effect):
    return {True: "yes", False: "no", None: "undecided"}[one["effects"][effect]["recommended"]]


def evidence(one, effect):
    return one["effects"][effect]["evidence"].removeprefix("cannot decide: ")


def judgment(effect, runs):
    """A table of what decisions on an effect cost, relative to the better of training with it and without it."""
    rows = []
    for noise, of_noise in by("noise", runs).items():
        best = [max(r["psnr"][name] for name in JUDGED) for r in of_noise]
        for name in ["automatic", *JUDGED]:
            costs = [most - r["psnr"][name] for most, r in zip(best, of_noise)]
            rows.append([f"{noise:g}", name, str(len(costs)), share(sum(c <= TOLERANCE for c in costs), len(costs)),
                         f"{sum(costs) / len(costs):.2f}", f"{max(costs):.2f}"])
    return [f"Held-out PSNR below the better of training with `{effect}` and without it:\n",
            markdown(["noise", effect, "scenes", f"within {TOLERANCE} dB", "mean (dB)", "largest (dB)"], rows)]


def tables(result):
    kinds = by("kind", result["runs"])
    mixed = kinds.get("mixture", [])
    name = lambda one: f"`{one['scene'].removeprefix('synthetic:')}`"
    rows = []
    for effect in EFFECTS:
        for noise, runs in by("noise", mixed).items():
            both, only_said, only_true = counts(runs, effect)
            rows.append([effect, f"{noise:g}", share(both, both + only_said), share(both, both + only_true), str(both),
                         str(only_said), str(only_true)])
    head = ["effect", "noise", "precision", "recall", "true positives", "false positives", "false negatives"]
    options = result.get("train")
    if result.get("judged"):
        options = [*options, "--eval"]
    by_whom = "`inspect`" if options is None else f"`train {' '.join(options)}`"
    text = [f"{len(mixed)} scenes, random mixtures of effects by seed {result['seed']}, each with each noise; decisions of "
            f"{by_whom}; undecided counts as not called for:\n", markdown(head, rows)]

    if result.get("judged"):
        text += judgment(result["judged"], mixed)

    verdict = lambda one, effect: "**wrong**" if effect in wrong(one) else "right"
    rows = [[name(r), *(f"{verdict(r, effect)}: {said(r, effect)}" for effect in EFFECTS)] for r in kinds["pure"]]
    text += ["Scenes with one effect or noise:\n", markdown(["scene", *EFFECTS], rows)]

    rows = [[name(r), effect, said(r, effect), evidence(r, effect)]
            for r in [*kinds["pure"], *mixed] for effect in wrong(r)]
    text += ["Wrong decisions:\n", markdown(["scene", "effect", "called for", "evidence"], rows)]

    rows = [[r["scene"], *(f"{said(r, effect)}: {evidence(r, effect)}" for effect in EFFECTS), f"{r['seconds']:.2f}"]
            for r in kinds.get("real", [])]
    if rows:
        text += ["Photos, of which no truth is known:\n", markdown(["scene", *EFFECTS, "seconds, with loading"], rows)]
    return "\n".join([*text, f"{result['processor'].strip()}, {result['compiler']}, commit {result['commit']}.\n"])


def table(arguments):
    try:
        result = json.loads(pathlib.Path(arguments.file).read_text())
        if result["bench"] == "decisions":
            return print(tables(result), end="")
    except (OSError, ValueError, KeyError, TypeError):
        pass
    raise SystemExit(f"'{arguments.file}' holds no result of bench/decisions.py")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    runner = commands.add_parser("run")
    runner.add_argument("--program", required=True)
    runner.add_argument("--data", help="the folder of the scenes")
    runner.add_argument("--scenes", nargs="+", default=[])
    runner.add_argument("--mixtures", type=int, default=20)
    runner.add_argument("--noises", nargs="+", type=float, default=[0, 0.01, 0.03])
    runner.add_argument("--seed", type=int, default=0)
    runner.add_argument("--jobs", type=int, default=1, help="synthetic scenes that are inspected at once, which then take longer")
    runner.add_argument("--train", action="store_true", help="take the decisions of a training")
    runner.add_argument("--judge", choices=[e for e in EFFECTS if e != BACKGROUND], metavar="EFFECT",
                        help="with --train: compare the PSNR with that of training with and without this effect")
    runner.add_argument("--commit", help="where the sources are no git checkout")
    runner.add_argument("--output", required=True)
    runner.set_defaults(action=run)
    shower = commands.add_parser("table")
    shower.add_argument("file")
    shower.set_defaults(action=table)
    own, passed_on = own_and_passed_on()
    arguments = parser.parse_args(own)
    arguments.options = passed_on[0] if passed_on else []
    if arguments.options and not getattr(arguments, "train", False):
        parser.error("options after -- are for train: give --train")
    if getattr(arguments, "judge", None) and not arguments.train:
        parser.error("--judge compares trainings: give --train")
    arguments.action(arguments)


if __name__ == "__main__":
    main()
