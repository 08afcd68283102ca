# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Embeddings whose gradient is summed by warp-aggregated atomics."""
import torch

from . import rows as _rows
from .scatter import _check_index, _check_range


def embedding(input, weight, padding_idx=None, *, deterministic=None):
    """Returns the rows of `weight` that `input` names, of shape [*input.shape, width].

    The row `padding_idx` receives no gradient. The gradient of `weight` is dense.
    """
    if weight.dim() != 2:
        raise ValueError(f"embedding: weight has {weight.dim()} dimensions, but must have two")
    if not weight.is_floating_point() or weight.dtype not in _rows.DTYPES:
        raise TypeError(f"embedding: {weight.dtype} is not supported")
    _check_index("embedding", input)
    if input.device != weight.device:
        raise ValueError(f"embedding: input is on {input.device}, but weight is on {weight.device}")
    records, width = weight.shape
    if padding_idx is not None:
        if not -records <= padding_idx < records:
            raise IndexError(f"embedding: padding_idx is {padding_idx}, but weight has {records} rows")
        padding_idx %= records
    _check_range("embedding", input, records)
    index = input.reshape(-1).long()
    rows = _rows.TakeRows.apply(weight, index, _rows.is_deterministic(deterministic))
    if padding_idx is not None and rows.requires_grad:
        rows = _WithoutGradient.apply(rows, index == padding_idx)
    return rows.reshape(*input.shape, width)


class Embedding(torch.nn.Embedding):
    """`torch.nn.Embedding` with the gradient of `embedding`.

    `max_norm`, `scale_grad_by_freq` and `sparse` are not supported.
    """

    def __init__(self, *args, deterministic=None, **kwargs):
        super().__init__(*args, **kwargs)
        for name, unset in (("max_norm", None), ("scale_grad_by_freq", False), ("sparse", False)):
            if getattr(self, name) != unset:
                raise ValueError(f"Embedding: {name} is not supported")
        self.deterministic = deterministic

    def forward(self, input):
        return embedding(input, self.weight, self.padding_idx, deterministic=self.deterministic)


class _WithoutGradient(torch.autograd.Function):
    """Returns the rows; those that are masked have the gradient zero."""

    @staticmethod
    def forward(ctx, rows, mask):
        ctx.save_for_backward(mask)
        return rows.view_as(rows)

    @staticmethod
    def backward(ctx, gradient):
        mask, = ctx.saved_tensors
        return gradient.masked_fill(mask.unsqueeze(1), 0), None
