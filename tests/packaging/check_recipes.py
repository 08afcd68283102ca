#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Fails if the recipes for vcpkg and Conan do not package the version, the headers and the license.

The test runs both recipes. Simple functions stand for those of vcpkg and Conan, because neither is a
package of Debian. It does not replace a run of these tools.
"""
import fnmatch
import importlib.util
import json
import pathlib
import py_compile
import re
import shutil
import subprocess
import sys
import tempfile
import types

ROOT = pathlib.Path(__file__).resolve().parents[2]
RECIPES = ROOT / "packaging"
VCPKG = """
function(vcpkg_cmake_configure)
    cmake_parse_arguments(PARSE_ARGV 0 arg "" SOURCE_PATH OPTIONS)
    execute_process(COMMAND ${CMAKE_COMMAND} -S ${arg_SOURCE_PATH} -B ${BUILD} ${arg_OPTIONS}
        -DCMAKE_INSTALL_PREFIX=${CURRENT_PACKAGES_DIR} OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
endfunction()
function(vcpkg_cmake_install)
    execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
endfunction()
function(vcpkg_cmake_config_fixup)
    cmake_parse_arguments(PARSE_ARGV 0 arg "" CONFIG_PATH "")
    file(RENAME ${CURRENT_PACKAGES_DIR}/${arg_CONFIG_PATH} ${CURRENT_PACKAGES_DIR}/share/${PORT})
endfunction()
function(vcpkg_install_copyright)
    cmake_parse_arguments(PARSE_ARGV 0 arg "" "" FILE_LIST)
    file(READ ${arg_FILE_LIST} text)
    file(WRITE ${CURRENT_PACKAGES_DIR}/share/${PORT}/copyright "${text}")
endfunction()
include(${PORTFILE})
"""


def copy(_, pattern, src, dst):
    """Stands for conan.tools.files.copy, whose patterns match whole relative paths."""
    files = [p for p in pathlib.Path(src).rglob("*") if p.is_file()]
    for file in (p for p in files if fnmatch.fnmatch(str(p.relative_to(src)), pattern)):
        target = pathlib.Path(dst, file.relative_to(src))
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(file, target)


def load_conan_recipe():
    conan, tools, files = (types.ModuleType(name) for name in ("conan", "conan.tools", "conan.tools.files"))
    conan.ConanFile = object
    files.copy, files.load = copy, lambda _, path: pathlib.Path(path).read_text()
    sys.modules.update({m.__name__: m for m in (conan, tools, files)})
    spec = importlib.util.spec_from_file_location("recipe", RECIPES / "conan/conanfile.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.Warpagg()


def package_with_conan(work):
    recipe = load_conan_recipe()
    recipe.recipe_folder = str(RECIPES / "conan")
    recipe.export_sources_folder = recipe.source_folder = str(work / "conan_sources")
    recipe.package_folder = str(work / "conan")
    recipe.set_version()
    recipe.export_sources()
    recipe.package()
    return recipe.version


def package_with_vcpkg(work):
    script = work / "vcpkg.cmake"
    script.write_text(VCPKG)
    subprocess.run(["cmake", "-DPORT=warpagg", f"-DCURRENT_PACKAGES_DIR={work}/vcpkg", f"-DBUILD={work}/build",
                    f"-DPORTFILE={RECIPES}/vcpkg/portfile.cmake", "-P", script], check=True)
    return json.loads((RECIPES / "vcpkg/vcpkg.json").read_text())["version"]


def files_in(folder):
    return {str(p.relative_to(folder)) for p in pathlib.Path(folder).rglob("*") if p.is_file()}


def main():
    text = (ROOT / "include/warpagg/version.hpp").read_text()
    version = ".".join(re.findall(r"#define WARPAGG_VERSION_\w+ (\d+)", text))
    headers = {f"include/{name}" for name in files_in(ROOT / "include")}
    others = {"vcpkg": {f"share/warpagg/{name}" for name in (
                  "usage", "copyright", "emulate_cuda.cmake", "warpagg-config.cmake",
                  "warpagg-config-version.cmake", "warpagg-targets.cmake")} | {"share/pkgconfig/warpagg.pc"},
              "conan": {"licenses/LICENSE", "share/cmake/warpagg/emulate_cuda.cmake"}}
    problems = []
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        for name, package in (("conan", package_with_conan), ("vcpkg", package_with_vcpkg)):
            packaged = package(work)
            if packaged != version:
                problems.append(f"{name} packages version {packaged}, but the headers have {version}")
            wrong = files_in(work / name) ^ (headers | others[name])
            problems += [f"{name} packages too few or too many files: {file}" for file in sorted(wrong)]
        py_compile.compile(str(RECIPES / "conan/test_package/conanfile.py"), cfile=str(work / "pyc"), doraise=True)
    print("\n".join(problems))
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
