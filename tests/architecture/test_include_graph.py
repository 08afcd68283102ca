# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Tests of scripts/include_graph.py and scripts/cpp_outline.py on small made-up trees.

    python3 tests/architecture/test_include_graph.py
"""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[2] / "scripts" / "include_graph.py"
sys.path.insert(0, str(SCRIPT.parent))
sys.dont_write_bytecode = True
import cpp_outline  # noqa: E402
import include_graph  # noqa: E402

LIBRARY = "include/warpagg"
TRAINER = "examples/gaussian_splatting"
ENGINE = """struct step_plan {
    int iteration = 0;
};
class engine {
    virtual ~engine() = default;
};
"""
INCLUDES = '#include <warpagg/atomic.hpp>\n#include "../readers/reader.hpp"\n'
CLEAN = {
    f"{LIBRARY}/atomic.hpp": '#include "warp/cuda.hpp"\n',
    f"{LIBRARY}/warp/cuda.hpp": "",
    **{f"{TRAINER}/{door}": "" for door in include_graph.DOORS},
    f"{TRAINER}/training/engine.hpp": INCLUDES + ENGINE,
    f"{TRAINER}/main.cpp": '#include "training/engine.hpp"\nint main() {}\n',
    include_graph.ARCHITECTURE: "".join(
        f"| [`{folder}`](../../{folder}) | Holds something. |\n"
        for folder in (f"{LIBRARY}/warp", *(f"{TRAINER}/{name}" for name in (
            "densify", "features", "losses", "readers", "training", "writers")))),
}


def function_of(lines, head="int f()"):
    return head + " {\n" + "    g();\n" * (lines - 2) + "}\n"


class MadeUpTree(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        self.write(CLEAN)

    def write(self, files):
        for name, text in files.items():
            path = self.root / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)

    def violations(self, files=None):
        self.write(files or {})
        return [str(v) for v in include_graph.check(self.root)]

    def expect(self, violations, *parts):
        self.assertEqual(len(violations), 1, violations)
        for part in parts:
            self.assertIn(part, violations[0])

    def run_script(self, *arguments):
        return subprocess.run([sys.executable, str(SCRIPT), "--root", str(self.root), *arguments],
                              capture_output=True, text=True)


class Check(MadeUpTree):
    def test_a_clean_tree_passes(self):
        self.assertEqual(self.violations(), [])
        self.assertEqual(self.run_script("--check").returncode, 0)

    def test_the_exit_code_is_one_after_a_violation(self):
        self.write({f"{TRAINER}/training/long.cpp": function_of(61)})
        result = self.run_script("--check")
        self.assertEqual(result.returncode, 1)
        self.assertIn(f"{TRAINER}/training/long.cpp:1: ", result.stdout)

    def test_a_cycle_of_files(self):
        found = self.violations({f"{LIBRARY}/a.hpp": '\n#include "b.hpp"\n',
                                 f"{LIBRARY}/b.hpp": '#include "c.hpp"\n',
                                 f"{LIBRARY}/c.hpp": "#include <warpagg/a.hpp>\nint c;\n"})
        self.expect(found, f"{LIBRARY}/a.hpp:2: ", f"/a.hpp -> {LIBRARY}/b.hpp -> {LIBRARY}/c.hpp -> ")

    def test_a_cycle_of_folders(self):
        found = self.violations({f"{TRAINER}/losses/a.hpp": '#include "../densify/strategy.hpp"\n',
                                 f"{TRAINER}/densify/b.hpp": '// more\n#include "../losses/loss.hpp"\n'})
        self.expect(found, f"{TRAINER}/densify/b.hpp:2: ", " densify/ -> losses/ -> densify/,", "densify/b.hpp:2", "losses/a.hpp:1")

    def test_a_cycle_of_folders_within_a_folder(self):
        found = self.violations({f"{TRAINER}/losses/l1/a.hpp": '#include "../l2/b.hpp"\n',
                                 f"{TRAINER}/losses/l2/b.hpp": "",
                                 f"{TRAINER}/losses/l2/c.hpp": '#include "../l1/a.hpp"\n'})
        self.expect(found, f"{TRAINER}/losses/", " l1/ -> l2/ -> l1/,")

    def test_a_cycle_of_a_folder_and_a_file_beside_it(self):
        found = self.violations({f"{TRAINER}/losses/l1/a.hpp": '#include "../loss.hpp"\n',
                                 f"{TRAINER}/losses/l1/b.hpp": "",
                                 f"{TRAINER}/losses/loss.hpp": '#include "l1/b.hpp"\n'})
        self.expect(found, f"{TRAINER}/losses/", " l1/ -> loss.hpp -> l1/,")

    def test_an_interface_and_a_table_beside_the_folders_of_a_door(self):
        self.assertEqual(self.violations({f"{TRAINER}/losses/l1/l1.hpp": '#include "../loss.hpp"\n',
                                          f"{TRAINER}/losses/losses.hpp": '#include "l1/l1.hpp"\n'}), [])

    def test_a_source_closes_no_cycle(self):
        self.assertEqual(self.violations({f"{TRAINER}/losses/a.hpp": '#include "../densify/strategy.hpp"\n',
                                          f"{TRAINER}/densify/b.cpp": '#include "../losses/loss.hpp"\n'}), [])

    def test_forwarding_headers_are_ignored(self):
        self.assertEqual(self.violations({f"{LIBRARY}/old/a.hpp": "// License\n#include <warpagg/atomic.hpp>\n"}), [])

    def test_an_include_in_a_comment_does_not_count(self):
        self.assertEqual(self.violations({f"{LIBRARY}/warp/cuda.hpp": '// #include "../atomic.hpp"\n'}), [])

    def test_names_of_detail_in_the_trainer(self):
        self.expect(self.violations({f"{TRAINER}/readers/a.cpp": "\nint x = warpagg::detail::f();\n"}),
                    "readers/a.cpp:2: ", "warpagg::detail")

    def test_headers_of_detail_in_the_trainer(self):
        self.expect(self.violations({f"{TRAINER}/readers/a.cpp": "#include <warpagg/detail/tree.hpp>\n"}),
                    "readers/a.cpp:1: ", "warpagg/detail/tree.hpp")

    def test_other_details_are_allowed(self):
        text = "// warpagg::detail\nint x = detail::f();\n"
        self.assertEqual(self.violations({f"{TRAINER}/readers/a.cpp": text}), [])

    def test_a_long_file(self):
        self.assertEqual(self.violations({f"{LIBRARY}/long.hpp": "\n" * 500}), [])
        self.expect(self.violations({f"{LIBRARY}/long.hpp": "\n" * 501}), f"{LIBRARY}/long.hpp:501: ", "501 lines")

    def test_a_long_interface(self):
        self.assertEqual(self.violations({f"{TRAINER}/losses/loss.hpp": "\n" * 100}), [])
        self.expect(self.violations({f"{TRAINER}/losses/loss.hpp": "\n" * 101}), "losses/loss.hpp:101: ")

    def test_a_missing_interface(self):
        (self.root / TRAINER / "writers/writer.hpp").unlink()
        found = [v for v in self.violations() if "describes" not in v]
        self.expect(found, "writers/writer.hpp:1: ", "not exist")

    def test_a_long_function(self):
        path = f"{TRAINER}/training/long.cpp"
        self.assertEqual(self.violations({path: "\n" + function_of(60)}), [])
        self.expect(self.violations({path: "\n" + function_of(61)}), "long.cpp:2: ", "function f has 61 lines")

    def test_too_many_virtual_functions(self):
        def engine(functions):
            body = "".join(f"    virtual void f{i}() = 0;\n" for i in range(functions))
            text = ENGINE.replace("class engine {\n", "class engine {\n" + body)
            return {f"{TRAINER}/training/engine.hpp": text}
        self.assertEqual(self.violations(engine(12)), [])
        self.expect(self.violations(engine(13)), "engine.hpp:4: ", "13 virtual functions")

    def test_too_many_fields(self):
        def plan(members):
            return {f"{TRAINER}/training/engine.hpp": ENGINE.replace("    int iteration = 0;\n", members)}
        six = """int a = 0, b{};
    std::array<std::pair<int, int>, 3> c{1, 2}; float d;
    bool e = f(1, 2);
    int g;
"""
        others = "using type = int;\n bool valid() const { return a < b; }\n"
        self.assertEqual(self.violations(plan(six + others)), [])
        self.expect(self.violations(plan(six + "int h;\n")), "engine.hpp:1: ", "7 fields")

    def test_a_missing_engine(self):
        found = self.violations({f"{TRAINER}/training/engine.hpp": "class engine;\nstruct step_plan {\n};\n"})
        self.expect(found, f"{TRAINER}:1: ", "class engine")

    def test_a_folder_without_description(self):
        self.expect(self.violations({f"{TRAINER}/newcomer/a.hpp": ""}), include_graph.ARCHITECTURE, "newcomer")

    def test_a_description_without_folder(self):
        text = CLEAN[include_graph.ARCHITECTURE] + f"| [`gone/`](../../{TRAINER}/gone/) | Is no more. |\n"
        self.expect(self.violations({include_graph.ARCHITECTURE: text}), f"{include_graph.ARCHITECTURE}:8: ", "gone")


class Functions(unittest.TestCase):
    def found(self, text):
        return [(f.name, f.line, f.lines) for f in cpp_outline.functions(text)]

    def test_free_functions_and_members(self):
        text = """namespace a::b {
int f() { return 1; }
struct alignas(16) s : base<int> {
    s() : x_{1}, y_(2) {
    }
    explicit s(int) noexcept(true)
        : x_{1},
          y_{2} {}
    bool operator()(int i) const {
        return i == 0;
    }
    s& operator=(const s&) { return *this; }
    int x_{}, y_ = 2;
};
}
"""
        self.assertEqual(self.found(text), [("f", 2, 1), ("s", 4, 2), ("s", 6, 3), ("operator()", 9, 3),
                                            ("operator=", 12, 1)])

    def test_templates_and_constraints(self):
        text = """template <class T, bool B = (sizeof(T) > 4)>
requires requires(T t) { t.f(); }
auto f(T t, int n = here("f"))
    -> int {
    return n;
}
template <class T>
concept c = requires(T t) {
    t.f();
};
template <class T>
struct traits<T, true> {
    using type = T;
};
"""
        self.assertEqual([f[0] for f in self.found(text)], ["f"])
        self.assertEqual(self.found(text)[0][1] + self.found(text)[0][2] - 1, 6)

    def test_lambdas_belong_to_the_function_around_them(self):
        text = "void f() {\n    g([&](int i) {\n        h(i);\n    });\n}\nint x = 1;\n"
        self.assertEqual(self.found(text), [("f", 1, 5)])

    def test_values_are_no_functions(self):
        text = """inline constexpr std::array<int, 2> names{
    1, 2};
std::array<int, static_cast<int>(2)> more{};
std::function<void()> g = [] {
    f();
};
enum class e : int { a, b };
extern "C" {
void c();
}
"""
        self.assertEqual(self.found(text), [])

    def test_braces_in_strings_comments_and_macros_do_not_count(self):
        text = """#define BEGIN(x) { \\
    {
void f() {  // {
    const char* s = "{\\"{";
    const char c = '{', d = '"';
    const auto r = R"(}}})";
    const int n = 1'000'000; /* } */
}
"""
        self.assertEqual(self.found(text), [("f", 3, 6)])

    def test_unmatched_braces_are_an_error(self):
        for text in ("void f() {\n", "}\n"):
            with self.assertRaises(ValueError):
                cpp_outline.functions(text)


class Output(MadeUpTree):
    def test_layers(self):
        output = self.run_script().stdout
        self.assertIn("  0  readers/\n", output)
        self.assertIn("  1  training/ -> readers/\n", output)

    def test_layers_keep_the_order_despite_a_cycle(self):
        graph = {"a": ["b"], "b": ["c"], "c": ["b", "d"], "d": []}
        self.assertEqual(include_graph.layers(graph), [["d"], ["b", "c"], ["a"]])

    def test_dot(self):
        self.assertIn(f'"{TRAINER}/training" -> "{TRAINER}/readers";', self.run_script("--dot").stdout)

    def test_tree(self):
        self.write({f"{TRAINER}/losses/l1/l1.hpp": "/// Others.\nint x;\n\n/// The mean (A et al. 2020)\n/// error. More.\n"
                                               "template <class T>\nclass l1_loss {};\n"})
        lines = self.run_script("--tree").stdout.splitlines()
        self.assertIn(["losses/", "Holds something."], [line.split(maxsplit=1) for line in lines])
        self.assertIn(["l1/", "The mean (A et al. 2020) error."], [line.split(maxsplit=1) for line in lines])

    def test_compare_follows_moves_over_several_commits(self):
        def git(*arguments):
            subprocess.run(["git", "-C", str(self.root), "-c", "user.name=a", "-c", "user.email=a@b.org",
                            *arguments], check=True, capture_output=True)
        git("init", "-q")
        self.write({"bench/old.cpp": "".join(f"line {i}\n" for i in range(50)), "bench/gone.cpp": "gone\n"})
        git("add", "-A")
        git("commit", "-qm", "Begin")
        git("tag", "begin")
        (self.root / "bench/lab").mkdir()
        git("mv", "bench/old.cpp", "bench/lab/middle.cpp")
        git("rm", "-q", "bench/gone.cpp")
        git("commit", "-qm", "Move")
        git("mv", "bench/lab/middle.cpp", "bench/lab/new.cpp")
        self.write({"bench/added.cpp": "added\n"})
        git("add", "-A")
        git("commit", "-qm", "Rename")
        output = self.run_script("--compare", "begin").stdout
        self.assertIn("bench/ -> bench/lab/\n    old.cpp -> new.cpp\n", output)
        self.assertIn("Removed files:\n\n    bench/gone.cpp\n", output)
        self.assertIn("New files:\n\n    bench/added.cpp\n", output)


if __name__ == "__main__":
    unittest.main()
