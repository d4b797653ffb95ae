"""Every command that README.md, CONTRIBUTING.md and docs/*.md show is run, page by page, in the order of the page.

A page has a folder of its own that looks like the repository with the program built; the JSON that it shows is there as the file
that its commands name. Commands run by bash as they are printed, but that /tmp is a folder of the test and that what would take
minutes is shortened by SHORTENED. CHECKED names those that aren't run at all, why, and what is looked at in their place. A
synopsis (with [...] or a word in capitals) is held against --help.

Environment: LIEBENCH_PROGRAM; LIEBENCH_BUILD, the build tree. The reference solutions go to a cache of the test's own.
"""

import importlib.util
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
PROGRAM = Path(os.environ["LIEBENCH_PROGRAM"])
BUILD = Path(os.environ["LIEBENCH_BUILD"])
PAGES = [TOP / "README.md", TOP / "CONTRIBUTING.md", *sorted((TOP / "docs").glob("*.md"))]

FIRST_WORD = (
    r"(?:[A-Z_]+=\S+ )*(?:sudo )?(?:(?:build/\w+/)?liebench(?:_benchmarks)?|scripts/\w+\.sh|cmake|ctest|bash|git|"
    r"python3|doxygen|valgrind|callgrind_annotate|shellcheck|mypy|cpupower|taskset|lscpu|uptime|cat|grep|echo)"
)
COMMAND = re.compile(rf"{FIRST_WORD}(?: |$)")
SYNOPSIS = re.compile(r"(?:build/\w+/)?liebench .*(?:\[|\w\|\w|\b[A-Z]{2,}\b)")
# The text speaks of a program.
NAME = re.compile(r"(?:build/release/)?liebench(?:_benchmarks)?(?: \w[\w-]*)?")

# What is longer than a second, and what stands in its place: the same command, less of it.
SHORTENED = [
    # --short leaves out step sizes and times, figure2 is the shortest of the figures.
    (r"(liebench figures)((?: --short)?)(?: --only (\S+))?", r"\1 --short --only figure2"),
    # Of the dozen cases one.
    (r"(liebench stability)(?: --quick)?(?= --out|$)", r"\1 --quick --only extreme_arguments"),
    # The test may not have that processor.
    (r"^taskset -c 1 ", ""),
    (r"(liebench run .*(?<!--no-timing))$", r"\1 --no-timing"),
    (r"(--t-end) 0\.5 (--picture)", r"\1 0.05 \2"),
    (r"(liebench_benchmarks .*--benchmark_filter=.*)", r"\1 --benchmark_list_tests=true"),
    (r"(liebench_benchmarks --floors.*)", r"\1 --benchmark_min_time=0.001"),
]
# What is not run: its beginning, and the reason. The shell parses it; presets, options, targets and scripts that it names are
# looked up.
CHECKED = {
    "scripts/": "builds everything; CI runs setup.sh and test.sh themselves, and what reproduce.sh runs",
    "cmake ": "configures and builds, which CI does",
    "ctest ": "runs this test",
    "bash .ci/run": "runs this test",
    "git ls-files": "changes files; .ci/run runs the linters",
    "shellcheck ": "a linter, run by .ci/run",
    "MYPYPATH=python mypy": "a linter, run by .ci/run",
    "valgrind ": "not installed for the tests",
    "callgrind_annotate ": "reads what valgrind writes",
    "sudo ": "changes the machine",
    "taskset -c 3": "a machine may have fewer processors",
    "cpupower": "changes the machine",
    "cat /sys": "a virtual machine has no such files",
    "uptime": "the load is the machine's affair",
    "lscpu": "so are its processors",
    "echo ": "changes the machine",
}


def code_blocks(text):
    """The indented blocks of a page, each a list of lines."""
    block = []
    for line in [*text.splitlines(), "end"]:
        if line.startswith("    ") and line.strip():
            block.append(line[4:])
        elif line.strip() or not block:
            if block:
                yield block
            block = []


def commands(text):
    """All commands of a page, and whether they stand in a block of their own or in backquotes within the text."""
    for block in code_blocks(text):
        for line in "\n".join(block).replace("\\\n", " ").splitlines():
            if COMMAND.match(line.lstrip()):
                yield re.sub(r"\s+", " ", re.split(r"\s#", line)[0]).strip(), True
    outside = [line for line in text.splitlines() if not line.startswith("    ")]
    for span in re.findall(r"`([^`]+)`", " ".join(outside)):
        if COMMAND.match(span):
            yield re.sub(r"\s+", " ", span), False


def shown_files(text):
    """The JSON objects of a page, by the names that its commands give them."""
    for block in code_blocks(text):
        try:
            value = json.loads("\n".join(block))
        except ValueError:
            continue
        if isinstance(value, dict) and "integrators" in value:
            yield "study.json", block
        elif isinstance(value, dict) and "bodies" in value:
            yield f"{value['name']}.json", block


def call(arguments, **more):
    return subprocess.run(arguments, capture_output=True, text=True, stdin=subprocess.DEVNULL, **more)


class Commands(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.cache = Path(folder.name)
        cls.helps = {}

    def help_of(self, words):
        if words not in self.helps:
            done = call([PROGRAM, *words, "--help"])
            self.assertEqual(done.returncode, 0, done.stderr)
            self.helps[words] = done.stdout
        return self.helps[words]

    def folder_of(self, page):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        top = Path(folder.name)
        for name in ("harness", "problems", "results", "python", "docs", "groups", "integrators"):
            (top / name).symlink_to(TOP / name)
        (top / "tmp").mkdir()
        (top / "bin").mkdir()
        (top / "bin/python3").symlink_to(sys.executable)
        (top / "build/release").mkdir(parents=True)
        for program in (PROGRAM, BUILD / "liebench_benchmarks"):
            (top / "bin" / program.name).symlink_to(program)
            (top / "build/release" / program.name).symlink_to(program)
        for name, block in shown_files(page.read_text()):
            (top / name).write_text("\n".join(block))
        return top

    def hold_against_help(self, command):
        """A synopsis, or the name of a subcommand in the text."""
        words = command.split()
        if len(words) == 1:
            return
        self.assertIn(words[1], self.help_of(()))
        text = self.help_of((words[1],))
        self.assertIn(f"Usage: liebench {words[1]}", text)
        for option in re.findall(r"--[a-z-]+", command):
            self.assertRegex(text, rf"{option}\b")
        for value in re.findall(r"--kind ([a-z-]+)", command):
            self.assertRegex(text, rf"[{{,]{value}[,}}]")
        for listed in re.findall(r" list ([a-z|]+)", command):
            for what in listed.split("|"):
                self.assertEqual(call([PROGRAM, "list", what]).returncode, 0, what)

    def look_up(self, command):
        """What a command that is not run names has to be there."""
        self.assertEqual(call(["bash", "-n", "-c", command]).returncode, 0)
        for script, rest in re.findall(r"((?:scripts|tests)/\S+\.sh|\.ci/run)((?: --\w+)*)", command.replace("*", "")):
            self.assertTrue((TOP / script).exists() or "/." in script, script)
            for option in rest.split():
                self.assertRegex(call([TOP / script, "--help"]).stdout, rf"{option}(?![\w-])")
        presets = [part["name"] for part in json.loads((TOP / "CMakePresets.json").read_text())["configurePresets"]]
        for preset in re.findall(r"--preset (\w+)", command):
            self.assertIn(preset, presets)
        lists = "".join(file.read_text() for file in (TOP / "CMakeLists.txt", TOP / "harness/CMakeLists.txt"))
        for target in re.findall(r"--target (\w+)", command):
            self.assertRegex(lists, rf"add_(?:executable|custom_target)\(\s*{target}\b")
        for pattern in re.findall(r"ctest .*-R (\w+)", command):
            self.assertIn(pattern, call(["ctest", "--test-dir", BUILD, "-N", "-R", pattern]).stdout.replace("-R", ""))

    def allowed_figures(self):
        message = call([PROGRAM, "figures", "--only", "none"]).stderr
        return set(re.findall(r"\w+", message))

    def run_in(self, folder, command):
        for only in re.findall(r"liebench figures .*--only (\S+)", command):
            self.assertLessEqual(set(only.split(",")), self.allowed_figures())
        if "liebench_benchmarks" in command and not (BUILD / "liebench_benchmarks").exists():
            return
        if command.startswith("python3") and not all(map(importlib.util.find_spec, ("pandas", "matplotlib"))):
            return
        for pattern, short in SHORTENED:
            command = re.sub(pattern, short, command)
        command = command.replace("/tmp/", f"{shlex.quote(str(folder))}/tmp/")
        environment = os.environ | {
            "LIEBENCH_CACHE": str(self.cache),
            "PATH": f"{folder}/bin:{os.environ['PATH']}",
            "MPLBACKEND": "agg",
            "MPLCONFIGDIR": f"{folder}/tmp",
        }
        done = call(["bash", "-c", command], cwd=folder, env=environment)
        self.assertEqual(done.returncode, 0, f"{command}\n{done.stderr[-2000:]}")
        if "--benchmark_list_tests" in command:
            self.assertTrue(done.stdout, f"{command}: no benchmark has such a name")
        for out in re.findall(r"(?:--out|--picture) (\S+)", command):
            self.assertTrue((folder / out).exists(), f"{command}: left no {out}")

    def test_every_page(self):
        seen = 0
        for page in PAGES:
            folder = self.folder_of(page)
            for command, in_block in commands(page.read_text()):
                seen += 1
                with self.subTest(page=page.name, command=command):
                    if any(command.startswith(beginning) for beginning in CHECKED):
                        self.look_up(command)
                    elif SYNOPSIS.match(command) or (not in_block and NAME.fullmatch(command)):
                        self.hold_against_help(command)
                    else:
                        self.run_in(folder, command)
        # The pages have more than fifty: were they not found, nothing would be tested.
        self.assertGreater(seen, 50)

    def test_python_of_the_pages(self):
        if not importlib.util.find_spec("pandas"):
            self.skipTest("python3-pandas is not here")
        blocks = [block for page in PAGES for block in code_blocks(page.read_text()) if block[0].startswith(("import ", "from "))]
        self.assertTrue(blocks)
        for block in blocks:
            done = call([sys.executable, "-B", "-c", "\n".join(block)], cwd=TOP)
            self.assertEqual(done.returncode, 0, done.stderr)


if __name__ == "__main__":
    unittest.main()
