# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Rows and tables: the operations on tensors of two dimensions that all others are built from.

A table has shape [records, width], rows have shape [n, width], and an index of shape [n] names the
record of each row.
"""
import torch

from . import _extension

HALVES = (torch.float16, torch.bfloat16)
DTYPES = HALVES + (torch.float32, torch.float64, torch.int32, torch.int64)


def is_deterministic(deterministic):
    return torch.are_deterministic_algorithms_enabled() if deterministic is None else bool(deterministic)


def add_rows_(table, index, rows, deterministic):
    """table[index[i]] += rows[i], without gradients. The table is contiguous."""
    if table.dtype in HALVES:  # sums are kept in float32 and rounded once
        sums = table.float()
        add_rows_(sums, index, rows.float(), deterministic)
        table.copy_(sums)
    else:
        _extension.add_rows_(table, index.contiguous(), rows.contiguous(),
                             deterministic and table.is_floating_point())


def extreme_rows(table, index, rows, smallest):
    """Returns the largest, or smallest, values of each record and its rows, without gradients."""
    if table.dtype in HALVES:
        return extreme_rows(table.float(), index, rows.float(), smallest).to(table.dtype)
    result = table.clone(memory_format=torch.contiguous_format)
    _extension.extreme_rows_(result, index.contiguous(), rows.contiguous(), smallest)
    return result


def count_rows(index, records):
    """Returns the number of rows of each record, of shape [records, 1]."""
    counts = index.new_zeros((records, 1))
    add_rows_(counts, index, torch.ones_like(index).unsqueeze(1), False)
    return counts


class AddRows(torch.autograd.Function):
    """Returns the table with the rows added to it."""

    @staticmethod
    def forward(ctx, table, index, rows, deterministic):
        ctx.save_for_backward(index)
        ctx.deterministic = deterministic
        result = table.clone(memory_format=torch.contiguous_format)
        add_rows_(result, index, rows, deterministic)
        return result

    @staticmethod
    def backward(ctx, gradient):
        index, = ctx.saved_tensors
        return gradient, None, TakeRows.apply(gradient, index, ctx.deterministic), None


class SumRows(torch.autograd.Function):
    """Returns a table of zeros with the rows added to it."""

    @staticmethod
    def forward(ctx, index, rows, records, deterministic):
        ctx.save_for_backward(index)
        ctx.deterministic = deterministic
        result = rows.new_zeros((records, rows.shape[1]))
        add_rows_(result, index, rows, deterministic)
        return result

    @staticmethod
    def backward(ctx, gradient):
        index, = ctx.saved_tensors
        return None, TakeRows.apply(gradient, index, ctx.deterministic), None, None


class TakeRows(torch.autograd.Function):
    """Returns the records that the index names. Its gradient is a `SumRows`."""

    @staticmethod
    def forward(ctx, table, index, deterministic):
        ctx.save_for_backward(index)
        ctx.records, ctx.deterministic = table.shape[0], deterministic
        return table.index_select(0, index)

    @staticmethod
    def backward(ctx, gradient):
        index, = ctx.saved_tensors
        return SumRows.apply(index, gradient, ctx.records, ctx.deterministic), None, None


class ExtremeRows(torch.autograd.Function):
    """Returns the table with the largest, or smallest, of each record and its rows.

    The gradient of a result is distributed evenly among the values that equal it. A record without
    `include_self` counts only if it has no rows.
    """

    @staticmethod
    def forward(ctx, table, index, rows, smallest, include_self, deterministic):
        start, takes_part = table, None
        if not include_self:
            takes_part = count_rows(index, table.shape[0]) == 0
            start = torch.where(takes_part, table, _neutral(table.dtype, smallest, table.device))
        result = extreme_rows(start, index, rows, smallest)
        ctx.deterministic = deterministic
        if any(ctx.needs_input_grad):
            of_record = table == result if include_self else (table == result) & takes_part
            of_row = (rows == result.index_select(0, index)).to(rows.dtype)
            ties = of_record.to(rows.dtype)
            counts = ties.clone()
            add_rows_(counts, index, of_row, deterministic)
            ctx.save_for_backward(index, ties / counts, of_row / counts.index_select(0, index))
        return result

    @staticmethod
    def backward(ctx, gradient):
        index, share_of_record, share_of_row = ctx.saved_tensors
        of_rows = TakeRows.apply(gradient, index, ctx.deterministic) * share_of_row
        return gradient * share_of_record, None, of_rows, None, None, None


def _neutral(dtype, smallest, device):
    if dtype.is_floating_point:
        value = float("inf") if smallest else float("-inf")
    else:
        value = torch.iinfo(dtype).max if smallest else torch.iinfo(dtype).min
    return torch.full((), value, dtype=dtype, device=device)
