# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Compares warpagg.torch with PyTorch on a GPU, and prints tables.

    python3 bindings/torch/benchmark.py

Times are medians of 9 rounds, in milliseconds. In each round all variants run once, one after the other.
"""
import argparse
import statistics

import torch

import warpagg.torch as wt

ROUNDS = 9


def milliseconds(run):
    """The time of run() on the GPU. The GPU is busy while Python enqueues the work."""
    start, end = torch.cuda.Event(enable_timing=True), torch.cuda.Event(enable_timing=True)
    torch.cuda._sleep(2_000_000)
    start.record()
    run()
    end.record()
    end.synchronize()
    return start.elapsed_time(end)


def deterministic_torch(run):
    def with_setting():
        torch.use_deterministic_algorithms(True)
        try:
            run()
        finally:
            torch.use_deterministic_algorithms(False)
    return with_setting


def draw_index(keys, n, records):
    if keys == "Zipf":  # the k-th most frequent record has a share of about 1 / k
        unit = torch.rand(n, dtype=torch.float64, device="cuda")
        return (torch.exp(unit * torch.log(torch.tensor(float(records)))).long() - 1).clamp_(0, records - 1)
    index = torch.randint(0, records, (n,), device="cuda")
    return index.sort().values if keys == "sorted" else index


def index_add_variants(table, index, rows):
    return {
        "torch": lambda: table.index_add_(0, index, rows),
        "warpagg": lambda: wt.index_add_(table, 0, index, rows, deterministic=False),
        "torch, deterministic": deterministic_torch(lambda: table.index_add_(0, index, rows)),
        "warpagg, deterministic": lambda: wt.index_add_(table, 0, index, rows, deterministic=True),
    }


def scatter_add_variants(table, index, rows):
    index = index.view(-1, 1).expand_as(rows)
    return {
        "torch": lambda: table.scatter_add_(0, index, rows),
        "warpagg": lambda: wt.scatter_add_(table, 0, index, rows, deterministic=False),
        "torch, deterministic": deterministic_torch(lambda: table.scatter_add_(0, index, rows)),
        "warpagg, deterministic": lambda: wt.scatter_add_(table, 0, index, rows, deterministic=True),
    }


def embedding_variants(table, index, rows):
    weight = table.clone().requires_grad_()

    def backward(lookup):
        result = lookup(index, weight)

        def run():
            torch.autograd.grad(result, weight, rows, retain_graph=True)
        return run

    return {
        "torch": backward(torch.nn.functional.embedding),
        "warpagg": backward(lambda i, w: wt.embedding(i, w, deterministic=False)),
        "torch, deterministic": deterministic_torch(backward(torch.nn.functional.embedding)),
        "warpagg, deterministic": backward(lambda i, w: wt.embedding(i, w, deterministic=True)),
    }


def measure(make_variants, keys, width, values):
    n = values // max(width, 4)
    records = n // 16
    index = draw_index(keys, n, records)
    rows = torch.rand(n, width, device="cuda")
    variants = make_variants(torch.zeros(records, width, device="cuda"), index, rows)
    times = {name: [] for name in variants}
    for turn in range(ROUNDS + 2):  # the first two warm up
        for name, run in variants.items():
            time = milliseconds(run)
            if turn >= 2:
                times[name].append(time)
    return {name: statistics.median(t) for name, t in times.items()}


def print_table(title, make_variants, values):
    print(f"\n{title}\n")
    header = None
    for width in (1, 4, 64):
        for keys in ("uniform", "Zipf", "sorted"):
            times = measure(make_variants, keys, width, values)
            if header is None:
                header = ["rows of", "keys", *times, "faster", "deterministic / torch"]
                print("| " + " | ".join(header) + " |\n" + "| --- " * len(header) + "|")
            cells = [str(width), keys, *(f"{t:.3f}" for t in times.values()),
                     f"{times['torch'] / times['warpagg']:.2f}x",
                     f"{times['warpagg, deterministic'] / times['torch']:.2f}"]
            print("| " + " | ".join(cells) + " |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--values", type=int, default=1 << 24, help="number of values in rows of 4 and more")
    options = parser.parse_args()
    if not (wt.has_cuda and torch.cuda.is_available()):
        raise SystemExit("error: the benchmark needs a GPU, and warpagg.torch built with CUDA")
    torch.manual_seed(1)
    print(f"PyTorch {torch.__version__}, {torch.cuda.get_device_name()}, milliseconds")
    print_table("index_add_", index_add_variants, options.values)
    print_table("scatter_add_ with an expanded index", scatter_add_variants, options.values)
    print_table("Gradient of an embedding", embedding_variants, options.values)


if __name__ == "__main__":
    main()
