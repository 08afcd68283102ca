# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""The headers as a package of Conan 2, from the sources that contain this file: conan create packaging/conan"""
import os
import re

from conan import ConanFile
from conan.tools.files import copy, load

ROOT = os.path.join("..", "..")


class Warpagg(ConanFile):
    name = "warpagg"
    description = "Header-only library of warp-aggregated atomics, with a CPU emulator"
    license = "MIT"
    package_type = "header-library"
    no_copy_source = True

    def set_version(self):
        text = load(self, os.path.join(self.recipe_folder, ROOT, "include", "warpagg", "version.hpp"))
        self.version = ".".join(re.findall(r"#define WARPAGG_VERSION_\w+ (\d+)", text))

    def export_sources(self):
        root = os.path.join(self.recipe_folder, ROOT)
        for pattern in ("include/*", "cmake/emulate_cuda.cmake", "LICENSE"):
            copy(self, pattern, src=root, dst=self.export_sources_folder)

    def package(self):
        source, package = self.source_folder, self.package_folder
        copy(self, "*", src=os.path.join(source, "include"), dst=os.path.join(package, "include"))
        copy(self, "emulate_cuda.cmake", src=os.path.join(source, "cmake"),
             dst=os.path.join(package, "share", "cmake", "warpagg"))
        copy(self, "LICENSE", src=source, dst=os.path.join(package, "licenses"))

    def package_id(self):
        self.info.clear()

    def package_info(self):
        self.cpp_info.bindirs = []
        self.cpp_info.libdirs = []
        # For the function warpagg_emulate_cuda.
        self.cpp_info.set_property("cmake_build_modules", ["share/cmake/warpagg/emulate_cuda.cmake"])
