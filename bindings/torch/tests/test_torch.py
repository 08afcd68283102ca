# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Tests of warpagg.torch, on the CPU and on a GPU if there is one.

    python3 -m unittest discover -s bindings/torch/tests
"""
import subprocess
import sys
import unittest

import torch

import warpagg.torch as wt

DEVICES = ["cpu"] + (["cuda"] if wt.has_cuda and torch.cuda.is_available() else [])
FLOATS = (torch.float32, torch.float64, torch.float16, torch.bfloat16)
INTEGERS = (torch.int32, torch.int64)


def cases(**choices):
    """Every combination of the choices."""
    if not choices:
        yield {}
        return
    name, values = next(iter(choices.items()))
    for value in values:
        for rest in cases(**{k: v for k, v in choices.items() if k != name}):
            yield {name: value, **rest}


def whole_numbers(*shape, dtype, device, most=8):
    return torch.randint(-most, most + 1, shape, device=device).to(dtype)


def same_bits(a, b):
    return torch.equal(a.contiguous().view(torch.uint8), b.contiguous().view(torch.uint8))


class Test(unittest.TestCase):
    def setUp(self):
        torch.manual_seed(1)

    def equal(self, result, expected):
        self.assertEqual(result.dtype, expected.dtype)
        self.assertEqual(result.shape, expected.shape)
        self.assertTrue(torch.equal(result, expected), f"{result}\n{expected}")


class IndexAdd(Test):
    def test_every_dtype_width_and_order_of_keys(self):
        for c in cases(device=DEVICES, dtype=FLOATS + INTEGERS, width=(1, 3, 4, 16, 33, 64, 130),
                       deterministic=(False, True), order=("random", "sorted", "equal")):
            with self.subTest(**c):
                index = torch.randint(0, 20, (75,), device=c["device"])
                index = index.sort().values if c["order"] == "sorted" else index
                index = torch.full_like(index, 7) if c["order"] == "equal" else index
                # Sums of 75 such numbers are exact in every type except bfloat16.
                most = 1 if c["dtype"] == torch.bfloat16 else 8
                table = whole_numbers(20, c["width"], dtype=c["dtype"], device=c["device"], most=most)
                rows = whole_numbers(75, c["width"], dtype=c["dtype"], device=c["device"], most=most)
                expected = table.double().index_add(0, index, rows.double()).to(c["dtype"])
                self.equal(wt.index_add(table, 0, index, rows, deterministic=c["deterministic"]), expected)

    def test_dimensions_alpha_and_int32_index(self):
        for c in cases(device=DEVICES, dim=(0, 1, 2, -1)):
            with self.subTest(**c):
                table = whole_numbers(4, 5, 6, dtype=torch.float32, device=c["device"])
                index = torch.randint(0, table.shape[c["dim"]], (9,), device=c["device"])
                shape = list(table.shape)
                shape[c["dim"]] = 9
                source = whole_numbers(*shape, dtype=torch.float32, device=c["device"])
                expected = table.index_add(c["dim"], index, source, alpha=2)
                self.equal(wt.index_add(table, c["dim"], index.int(), source, alpha=2), expected)

    def test_in_place(self):
        for c in cases(device=DEVICES, dim=(0, 1), dtype=(torch.float32, torch.float16)):
            with self.subTest(**c):
                base = whole_numbers(6, 12, dtype=c["dtype"], device=c["device"])
                for table in (base, base[:, ::2], base.t()):
                    index = torch.randint(0, table.shape[c["dim"]], (9,), device=c["device"])
                    shape = list(table.shape)
                    shape[c["dim"]] = 9
                    source = whole_numbers(*shape, dtype=c["dtype"], device=c["device"])
                    expected = table.clone().index_add_(c["dim"], index, source)
                    self.assertIs(wt.index_add_(table, c["dim"], index, source), table)
                    self.equal(table, expected)

    def test_rows_that_are_not_aligned(self):
        for device in DEVICES:
            values = whole_numbers(1 + 40 * 4, dtype=torch.float32, device=device)
            rows = values[1:].view(40, 4)
            index = torch.randint(0, 9, (40,), device=device)
            table = torch.zeros(9, 4, device=device)
            for deterministic in (False, True):
                self.equal(wt.index_add(table, 0, index, rows, deterministic=deterministic),
                           table.index_add(0, index, rows))

    def test_empty_tensors(self):
        for c in cases(device=DEVICES, deterministic=(False, True)):
            table = torch.ones(3, 4, device=c["device"])
            none = torch.zeros(0, dtype=torch.long, device=c["device"])
            self.equal(wt.index_add(table, 0, none, table[:0], deterministic=c["deterministic"]), table)

    def test_error_against_float64(self):
        for c in cases(device=DEVICES, deterministic=(False, True), width=(1, 4, 64)):
            with self.subTest(**c):
                rows = torch.randn(20000, c["width"], device=c["device"])
                index = torch.randint(0, 300, (20000,), device=c["device"])
                table = torch.zeros(300, c["width"], device=c["device"])
                expected = table.double().index_add(0, index, rows.double())
                result = wt.index_add(table, 0, index, rows, deterministic=c["deterministic"]).double()
                sums = table.double().index_add(0, index, rows.double().abs())
                # Fixed point rounds once; otherwise each of about 70 additions rounds.
                bound = expected.abs() * 2**-23 + 1e-8 if c["deterministic"] else sums * 100 * 2**-24
                self.assertTrue(((result - expected).abs() <= bound).all())

    def test_gradients(self):
        for c in cases(device=DEVICES, deterministic=(False, True)):
            with self.subTest(**c):
                table = torch.randn(5, 3, dtype=torch.float64, device=c["device"], requires_grad=True)
                rows = torch.randn(8, 3, dtype=torch.float64, device=c["device"], requires_grad=True)
                index = torch.randint(0, 5, (8,), device=c["device"])

                def f(table, rows):
                    return wt.index_add(table, 0, index, rows, alpha=0.5, deterministic=c["deterministic"])

                self.assertTrue(torch.autograd.gradcheck(f, (table, rows)))
                self.assertTrue(torch.autograd.gradgradcheck(f, (table, rows)))


class Determinism(Test):
    def test_equal_bits_in_100_shuffled_runs(self):
        for c in cases(device=DEVICES, dtype=(torch.float32, torch.float64), width=(1, 4, 64)):
            with self.subTest(**c):
                n = 3000
                rows = (torch.randn(n, c["width"], dtype=torch.float64) *
                        torch.exp(4 * torch.randn(n, 1, dtype=torch.float64)))
                rows = rows.to(c["dtype"]).to(c["device"])
                index = (torch.rand(n) ** 4 * 50).long().to(c["device"])
                table = torch.randn(50, c["width"], device=c["device"], dtype=c["dtype"])
                expected = wt.index_add(table, 0, index, rows, deterministic=True)
                for _ in range(100):
                    order = torch.randperm(n, device=c["device"])
                    result = wt.index_add(table, 0, index[order], rows[order], deterministic=True)
                    self.assertTrue(same_bits(result, expected))

    def test_equal_bits_on_cpu_and_gpu(self):
        if len(DEVICES) == 1:
            self.skipTest("there is no GPU")
        for c in cases(dtype=(torch.float32, torch.float64), width=(1, 3, 4, 64)):
            with self.subTest(**c):
                rows = torch.randn(5000, c["width"], dtype=c["dtype"])
                index = torch.randint(0, 90, (5000,))
                table = torch.randn(90, c["width"], dtype=c["dtype"])
                results = [wt.index_add(table.to(d), 0, index.to(d), rows.to(d), deterministic=True).cpu()
                           for d in DEVICES]
                self.assertTrue(same_bits(*results))

    def test_number_of_threads_changes_no_bit(self):
        rows, index = torch.randn(5000, 5), torch.randint(0, 90, (5000,))
        threads = torch.get_num_threads()
        try:
            for deterministic in (False, True):
                results = []
                for count in (1, 2, 7):
                    torch.set_num_threads(count)
                    results.append(wt.index_add(torch.zeros(90, 5), 0, index, rows, deterministic=deterministic))
                self.assertTrue(all(same_bits(r, results[0]) for r in results))
        finally:
            torch.set_num_threads(threads)

    def test_default_follows_torch(self):
        # In fixed point, small values that large ones cancel are not lost.
        rows = torch.tensor([[1e8], [1.0], [-1e8]])
        index = torch.zeros(3, dtype=torch.long)
        try:
            for on, expected in ((False, 0.0), (True, 1.0)):
                torch.use_deterministic_algorithms(on)
                self.assertEqual(wt.index_add(torch.zeros(1, 1), 0, index, rows).item(), expected)
                self.assertEqual(wt.index_add(torch.zeros(1, 1), 0, index, rows, deterministic=True).item(), 1)
        finally:
            torch.use_deterministic_algorithms(False)

    def test_values_that_are_not_finite(self):
        infinity, nan = float("inf"), float("nan")
        for device in DEVICES:
            rows = torch.tensor([[infinity], [1], [infinity], [-infinity], [nan], [2], [-infinity]], device=device)
            index = torch.tensor([0, 0, 1, 1, 2, 3, 4], device=device)
            result = wt.index_add(torch.ones(5, 1, device=device), 0, index, rows, deterministic=True)
            expected = torch.tensor([[infinity], [nan], [nan], [3], [-infinity]], device=device)
            self.assertTrue(torch.allclose(result, expected, rtol=0, atol=0, equal_nan=True), f"{result}")


class ScatterAdd(Test):
    def test_index_of_every_shape(self):
        for c in cases(device=DEVICES, dim=(0, 1, -1), dtype=(torch.float32, torch.float16, torch.int64),
                       deterministic=(False, True)):
            with self.subTest(**c):
                table = whole_numbers(5, 6, 7, dtype=c["dtype"], device=c["device"])
                for shape in ((5, 6, 7), (4, 3, 2), (1, 6, 1)):
                    source = whole_numbers(5, 6, 7, dtype=c["dtype"], device=c["device"])
                    index = torch.randint(0, table.shape[c["dim"]], shape, device=c["device"])
                    expected = table.clone().scatter_add_(c["dim"], index, source)
                    self.equal(wt.scatter_add(table, c["dim"], index, source, deterministic=c["deterministic"]),
                               expected)
                    copy = table.clone()
                    wt.scatter_add_(copy, c["dim"], index, source, deterministic=c["deterministic"])
                    self.equal(copy, expected)

    def test_expanded_index(self):
        for c in cases(device=DEVICES, dim=(0, 1)):
            with self.subTest(**c):
                table = whole_numbers(5, 6, dtype=torch.float32, device=c["device"])
                source = whole_numbers(*((20, 6) if c["dim"] == 0 else (5, 20)), dtype=torch.float32,
                                       device=c["device"])
                index = torch.randint(0, table.shape[c["dim"]], (20,), device=c["device"])
                index = index.unsqueeze(1 - c["dim"]).expand_as(source)
                self.equal(wt.scatter_add(table, c["dim"], index, source),
                           table.scatter_add(c["dim"], index, source))

    def test_gradients(self):
        for device in DEVICES:
            table = torch.randn(5, 3, dtype=torch.float64, device=device, requires_grad=True)
            source = torch.randn(8, 3, dtype=torch.float64, device=device, requires_grad=True)
            for index in (torch.randint(0, 5, (7, 2), device=device),
                          torch.randint(0, 5, (8, 1), device=device).expand(8, 3)):
                f = lambda table, source: wt.scatter_add(table, 0, index, source)
                self.assertTrue(torch.autograd.gradcheck(f, (table, source)))
                self.assertTrue(torch.autograd.gradgradcheck(f, (table, source)))


class ScatterReduce(Test):
    def test_values(self):
        for c in cases(device=DEVICES, reduce=("sum", "mean", "amax", "amin"), include_self=(True, False),
                       dtype=(torch.float32, torch.float64, torch.float16, torch.int32, torch.int64),
                       expanded=(False, True)):
            with self.subTest(**c):
                table = whole_numbers(9, 5, dtype=c["dtype"], device=c["device"])
                source = whole_numbers(20, 5, dtype=c["dtype"], device=c["device"])
                shape = (20, 1) if c["expanded"] else (20, 5)
                index = torch.randint(0, 7, shape, device=c["device"]).expand(20, 5)
                # PyTorch computes halves on a GPU only.
                wide = torch.float32 if c["dtype"] == torch.float16 else c["dtype"]
                expected = table.to(wide).scatter_reduce(0, index, source.to(wide), c["reduce"],
                                                         include_self=c["include_self"]).to(c["dtype"])
                self.equal(wt.scatter_reduce(table, 0, index, source, c["reduce"],
                                             include_self=c["include_self"]), expected)

    def test_extremes_of_special_values(self):
        infinity, nan = float("inf"), float("nan")
        for c in cases(device=DEVICES, dtype=(torch.float32, torch.float64)):
            with self.subTest(**c):
                values = torch.tensor([[1.0], [nan], [-infinity], [-2.0], [infinity], [-1.0], [-3.0]], **c)
                index = torch.tensor([[0], [0], [1], [1], [2], [3], [3]], device=c["device"])
                start = torch.zeros(4, 1, **c)
                for reduce, expected in (("amax", [nan, -2.0, infinity, -1.0]),
                                         ("amin", [nan, -infinity, infinity, -3.0])):
                    result = wt.scatter_reduce(start, 0, index, values, reduce, include_self=False)
                    self.assertTrue(torch.allclose(result[:, 0], torch.tensor(expected, **c), equal_nan=True))

    def test_gradients(self):
        for c in cases(device=DEVICES, reduce=("sum", "mean", "amax", "amin"), include_self=(True, False)):
            with self.subTest(**c):
                table = torch.randn(5, 3, dtype=torch.float64, device=c["device"], requires_grad=True)
                source = torch.randn(8, 3, dtype=torch.float64, device=c["device"], requires_grad=True)
                index = torch.randint(0, 4, (8, 3), device=c["device"])
                f = lambda table, source: wt.scatter_reduce(table, 0, index, source, c["reduce"],
                                                            include_self=c["include_self"])
                self.assertTrue(torch.autograd.gradcheck(f, (table, source)))
                self.assertTrue(torch.autograd.gradgradcheck(f, (table, source)))

    def test_equal_values_share_the_gradient(self):
        table = torch.tensor([[2.0]], requires_grad=True)
        source = torch.tensor([[2.0], [2.0], [1.0]], requires_grad=True)
        index = torch.zeros(3, 1, dtype=torch.long)
        wt.scatter_reduce(table, 0, index, source, "amax").sum().backward()
        self.assertEqual(table.grad.item(), torch.tensor(1 / 3).item())
        self.assertEqual(source.grad[:, 0].tolist(), torch.tensor([1 / 3, 1 / 3, 0]).tolist())


class EmbeddingGradient(Test):
    def test_as_torch(self):
        for c in cases(device=DEVICES, deterministic=(False, True), padding_idx=(None, 3, -1)):
            with self.subTest(**c):
                index = torch.randint(0, 9, (4, 5), device=c["device"])
                weight = whole_numbers(9, 6, dtype=torch.float32, device=c["device"])
                upstream = whole_numbers(4, 5, 6, dtype=torch.float32, device=c["device"])
                gradients = []
                for lookup in (torch.nn.functional.embedding,
                               lambda *a, **k: wt.embedding(*a, deterministic=c["deterministic"], **k)):
                    w = weight.clone().requires_grad_()
                    result = lookup(index, w, padding_idx=c["padding_idx"])
                    self.equal(result.detach(), weight[index])
                    result.backward(upstream)
                    gradients.append(w.grad)
                self.equal(gradients[1], gradients[0])

    def test_module(self):
        module = wt.Embedding(9, 4, padding_idx=0, deterministic=True)
        index = torch.tensor([0, 1, 1, 8])
        module(index).sum().backward()
        self.assertEqual(module.weight.grad[:, 0].tolist(), [0, 2, 0, 0, 0, 0, 0, 0, 1])

    def test_gradients(self):
        for c in cases(device=DEVICES, deterministic=(False, True), padding_idx=(None, 2)):
            with self.subTest(**c):
                weight = torch.randn(5, 3, dtype=torch.float64, device=c["device"], requires_grad=True)
                # The index avoids the padding row: its gradient is zero, but gradcheck perturbs it.
                index = torch.tensor([[0, 1, 1], [4, 4, 3]], device=c["device"])
                f = lambda weight: wt.embedding(index, weight, c["padding_idx"], deterministic=c["deterministic"])
                self.assertTrue(torch.autograd.gradcheck(f, (weight,)))
                self.assertTrue(torch.autograd.gradgradcheck(f, (weight,)))


class WrongArguments(Test):
    def rejects(self, error, sentence, function, *args, **kwargs):
        with self.assertRaises(error) as caught:
            function(*args, **kwargs)
        self.assertEqual(str(caught.exception), sentence)

    def test_index_add(self):
        table, index, rows = torch.zeros(4, 3), torch.tensor([0, 1]), torch.zeros(2, 3)
        self.rejects(IndexError, "index_add: index 4 is out of range for size 4", wt.index_add, table, 0,
                     torch.tensor([0, 4]), rows)
        self.rejects(IndexError, "index_add_: index -1 is out of range for size 4", wt.index_add_, table, 0,
                     torch.tensor([-1, 3]), rows)
        self.rejects(IndexError, "index_add: dim is 2, but input has 2 dimensions", wt.index_add, table, 2, index,
                     rows)
        self.rejects(TypeError, "index_add: index has dtype torch.float32, but must have int32 or int64",
                     wt.index_add, table, 0, index.float(), rows)
        self.rejects(TypeError, "index_add: source has dtype torch.float64, but input has torch.float32",
                     wt.index_add, table, 0, index, rows.double())
        self.rejects(TypeError, "index_add: torch.int8 is not supported", wt.index_add, table.to(torch.int8), 0,
                     index, rows.to(torch.int8))
        self.rejects(ValueError, "index_add: index has 2 dimensions, but must have one", wt.index_add, table, 0,
                     index.view(2, 1), rows)
        self.rejects(ValueError, "index_add: source has shape [2, 2], but input and index need [2, 3]",
                     wt.index_add, table, 0, index, rows[:, :2])
        self.rejects(ValueError, "index_add: input has no dimensions, but must have at least one", wt.index_add,
                     torch.tensor(0.0), 0, index, rows)
        self.rejects(RuntimeError, "index_add_: it has no gradient, so use index_add or torch.no_grad()",
                     wt.index_add_, table, 0, index, rows.clone().requires_grad_())
        self.rejects(ValueError, "index_add: input, index and source are on cpu, cpu and meta, but must be on one "
                     "device", wt.index_add, table, 0, index, rows.to("meta"))

    def test_scatter(self):
        table, source = torch.zeros(4, 3), torch.zeros(2, 3)
        index = torch.zeros(2, 3, dtype=torch.long)
        self.rejects(IndexError, "scatter_add: index 4 is out of range for size 4", wt.scatter_add, table, 0,
                     index + 4, source)
        self.rejects(ValueError, "scatter_add: input, index and src have 2, 1 and 2 dimensions, but must have "
                     "equally many", wt.scatter_add, table, 0, index[0], source)
        self.rejects(ValueError, "scatter_add: index has size 3 in dimension 0, but src only 2", wt.scatter_add,
                     table, 0, torch.zeros(3, 3, dtype=torch.long), source)
        self.rejects(ValueError, "scatter_add: index has size 5 in dimension 0, but input only 4", wt.scatter_add,
                     table, 1, torch.zeros(5, 3, dtype=torch.long), torch.zeros(5, 3))
        self.rejects(ValueError, "scatter_reduce: reduce is 'prod', but must be one of sum, mean, amax, amin",
                     wt.scatter_reduce, table, 0, index, source, "prod")
        self.rejects(RuntimeError, "scatter_add_: it has no gradient, so use scatter_add or torch.no_grad()",
                     wt.scatter_add_, table, 0, index, source.clone().requires_grad_())

    def test_embedding(self):
        weight, index = torch.zeros(4, 3), torch.tensor([0, 4])
        self.rejects(IndexError, "embedding: index 4 is out of range for size 4", wt.embedding, index, weight)
        self.rejects(IndexError, "embedding: padding_idx is 4, but weight has 4 rows", wt.embedding, index[:1],
                     weight, 4)
        self.rejects(ValueError, "embedding: weight has 1 dimensions, but must have two", wt.embedding, index,
                     weight[0])
        self.rejects(TypeError, "embedding: torch.int64 is not supported", wt.embedding, index, weight.long())
        self.rejects(ValueError, "Embedding: sparse is not supported", wt.Embedding, 4, 3, sparse=True)

    def test_index_out_of_range_on_a_gpu(self):
        if len(DEVICES) == 1:
            self.skipTest("there is no GPU")
        # The assertion ends all further work of a process on the GPU.
        program = ("import torch, warpagg.torch as wt\n"
                   "wt.index_add(torch.zeros(4, 4, device='cuda'), 0, torch.tensor([4], device='cuda'), "
                   "torch.ones(1, 4, device='cuda'))\n"
                   "torch.cuda.synchronize()\n")
        done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("warpagg: an index is out of range", done.stderr + done.stdout)


if __name__ == "__main__":
    unittest.main()
