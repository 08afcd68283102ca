# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Builds the package warpagg for PyTorch: with CUDA if PyTorch has CUDA and nvcc is found.

    pip install --no-build-isolation ./bindings/torch

The environment variable WARPAGG_TORCH_CUDA=0 builds the CPU part only.
"""
import os
import re
from pathlib import Path

import torch
from setuptools import setup
from torch.utils import cpp_extension

here = Path(__file__).resolve().parent
include = here.parents[1] / "include"
version_text = (include / "warpagg/version.hpp").read_text()
version = ".".join(re.findall(r"#define WARPAGG_VERSION_\w+ (\d+)\n", version_text))

with_cuda = (torch.version.cuda is not None and cpp_extension.CUDA_HOME is not None
             and os.environ.get("WARPAGG_TORCH_CUDA") != "0")
# PyTorch asks for C++17 unless a flag names another standard. Its headers use names that C++20
# deprecates.
flags = {"cxx": ["-std=c++20", "-O3", "-fopenmp", "-Wno-deprecated-declarations"], "nvcc": ["-std=c++20", "-O3"]}
sources = ["csrc/bindings.cpp"] + (["csrc/cuda.cu"] if with_cuda else [])
extension = (cpp_extension.CUDAExtension if with_cuda else cpp_extension.CppExtension)(
    "warpagg.torch._extension",
    sources,
    include_dirs=[str(include)],
    define_macros=[("WARPAGG_TORCH_CUDA", None)] if with_cuda else [],
    extra_compile_args=flags,
)

setup(
    name="warpagg",
    version=version,
    description="Scatter and embedding operations for PyTorch with warp-aggregated atomics",
    license="MIT",
    python_requires=">=3.9",
    packages=["warpagg", "warpagg.torch"],
    ext_modules=[extension],
    cmdclass={"build_ext": cpp_extension.BuildExtension},
)
