#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""What simulating an effect costs and gains: time, memory and PSNR with it on and off, on scenes that call for it and on
ones that do not, and what --effects auto makes of scenes beside all and none.

    bench/effects.py run --program build/.../gaussian_splatting --output effects.json \\
        --data ../shared/data --scenes fern south_building -- -i 7000 --device cuda
    bench/effects.py table effects.json

What is after -- is for every run. Synthetic scenes are of known truth (see `inspect`), 256 pixels wide, and their models
are also compared with the world itself, from the distance of most scenes, half and four times that; of the photos of folders nobody knows what they call for.
"""
import argparse
import concurrent.futures
import json
import pathlib
import statistics
import subprocess
import tempfile

from environment import environment, own_and_passed_on
from markdown_tables import markdown
from scenes import by, where

# For each effect, a scene that calls for it and one that does not.
SCENES = {"direction": ("spheres,gloss=1,noise=0.01", "spheres,noise=0.03"),
          "vignetting": ("spheres,vignetting=0.4", "spheres"),
          "exposure": ("spheres,exposure=0.3", "spheres"),
          "response": ("spheres,exposure=0.5,response=0.8", "spheres,exposure=0.5"),
          "antialiasing": ("spheres,scales=4", "spheres"),
          "sky": ("spheres,sky=0.8", "spheres"),
          "motion": ("spheres,blur=6", "spheres"),
          "moving": ("spheres,moving=0.5", "spheres"),
          "masks": ("spheres,passers=0.1", "spheres"),
          "depth": ("spheres,views=4,points=300,depths=0.02", "spheres,depths=0.02")}
NEEDS = {"response": "exposure"}  # effects that only make sense with another one, which is on in both runs
LITTLE = ["spheres,noise=0.03", "alpha,noise=0.03"]
MUCH = ["spheres,gloss=0.7,exposure=0.3,scales=4,sky=0.7", "alpha,gloss=0.7,exposure=0.3,scales=4"]
SELECTIONS = ["none", "auto", "all"]
DISTANCES = [1, 0.5, 4]
PHOTOS = 16  # of the world, from each distance
TAKEN = {"vignetting", "exposure", "response", "scales", "passers", "moving", "blur", "shutter", "depths", "points",
         "views", "noise"}  # parameters of the photos, not of the world
SIDE = "256"


def selections(effect):
    """The values of --effects without and with an effect."""
    needed = NEEDS.get(effect)
    return (needed, f"{needed},{effect}") if needed else ("none", effect)


def evaluated(program, ply, world, distance, device, background, folder):
    folder = pathlib.Path(folder) / str(distance)
    subprocess.run([program, "evaluate", ply, "-d", f"synthetic:{world},distance={distance},views={PHOTOS}", "-r", SIDE, "-q", "-o", folder,
                    "--device", device, *background], check=True)
    return json.loads((folder / "metrics.json").read_text())["psnr"]


def train(arguments, scene, effects, seed):
    """A run, its model seen from elsewhere too if the scene is synthetic. On black, whatever the selection: exposures change
    any other background, and without transparent parts it is black anyway, or a sky."""
    is_folder = scene in arguments.scenes
    data = [str(pathlib.Path(arguments.data) / scene)] if is_folder else [f"synthetic:{scene}", "-r", SIDE]
    background = ["--background", "black"] if scene.split(",")[0] == "alpha" else []
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([arguments.program, "train", "-d", *data, "-o", folder, "--eval", "--seed", str(seed), "-q",
                        *background, "--fit-exposure", f"--effects={effects}", *arguments.options], check=True)
        metrics = json.loads((pathlib.Path(folder) / "metrics.json").read_text())
        one = {"scene": scene, "options": effects, "seed": seed,
               **{name: metrics[name] for name in ("psnr", "fitted_psnr", "gaussians", "iterations_per_second", "device",
                                                   "peak_host_bytes", "peak_device_bytes", "effects")}}
        if not is_folder:
            ply = next(pathlib.Path(folder).glob("point_cloud/*/point_cloud.ply"))
            device = metrics["device"].split(",")[0]
            world = ",".join(word for word in scene.split(",") if word.split("=")[0] not in TAKEN)
            has_sky = any(effect["on"] for effect in metrics["effects"] if effect["name"] == "sky")
            behind = [] if has_sky else ["--background", "black"]
            at = lambda d: (str(d), evaluated(arguments.program, ply, world, d, device, behind, folder))
            with concurrent.futures.ThreadPoolExecutor() as pool:
                one["from_distance"] = dict(pool.map(at, DISTANCES))
    print(scene, effects, seed, f"{one['psnr']:.2f} dB, fitted {one['fitted_psnr']:.2f}",
          f"{one['iterations_per_second']:.0f} it/s", flush=True)
    return one


def run(arguments):
    pairs = {(scene, effects): None for effect, scenes in SCENES.items() for scene in scenes
             for effects in selections(effect)}
    chosen = {(scene, effects): None for scene in (*LITTLE, *MUCH, *arguments.scenes) for effects in SELECTIONS}
    runs = [train(arguments, *one, seed) for seed in arguments.seeds for one in {**pairs, **chosen}]
    result = {"bench": "effects", "scenes": arguments.scenes, "options": arguments.options, **environment(arguments.commit),
              "runs": runs}
    aside = pathlib.Path(f"{arguments.output}.part")
    aside.write_text(json.dumps(result, indent=1) + "\n")
    aside.replace(arguments.output)
    print(table(result))


def median(runs, pick):
    return statistics.median(pick(r) for r in runs)


def milliseconds(run):
    return 1000 / run["iterations_per_second"]


def peak_mib(run):
    return (run["peak_device_bytes"] or run["peak_host_bytes"]) / 2**20


def figures(off, on):
    """Of two sets of runs: times of an iteration, memory, and PSNRs off and on, with their difference."""
    both = lambda pick: (median(off, pick), median(on, pick))
    pair = lambda values: f"{values[0]:.2f}, {values[1]:.2f} ({values[1] - values[0]:+.2f})"
    ms, mib = both(milliseconds), both(peak_mib)
    row = [f"{ms[1] / ms[0]:.2f}", f"{mib[0]:.0f}, {mib[1]:.0f}", pair(both(lambda r: r["psnr"])),
           pair(both(lambda r: r["fitted_psnr"]))]
    for distance in map(str, DISTANCES):
        row.append(pair(both(lambda r: r["from_distance"][distance])) if "from_distance" in off[0] else "")
    return row


def outcome(run):
    names = [f"{e['name']} {e['sh_degree']}" if e["name"] == "direction" else e["name"] for e in run["effects"] if e["on"]]
    return ", ".join(n for n in names if n != "background") or "nothing"


def table(result):
    sets = {key: by("options", same) for key, same in by("scene", result["runs"]).items()}
    rows = [[f"`{effect}`", "yes" if k == 0 else "no", f"`{scene}`", *figures(*(sets[scene][s] for s in selections(effect)))]
            for effect, scenes in SCENES.items() for k, scene in enumerate(scenes)]
    head = ["effect", "called for", "scene", "time of an iteration, on to off", "peak MiB", "held-out PSNR, off and on, dB",
            "after fitting exposures", *(f"the world from {d} times the distance" for d in DISTANCES)]
    text = markdown(head, rows)
    rows = []
    for scene in (*LITTLE, *MUCH, *result["scenes"]):
        of = sets[scene]
        psnr = lambda name, s: median(of[s], lambda r: r[name])
        rows.append([f"`{scene}`", outcome(of["auto"][0]),
                     f"{median(of['all'], milliseconds) / median(of['auto'], milliseconds):.2f}",
                     f"{median(of['none'], milliseconds) / median(of['auto'], milliseconds):.2f}",
                     *(" / ".join(f"{psnr(name, s):.2f}" for s in SELECTIONS) for name in ("psnr", "fitted_psnr"))])
    head = ["scene", "auto simulates", "time of all to auto's", "of none to auto's", "held-out PSNR: none / auto / all, dB",
            "after fitting exposures"]
    own = " ".join(result["options"])
    return f"{text}\n{markdown(head, rows)}\n`{own}`, {where(result)}\n"


def main():
    own, passed = own_and_passed_on()
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    runner = commands.add_parser("run")
    runner.add_argument("--program", required=True)
    runner.add_argument("--data", default=".", help="the folder of the scenes")
    runner.add_argument("--scenes", nargs="+", default=[])
    runner.add_argument("--seeds", nargs="+", type=int, default=[0])
    runner.add_argument("--commit", help="where the sources are no git checkout")
    runner.add_argument("--output", required=True)
    runner.set_defaults(action=run)
    shower = commands.add_parser("table")
    shower.add_argument("file")
    shower.set_defaults(action=lambda arguments: print(table(json.loads(pathlib.Path(arguments.file).read_text()))))
    arguments = parser.parse_args(own)
    arguments.options = passed[0] if passed else []
    arguments.action(arguments)


if __name__ == "__main__":
    main()
