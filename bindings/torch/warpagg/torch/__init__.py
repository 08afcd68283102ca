# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Scatter and embedding operations for PyTorch with warp-aggregated atomics.

The functions have the names, the arguments and the gradients of PyTorch's. Each also takes
`deterministic`: with True, results have the same bits in every run, on every GPU and on the CPU, and
for any order of the rows. The default, None, follows `torch.use_deterministic_algorithms`.
"""
from ._extension import has_cuda
from .embedding import Embedding, embedding
from .scatter import index_add, index_add_, scatter_add, scatter_add_, scatter_reduce

__all__ = ["Embedding", "embedding", "has_cuda", "index_add", "index_add_", "scatter_add", "scatter_add_",
           "scatter_reduce"]
