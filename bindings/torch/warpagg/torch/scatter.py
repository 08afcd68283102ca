# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""index_add, scatter_add and scatter_reduce."""
import math

import torch

from . import rows as _rows

REDUCTIONS = ("sum", "mean", "amax", "amin")


class _Layout:
    """The table, index and rows of an operation, and the way back to the shape of its input."""

    def __init__(self, moved, dim, index, rows):
        self.shape, self.dim = moved.shape, dim
        self.width = rows.shape[1]
        self.index, self.rows = index, rows

    def table(self, input):
        return input.movedim(self.dim, 0).reshape(-1, self.width)

    def restore(self, table):
        return table.reshape(self.shape).movedim(0, self.dim)


def index_add(input, dim, index, source, *, alpha=1, deterministic=None):
    """Returns `input` with slice i of `source` times `alpha` added to slice index[i], along `dim`.

    `index` has shape [n]; `source` has the shape of `input`, but n slices along `dim`.
    """
    layout = _index_layout("index_add", input, dim, index, _scaled(source, alpha))
    return _add(input, layout, deterministic)


def index_add_(input, dim, index, source, *, alpha=1, deterministic=None):
    """As `index_add`, but changes `input` and returns it. It has no gradients."""
    _require_no_gradient("index_add", input, source)
    layout = _index_layout("index_add_", input, dim, index, _scaled(source, alpha))
    return _add_in_place(input, layout, deterministic)


def scatter_add(input, dim, index, src, *, deterministic=None):
    """Returns `input` with each value of `src` added at the place that `index` names along `dim`.

    An index that is expanded along all other dimensions, as by `index.view(-1, 1).expand_as(src)`,
    is as fast as `index_add`.
    """
    layout = _scatter_layout("scatter_add", input, dim, index, src)
    return _add(input, layout, deterministic)


def scatter_add_(input, dim, index, src, *, deterministic=None):
    """As `scatter_add`, but changes `input` and returns it. It has no gradients."""
    _require_no_gradient("scatter_add", input, src)
    layout = _scatter_layout("scatter_add_", input, dim, index, src)
    return _add_in_place(input, layout, deterministic)


def scatter_reduce(input, dim, index, src, reduce, *, include_self=True, deterministic=None):
    """Returns the sum, mean, amax or amin of the values of `src` that `index` sends to each place.

    With `include_self`, the value of `input` is one of them. A place without values keeps it. The
    gradient of amax and amin is distributed evenly among equal values.
    """
    if reduce not in REDUCTIONS:
        raise ValueError(f"scatter_reduce: reduce is {reduce!r}, but must be one of {', '.join(REDUCTIONS)}")
    layout = _scatter_layout("scatter_reduce", input, dim, index, src)
    table = layout.table(input)
    if reduce in ("amax", "amin"):
        result = _rows.ExtremeRows.apply(table, layout.index, layout.rows, reduce == "amin", include_self,
                                         _rows.is_deterministic(deterministic))
        return layout.restore(result)
    counts = None
    if reduce == "mean" or not include_self:
        counts = _rows.count_rows(layout.index, table.shape[0])
    if not include_self:
        table = torch.where(counts == 0, table, torch.zeros((), dtype=table.dtype, device=table.device))
    sums = _rows.AddRows.apply(table, layout.index, layout.rows, _rows.is_deterministic(deterministic))
    if reduce == "mean":
        counts = counts + 1 if include_self else counts.clamp(min=1)
        # A half cannot hold large counts.
        if sums.dtype in _rows.HALVES:
            sums = (sums.float() / counts).to(sums.dtype)
        elif sums.is_floating_point():
            sums = sums / counts.to(sums.dtype)
        else:
            sums = torch.div(sums, counts, rounding_mode="floor").to(sums.dtype)
    return layout.restore(sums)


def _add(input, layout, deterministic):
    table = _rows.AddRows.apply(layout.table(input), layout.index, layout.rows,
                                _rows.is_deterministic(deterministic))
    return layout.restore(table)


def _add_in_place(input, layout, deterministic):
    with torch.no_grad():
        table = layout.table(input).contiguous()
        _rows.add_rows_(table, layout.index, layout.rows, _rows.is_deterministic(deterministic))
        if table.data_ptr() != input.data_ptr():  # a copy
            input.copy_(layout.restore(table))
    return input


def _scaled(source, alpha):
    return source if alpha == 1 else source * alpha


def _index_layout(name, input, dim, index, source):
    dim = _checked_dim(name, input, dim)
    _check_tensors(name, input, index, source, "source")
    if index.dim() != 1:
        raise ValueError(f"{name}: index has {index.dim()} dimensions, but must have one")
    expected = list(input.shape)
    expected[dim] = index.numel()
    if list(source.shape) != expected:
        raise ValueError(f"{name}: source has shape {list(source.shape)}, but input and index need {expected}")
    _check_range(name, index, input.shape[dim])
    return _whole_slices(input, dim, index, source)


def _scatter_layout(name, input, dim, index, src):
    dim = _checked_dim(name, input, dim)
    _check_tensors(name, input, index, src, "src")
    if not input.dim() == index.dim() == src.dim():
        raise ValueError(f"{name}: input, index and src have {input.dim()}, {index.dim()} and {src.dim()} "
                         "dimensions, but must have equally many")
    for d in range(input.dim()):
        if index.shape[d] > src.shape[d]:
            raise ValueError(f"{name}: index has size {index.shape[d]} in dimension {d}, but src only "
                             f"{src.shape[d]}")
        if d != dim and index.shape[d] > input.shape[d]:
            raise ValueError(f"{name}: index has size {index.shape[d]} in dimension {d}, but input only "
                             f"{input.shape[d]}")
    _check_range(name, index, input.shape[dim])
    if src.shape != index.shape:
        src = src[tuple(slice(0, size) for size in index.shape)]

    others = [d for d in range(input.dim()) if d != dim]
    if all(index.shape[d] == input.shape[d] and (index.stride(d) == 0 or index.shape[d] == 1) for d in others):
        one_slice = index.movedim(dim, 0).reshape(index.shape[dim], -1)[:, :1]
        if one_slice.shape[1] == 1:
            return _whole_slices(input, dim, one_slice.reshape(-1), src)
    # Each value is a row of its own, and the table one long column.
    moved = input.movedim(dim, 0)
    size = math.prod(moved.shape[1:])
    if moved.numel() >= 2**32:
        raise ValueError(f"{name}: input has {moved.numel()} values, but at most 2^32 - 1 are supported")
    places = torch.arange(size, device=index.device).reshape(moved.shape[1:])
    index = index.movedim(dim, 0)
    places = places[tuple(slice(0, s) for s in index.shape[1:])]
    return _Layout(moved, dim, (index * size + places).reshape(-1).long(), src.movedim(dim, 0).reshape(-1, 1))


def _whole_slices(input, dim, index, source):
    moved = input.movedim(dim, 0)
    width = math.prod(moved.shape[1:])
    return _Layout(moved, dim, index.long(), source.movedim(dim, 0).reshape(index.numel(), width))


def _checked_dim(name, input, dim):
    if input.dim() == 0:
        raise ValueError(f"{name}: input has no dimensions, but must have at least one")
    if not -input.dim() <= dim < input.dim():
        raise IndexError(f"{name}: dim is {dim}, but input has {input.dim()} dimensions")
    return dim % input.dim()


def _check_tensors(name, input, index, source, source_name):
    if input.dtype not in _rows.DTYPES:
        raise TypeError(f"{name}: {input.dtype} is not supported")
    if source.dtype != input.dtype:
        raise TypeError(f"{name}: {source_name} has dtype {source.dtype}, but input has {input.dtype}")
    _check_index(name, index)
    if not input.device == index.device == source.device:
        raise ValueError(f"{name}: input, index and {source_name} are on {input.device}, {index.device} and "
                         f"{source.device}, but must be on one device")


def _check_index(name, index):
    if index.dtype not in (torch.int32, torch.int64):
        raise TypeError(f"{name}: index has dtype {index.dtype}, but must have int32 or int64")


def _check_range(name, index, size):
    """On a GPU a device-side assertion checks the range, without a copy to the host."""
    if index.device.type != "cpu" or index.numel() == 0:
        return
    least, most = int(index.min()), int(index.max())
    if least < 0 or most >= size:
        raise IndexError(f"{name}: index {least if least < 0 else most} is out of range for size {size}")


def _require_no_gradient(name, input, source):
    if torch.is_grad_enabled() and (input.requires_grad or source.requires_grad):
        raise RuntimeError(f"{name}_: it has no gradient, so use {name} or torch.no_grad()")
