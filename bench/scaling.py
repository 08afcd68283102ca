#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Measures the time of a step on several GPUs, and predicts it for more of them.

    bench/scaling.py measure --program build/bench/examples/gaussian_splatting/gaussian_splatting --folder /tmp/scaling \\
        --megapixels 1 4 12 --gaussians 300000 1000000 3000000 --ranks 1 2 --output scaling.json -- --effects none
    bench/scaling.py traffic scaling.json
    bench/scaling.py plot scaling.json scaling.svg
    bench/scaling.py predict scaling.json --picture prediction.svg

`measure` trains on scenes of bench/large_photos.py with each size of photos, number of Gaussians and number of
GPUs (--device cuda), or of processes with one thread (--device cpu). Numbers of GPUs that the machine does not
have are left out. The model does not grow, so that each step works on about the same number of Gaussians. The file is written
after each training, and the same command goes on where it was stopped. Options after -- go to all trainings.

`traffic` compares the measured bytes of a step with the formula in docs/explanation/when_several_gpus_help.md.
`plot` draws the time of a step against pixels and against Gaussians. `predict` fits a model to the measured times:

    seconds = a + b pixels / G + c Gaussians / G + bytes / bandwidth + latency * exchanges

a, b, c, 1 / bandwidth and latency are the least squares of relative errors, none of them negative. It then applies
the model to 8 GPUs and to 8 nodes. Nodes exchange values through a network, which this machine cannot measure:
--node-bandwidth and --node-latency describe it. The trainer does not support several nodes.

Needs numpy; `measure` also needs Pillow, and pictures need matplotlib (Debian: python3-numpy, python3-pil,
python3-matplotlib).
"""
import argparse
import itertools
import json
import math
import os
import pathlib
import statistics
import subprocess
import tempfile

import large_photos
from environment import compilers_of, environment, first_line, own_and_passed_on
from markdown_tables import markdown
from result_file import load, save

KEY = ["megapixels", "points", "ranks", "repeat"]
SPLAT, COUNT, LENGTH, SUMS = 60, 8, 8, 12  # bytes of a splat, of a number of splats, of a list's length; sums of a splat
SUM_BYTES = {"native": 4, "fixed": 8}
CALLS = 5  # exchanges of a step: numbers of splats, splats, lists, gradients, and the agreement to go on
GAUSSIAN = 4 * 59  # bytes of a Gaussian's gradients with SH degree 3
TILE = 16
ROWS = 3  # tile rows in which a border between strips can lie so that both strips list a splat, if unmeasured
# Colors of Okabe and Ito, which color-blind readers can tell apart.
COLORS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"]
LINES = ["-", "--", ":", "-."]


def tile_rows(height):
    return math.ceil(height / TILE)


def sent_splats(visible, rows, height, ranks):
    """The mean of the number of splats that a rank sends to others. `rows`: see ROWS."""
    strips = min(1 + (ranks - 1) * rows / tile_rows(height), ranks)  # that list a splat
    return visible * strips * (ranks - 1) / ranks ** 2


def rows_of_splats(run):
    """The number of rows with which `sent_splats` yields the measured number."""
    ranks, exchange = run["ranks"], run["exchange"]
    strips = exchange["sent_splats"] * ranks ** 2 / (exchange["visible_splats"] * (ranks - 1))
    return (strips - 1) / (ranks - 1) * tile_rows(run["height"])


def bytes_of_step(sent, height, ranks, sum_bytes):
    """The mean of the bytes that a rank sends to the others in a step, by purpose. `sent`: see `sent_splats`."""
    others = ranks - 1
    return {"splats": SPLAT * sent + 2 * COUNT * (ranks + 1) * others,
            "lists": 2 * LENGTH * (tile_rows(height) + 1) * others / ranks,
            "gradients": SUMS * sum_bytes * sent}


def present_ranks(device, ranks):
    """Those numbers of ranks that the machine has."""
    if device == "cpu":
        return ranks
    listed = subprocess.run(["nvidia-smi", "-L"], capture_output=True, text=True).stdout if first_line("nvidia-smi", "-L") else ""
    gpus = listed.count("GPU ")
    present = [count for count in ranks if count <= gpus]
    if not present:
        raise SystemExit(f"error: this machine has {gpus} GPUs: give fewer --ranks, or --device cpu")
    for count in ranks:
        if count > gpus:
            print(f"left out: --ranks {count}, because this machine has {gpus} GPUs")
    return present


def make_scene(folder, photos, megapixels, points):
    """The folder of a scene. Scenes of one size of photos share them, and only the last one's points exist."""
    scene = folder / f"{photos}_photos_of_{megapixels:g}_megapixels"
    args = argparse.Namespace(scene=scene, photos=photos, megapixels=megapixels, points=points)
    if (scene / "sparse" / "0" / "points3D.bin").exists():
        names = sorted(file.name for file in (scene / "images").iterdir())
        large_photos.write_sparse(scene / "sparse" / "0", args, names, *large_photos.size_of(megapixels))
    else:
        large_photos.make(args)
    return scene


def seconds_per_step(metrics):
    """The time of a step after the first report, because the first steps allocate memory."""
    iterations, seconds = metrics["history"]["iteration"], metrics["history"]["seconds"]
    if len(iterations) < 2:
        return metrics["seconds"]["train"] / metrics["iterations"]
    return (seconds[-1] - seconds[0]) / (iterations[-1] - iterations[0])


def train_one(arguments, scene, key):
    megapixels, points, ranks, repeat = key
    devices = {"cpu": ["--ranks", str(ranks)], "cuda": ["--gpus", str(ranks)]}[arguments.device]
    # A process on the CPU stands for a device, so that each has one thread.
    threads = {"OMP_NUM_THREADS": str(ranks)} if arguments.device == "cpu" else {}
    width, height = large_photos.size_of(megapixels)
    with tempfile.TemporaryDirectory() as out:
        command = [arguments.program, "train", "-d", scene, "-o", out, "-q", "--no-viewer", "--init", "given",
                   "--num-downscales", "0", "--max-cap", str(points), "-i", str(arguments.iterations),
                   "--densify-until-iter", "0", "--device", arguments.device, *devices, *arguments.options]
        try:
            subprocess.run(command, check=True, env={**os.environ, **threads})
        except subprocess.CalledProcessError as failed:
            raise SystemExit(f"error: exit status {failed.returncode} of {' '.join(map(str, failed.cmd))}")
        metrics = json.loads((pathlib.Path(out) / "metrics.json").read_text())
    return {**dict(zip(KEY, key)), "pixels": width * height, "height": height, "seconds": seconds_per_step(metrics),
            **{name: metrics.get(name) for name in ("gaussians", "device", "accumulator", "exchange")}}


def measure(arguments):
    about = {"bench": "scaling", "options": arguments.options, "iterations": arguments.iterations,
             "photos": arguments.photos, "device": arguments.device, **environment(arguments.commit),
             **compilers_of(pathlib.Path(arguments.program).resolve().parents[2])}
    output = pathlib.Path(arguments.output)
    result = load(output, about, arguments.fresh) or {"about": about, "runs": []}
    known = {tuple(run[name] for name in KEY) for run in result["runs"]}
    ranks = present_ranks(arguments.device, arguments.ranks)
    for megapixels, points in itertools.product(arguments.megapixels, arguments.gaussians):
        keys = [(megapixels, points, count, repeat) for repeat in range(arguments.repeats) for count in ranks]
        keys = [key for key in keys if key not in known]
        if not keys:
            continue
        scene = make_scene(pathlib.Path(arguments.folder), arguments.photos, megapixels, points)
        for key in keys:
            run = train_one(arguments, scene, key)
            result["runs"].append(run)
            save(output, result)
            print(f"{megapixels:g} megapixels, {run['gaussians']} Gaussians, {key[2]} ranks: "
                  f"{1000 * run['seconds']:.2f} ms per step", flush=True)


def medians(runs):
    """One run for each size, number of points and number of ranks, with the median of the seconds."""
    same = {}
    for run in runs:
        same.setdefault(tuple(run[name] for name in KEY[:3]), []).append(run)
    return [{**of[0], "seconds": statistics.median(run["seconds"] for run in of)} for _, of in sorted(same.items())]


def where(result):
    """The machine and the commit of a result, in words."""
    about = result["about"]
    machine = about["processor"] if about["device"] == "cpu" else about["gpu_and_driver"].replace(", ", ", driver ")
    return f"{machine.strip()}, commit {about['commit']}"


def devices(result, count):
    """A number of devices, in words."""
    name = "GPU" if result["about"]["device"] == "cuda" else "process"
    return f"{count} {name}" + ("" if count == 1 else "s" if name == "GPU" else "es")


def traffic_table(result):
    rows = []
    for run in medians(result["runs"]):
        exchange = run["exchange"]
        if exchange is None:
            continue
        formula = bytes_of_step(exchange["sent_splats"], run["height"], run["ranks"], SUM_BYTES[run["accumulator"]])
        for purpose, expected in formula.items():
            found = exchange["bytes"][purpose]
            rows.append([f"{run['pixels']:,}", f"{run['gaussians']:,}", devices(result, run["ranks"]), purpose,
                         f"{found:,.0f}", f"{expected:,.0f}", f"{100 * (found / expected - 1):+.3f} %"])
    return f"Bytes that a device sends to the others in a step, the mean of all devices; {where(result)}\n\n" + markdown(
        ["pixels", "Gaussians", "devices", "purpose", "measured", "formula", "difference"], rows)


class Model:
    """The time of a step. `terms`: seconds per step, per pixel, per Gaussian, per byte and per exchange."""

    NAMES = ["a", "b", "c", "1 / bandwidth", "latency"]

    def __init__(self, visible, rows, gathered, sum_bytes):
        """`visible`: the share of the Gaussians that a view shows. `rows`: see ROWS, by pixels and Gaussians of the
        measured scenes. `gathered`: the bytes of a Gaussian, per step, that the devices gather between steps."""
        self.visible, self.rows, self.gathered, self.sum_bytes = visible, rows, gathered, sum_bytes
        self.terms, self.largest_error = [0.0] * len(self.NAMES), 0.0

    @classmethod
    def fit(cls, runs, bandwidth=None, latency=None, visible=None):
        """`visible`: the share of the Gaussians that a view shows, if no run has measured it. A bandwidth and a
        latency that are given are not fitted."""
        import numpy as np
        shared = [run for run in runs if run["exchange"]]
        if not shared and None in (bandwidth, latency, visible):
            raise SystemExit("error: the file has no training with several ranks, which show the cost of exchanges: "
                             "measure with --ranks 1 2, or give --bandwidth, --latency and --visible")
        gathered, rows = 0, {}
        for run in shared:
            rows.setdefault((run["pixels"], run["gaussians"]), []).append(rows_of_splats(run))
        if shared:
            visible = statistics.mean(run["exchange"]["visible_splats"] / run["gaussians"] for run in shared)
            gathered = statistics.mean(run["exchange"]["bytes"]["gaussians"] / run["gaussians"] * run["ranks"] /
                                       (run["ranks"] - 1) for run in shared)
        model = cls(visible, {scene: statistics.mean(found) for scene, found in rows.items()}, gathered, SUM_BYTES[runs[0]["accumulator"]])
        factors = np.array([model.parts(r["pixels"], r["height"], r["gaussians"], r["ranks"], r["exchange"]) for r in runs])
        times = np.array([r["seconds"] for r in runs])
        given = {3: None if bandwidth is None else 1 / bandwidth, 4: latency}
        given = {term: value for term, value in given.items() if value is not None}
        rest = times - sum(factors[:, term] * value for term, value in given.items())
        model.terms = np.array(least_squares(factors / times[:, None], rest / times,
                                             [k for k in range(len(cls.NAMES)) if k not in given]))
        for term, value in given.items():
            model.terms[term] = value
        model.largest_error = float(np.max(np.abs(factors @ model.terms / times - 1)))
        return model

    def parts(self, pixels, height, gaussians, ranks, exchange=None):
        """The factors of the terms."""
        splats = exchange["sent_splats"] if exchange else (
            sent_splats(self.visible * gaussians, self.rows.get((pixels, gaussians), ROWS), height, ranks))
        sent = sum(bytes_of_step(splats, height, ranks, self.sum_bytes).values()) + (
            self.gathered * gaussians * (ranks - 1) / ranks)
        return [1, pixels / ranks, gaussians / ranks, sent, CALLS if ranks > 1 else 0]

    def seconds(self, *of):
        return sum(factor * term for factor, term in zip(self.parts(*of), self.terms))

    def seconds_of_nodes(self, pixels, height, gaussians, nodes, gpus, bandwidth, latency):
        """One picture on all GPUs of several nodes. A node sends the bytes of its GPUs to the other nodes through its
        network, which all of its GPUs share, besides what they exchange within the node."""
        ranks = nodes * gpus
        _, *work, sent, calls = self.parts(pixels, height, gaussians, ranks)
        abroad = sent * gpus * (ranks - gpus) / (ranks - 1)
        at_home = sent * (gpus - 1) / (ranks - 1)
        a, b, c, per_byte, per_call = self.terms
        return a + b * work[0] + c * work[1] + at_home * per_byte + abroad / bandwidth + calls * (per_call + latency)

    def seconds_of_views(self, pixels, height, gaussians, nodes, gpus, bandwidth, latency):
        """A picture per node, whose gradients are added: each node sends those of all Gaussians twice, in parts."""
        sent = 2 * GAUSSIAN * gaussians * (nodes - 1) / nodes
        return self.seconds(pixels, height, gaussians, gpus) + sent / bandwidth + latency


def least_squares(rows, values, terms):
    """The terms, none of them negative, that fit best: the best of the fits with some of them. Others are zero."""
    import numpy as np
    best, best_error = [0.0] * rows.shape[1], float(np.sum(values ** 2))
    for chosen in itertools.chain.from_iterable(itertools.combinations(terms, n) for n in range(1, len(terms) + 1)):
        part = rows[:, chosen]
        scale = np.maximum(np.abs(part).max(axis=0), 1e-300)
        found = np.linalg.lstsq(part / scale, values, rcond=None)[0] / scale
        error = float(np.sum((part @ found - values) ** 2))
        if np.all(found >= 0) and error < best_error * (1 - 1e-9):
            best, best_error = [0.0] * rows.shape[1], error
            for term, value in zip(chosen, found):
                best[term] = float(value)
    return best


def predictions(model, arguments):
    """The configurations that nobody has measured: their names, views per step, and functions of the seconds of a step."""
    gpus, nodes = arguments.gpus, arguments.nodes
    network = (nodes, gpus, arguments.node_bandwidth * 1e9, arguments.node_latency * 1e-6)
    return [(f"{gpus} devices", 1, lambda *of: model.seconds(*of, gpus)),
            (f"{nodes} nodes of {gpus}, one view", 1, lambda *of: model.seconds_of_nodes(*of, *network)),
            (f"{nodes} nodes of {gpus}, a view each", nodes, lambda *of: model.seconds_of_views(*of, *network))]


def prediction_table(result, model, arguments):
    rows = []
    runs = medians(result["runs"])
    for pixels, points in dict.fromkeys((run["pixels"], run["points"]) for run in runs):
        same = [run for run in runs if (run["pixels"], run["points"]) == (pixels, points)]
        scene = (pixels, same[0]["height"], same[0]["gaussians"])
        base = model.seconds(*scene, 1)
        cells = [f"{pixels:,}", f"{scene[2]:,}"]
        for run in same:
            rows.append([*cells, devices(result, run["ranks"]), f"{1000 * run['seconds']:.3g} (measured)",
                         f"{1000 * model.seconds(*scene, run['ranks']):.3g} (fit)",
                         f"{base / model.seconds(*scene, run['ranks']):.2f} (fit)"])
        for name, views, seconds in predictions(model, arguments):
            rows.append([*cells, name, "", f"{1000 * seconds(*scene):.3g} (prediction)",
                         f"{views * base / seconds(*scene):.2f} (prediction)"])
    text = (f"Milliseconds of a step; {where(result)}. A prediction is no measurement: it extends a fit to devices that "
            f"were not there. Nodes: {arguments.node_bandwidth:g} GB/s and {arguments.node_latency:g} µs, which are "
            "assumptions. The trainer does not support several nodes.\n\n")
    text += markdown(["pixels", "Gaussians", "devices", "measured", "model", "views per second, relative to one device"], rows)
    terms = dict(zip(Model.NAMES, model.terms))
    bandwidth = f"{1e-9 / terms['1 / bandwidth']:.3g} GB/s" if terms["1 / bandwidth"] > 0 else "no limit found"
    return text + (f"\nFit: {1000 * terms['a']:.3g} ms per step, {1e9 * terms['b']:.3g} ns per pixel, {1e9 * terms['c']:.3g} ns "
                   f"per Gaussian, bandwidth {bandwidth}, {1e6 * terms['latency']:.3g} µs per exchange; a view shows "
                   f"{100 * model.visible:.3g} % of the Gaussians; largest error {100 * model.largest_error:.3g} %.\n")


def pyplot_for_files():
    import matplotlib
    matplotlib.use("Agg")
    # The same file from the same figures, with text that stays text.
    matplotlib.rcParams.update({"svg.hashsalt": "warpagg", "svg.fonttype": "none", "font.size": 9,
                                "font.sans-serif": ["DejaVu Sans"]})
    from matplotlib import pyplot
    return pyplot


def draw(result, file, curves, note):
    """Two panels. `curves`: see `measured_curves`."""
    pyplot = pyplot_for_files()
    from matplotlib import ticker
    figure, axes = pyplot.subplots(1, 2, layout="constrained", figsize=(8.5, 5), sharey=True)
    for axis, name, other in zip(axes, ("pixels", "gaussians"), ("gaussians", "pixels")):
        for curve in curves[name]:
            (line,) = axis.plot(*zip(*curve["points"]), curve["line"], marker=curve["marker"], markersize=4, linewidth=1.2,
                                color=COLORS[curve["color"] % len(COLORS)],
                                label=f"{curve['devices']}, {ticker.EngFormatter(sep='')(float(f'{curve[other]:.2g}'))} "
                                      f"{'Gaussians' if other == 'gaussians' else other}")
            line.set_gid(f"{name}: {curve['devices']}, {curve[other]}")
        axis.set_xscale("log")
        axis.set_yscale("log")
        axis.xaxis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5)))
        axis.xaxis.set_major_formatter(ticker.EngFormatter(sep=""))
        axis.xaxis.set_minor_locator(ticker.NullLocator())
        axis.yaxis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5)))
        axis.yaxis.set_major_formatter("{x:g}")
        axis.yaxis.set_minor_locator(ticker.NullLocator())
        axis.set_xlabel("pixels of a photo" if name == "pixels" else "Gaussians")
        axis.grid(alpha=0.25)
        axis.legend(fontsize=7, frameon=False, loc="upper center", bbox_to_anchor=(0.5, -0.14))
    axes[0].set_ylabel("milliseconds per step")
    figure.text(0.5, -0.02, f"{where(result)}\n{note}", fontsize=8, ha="center", va="top")
    figure.savefig(file, bbox_inches="tight", metadata={"Date": None} if str(file).endswith(".svg") else None)
    pyplot.close(figure)


def measured_curves(result):
    """For each axis, the curves of each number of devices and of each value of the other axis."""
    runs = medians(result["runs"])
    counts = sorted({run["ranks"] for run in runs})
    curves = {"pixels": [], "gaussians": []}
    for (axis, found), other in zip(curves.items(), ("gaussians", "pixels")):
        for count, (color, value) in itertools.product(counts, enumerate(sorted({run[other] for run in runs}))):
            points = sorted((run[axis], 1000 * run["seconds"]) for run in runs if (run["ranks"], run[other]) == (count, value))
            if points:
                found.append({other: value, "points": points, "devices": devices(result, count), "marker": "o",
                              "color": color, "line": LINES[counts.index(count) % len(LINES)]})
    return curves


def predicted_curves(result, model, arguments):
    """Curves of one device as measured, and of the others as predicted, for the largest value of the other axis."""
    runs = medians(result["runs"])
    scenes = {(run["pixels"], run["gaussians"]): run["height"] for run in runs}
    curves = {"pixels": [], "gaussians": []}
    measured = measured_curves(result)
    for axis, (column, other) in {"pixels": (0, "gaussians"), "gaussians": (1, "pixels")}.items():
        largest = max(scene[1 - column] for scene in scenes)
        curves[axis] += [{**curve, "color": -1} for curve in measured[axis] if curve[other] == largest]
        for color, ((name, views, seconds), line) in enumerate(zip(predictions(model, arguments), LINES[1:])):
            points = sorted((scene[column], 1000 * seconds(scene[0], height, scene[1]) / views)
                            for scene, height in scenes.items() if scene[1 - column] == largest)
            curves[axis].append({other: largest, "points": points, "line": line, "marker": "", "color": color,
                                 "devices": f"{name} (prediction)" + (", per view" if views > 1 else "")})
    return curves


def read(file):
    return json.loads(pathlib.Path(file).read_text())


def plot(arguments):
    result = read(arguments.file)
    draw(result, arguments.picture, measured_curves(result), "median of the repeats")


def predict(arguments):
    result = read(arguments.file)
    bandwidth = None if arguments.bandwidth is None else arguments.bandwidth * 1e9
    latency = None if arguments.latency is None else arguments.latency * 1e-6
    model = Model.fit(medians(result["runs"]), bandwidth, latency, arguments.visible)
    print(prediction_table(result, model, arguments), end="")
    if arguments.picture:
        draw(result, arguments.picture, predicted_curves(result, model, arguments),
             "curves without points are predictions by a fitted model, no measurements")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    measurer = commands.add_parser("measure")
    measurer.add_argument("--program", required=True)
    measurer.add_argument("--folder", required=True, help="for the scenes, which stay there")
    measurer.add_argument("--photos", type=int, default=24, help="photos of a scene (default: 24)")
    measurer.add_argument("--megapixels", nargs="+", type=float, default=[0.5, 1, 2, 4, 8], help="(default: %(default)s)")
    measurer.add_argument("--gaussians", nargs="+", type=int, default=[250000, 1000000, 4000000], help="(default: %(default)s)")
    measurer.add_argument("--ranks", nargs="+", type=int, default=[1, 2], help="numbers of GPUs or processes (default: 1 2)")
    measurer.add_argument("--device", choices=["cuda", "cpu"], default="cuda")
    measurer.add_argument("--iterations", type=int, default=400, help="steps of a training (default: 400)")
    measurer.add_argument("--repeats", type=int, default=1, help="trainings of each kind, of which the median counts (default: 1)")
    measurer.add_argument("--commit", help="where the sources are no git checkout")
    measurer.add_argument("--fresh", action="store_true", help="discard earlier results")
    measurer.add_argument("--output", required=True)
    measurer.set_defaults(action=measure)
    shower = commands.add_parser("traffic")
    shower.add_argument("file")
    shower.set_defaults(action=lambda arguments: print(traffic_table(read(arguments.file)), end=""))
    plotter = commands.add_parser("plot")
    plotter.add_argument("file")
    plotter.add_argument("picture")
    plotter.set_defaults(action=plot)
    predictor = commands.add_parser("predict")
    predictor.add_argument("file")
    predictor.add_argument("--picture", help="file for a picture")
    predictor.add_argument("--gpus", type=int, default=8, help="GPUs of a node (default: 8)")
    predictor.add_argument("--nodes", type=int, default=8, help="(default: 8)")
    predictor.add_argument("--node-bandwidth", type=float, default=50, help="GB/s that a node sends to others (default: 50)")
    predictor.add_argument("--node-latency", type=float, default=20, help="µs of an exchange between nodes (default: 20)")
    predictor.add_argument("--bandwidth", type=float, help="GB/s that a GPU sends to others, instead of the fitted one")
    predictor.add_argument("--latency", type=float, help="µs of an exchange between GPUs, instead of the fitted one")
    predictor.add_argument("--visible", type=float, help="share of the Gaussians that a view shows, if it was not measured")
    predictor.set_defaults(action=predict)
    own, passed_on = own_and_passed_on()
    arguments = parser.parse_args(own)
    arguments.options = passed_on[0] if passed_on else []
    arguments.action(arguments)


if __name__ == "__main__":
    main()
