# SPDX-License-Identifier: Apache-2.0
"""Builds a mutant with its test executable in a folder of its own, and runs the tests."""
import json
import re
import shlex
import signal
import subprocess
from pathlib import Path

FAILURE = re.compile(r"Failure in (?:IGNORE_)?TEST\((\w+), (\w+)\)")


class Subject:
    """A file to change, the sources that hold its code, and the executable that tests it. `groups`: those of CppUTest
    that are run first, because they fail fast; where `of_first` is set, they use the first source alone, and the others
    are compiled for those mutants only that survive them."""

    def __init__(self, path, sources, executable, groups=(), of_first=False):
        self.path = path
        self.sources = sources
        self.executable = executable
        self.groups = groups
        self.of_first = of_first

    def rounds(self):
        """(sources, groups) in the order in which they are tried. No group: all tests."""
        first = self.sources[:1] if self.of_first else self.sources
        return [*((first, ["-sg", group]) for group in self.groups), (self.sources, [])]


class Build:
    """The release build's commands, each source on its own: there, sources are joined, and calls from one to the other may
    be inlined."""

    def __init__(self, root, folder):
        self.root = root
        self.folder = folder
        self.release = root / "build/release"
        commands = json.loads((self.release / "compile_commands.json").read_text(encoding="utf-8"))
        self.of_source = {Path(c["file"]): shlex.split(c["command"]) for c in commands}
        self.links = {}

    def compile_command(self, source, work):
        """The source, with the changed header of the folder `work` if there is one."""
        library = source.split("/")[0]
        joined = self.release / library / f"CMakeFiles/millforce_lib_{library}.dir/Unity/unity_0_cxx.cxx"
        command = self.of_source.get(self.root / source) or self.of_source[joined]
        kept = [word for word in command if not word.startswith(("-W", "-O"))]
        kept = kept[:kept.index("-o")] if "-o" in kept else kept
        return [kept[0], f"-I{work}", *kept[1:], "-w", "-O1"]

    def compile(self, source, output, work):
        """The source, or the changed one in the folder `work`."""
        output.parent.mkdir(parents=True, exist_ok=True)
        text = work / source if (work / source).exists() else self.root / source
        command = [*self.compile_command(source, work), "-c", str(text), "-o", str(output)]
        return subprocess.run(command, cwd=self.release, capture_output=True, text=True, check=False)

    def unchanged_object(self, source):
        output = self.folder / "unchanged" / (source + ".o")
        newest = max(path.stat().st_mtime for path in headers_and_sources(self.root))
        if not output.exists() or output.stat().st_mtime < newest:
            made = self.compile(source, output, self.folder / "nothing")
            if made.returncode != 0:
                raise SystemExit(f"check-mutations: {source} does not compile:\n{made.stderr}")
        return output

    def link_command(self, executable):
        if executable not in self.links:
            commands = subprocess.run(["ninja", "-t", "commands", executable], cwd=self.release, capture_output=True,
                                      text=True, check=True).stdout
            self.links[executable] = shlex.split(commands.strip().splitlines()[-1].removeprefix(": && ").removesuffix(" && :"))
        return self.links[executable]

    def link(self, subject, changed, output):
        """All of the library whose file is changed is linked as objects, the changed ones among them. A test's own object
        takes the place of the release build's, and comes first: of functions that several objects hold, the linker takes
        the first."""
        library = subject.path.split("/")[0]
        own = [str(path.relative_to(self.root)) for path in sorted((self.root / library / "src").glob("*.cpp"))]
        objects = [str(changed.get(source) or self.unchanged_object(source)) for source in own]
        words = self.link_command(f"tests/{subject.executable}")
        words = [word for word in words if word != f"{library}/libmillforce_{library}.a"]
        for source, changed_object in changed.items():
            if source.startswith("tests/"):
                words = [word for word in words if not word.endswith(source.removeprefix("tests/") + ".o")]
                objects.insert(0, str(changed_object))
        words[words.index("-o") + 1] = str(output)
        return subprocess.run([*words[:1], *objects, *words[1:]], cwd=self.release, capture_output=True, text=True, check=False)


def headers_and_sources(root):
    return [path for library in ("hal", "estimation", "control", "firmware") for folder in ("include", "src")
            for path in (root / library / folder).glob("**/*.[hc]pp")]


def run_tests(executable, selection, limit_s):
    """The first case that fails, or None. `limit_s`: of a processor, so that a busy machine kills no mutant."""
    ran = subprocess.run(["prlimit", f"--cpu={limit_s}", executable, *selection], cwd=executable.parent,
                         capture_output=True, text=True, errors="replace", check=False)
    if ran.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
        return "does not end"
    if ran.returncode == 0:
        return None
    failure = FAILURE.search(ran.stdout)
    return ".".join(failure.groups()) if failure else f"ends with {ran.returncode}"


def attempt(build, subject, mutant, work, limit_s=10):
    """(result, what killed it): "killed", "survived", or "not compiled"."""
    as_included = Path(*Path(mutant.path).parts[2:])
    file = work / (as_included if mutant.path.endswith(".hpp") else mutant.path)
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(mutant.text, encoding="utf-8")
    executable = work / subject.executable
    changed = {}
    try:
        for sources, selection in subject.rounds():
            missing = [source for source in sources if source not in changed]
            for source in missing:
                changed[source] = work / (source.replace("/", "_") + ".o")
                if build.compile(source, changed[source], work).returncode != 0:
                    return "not compiled", None
            if missing:
                linked = build.link(subject, changed, executable)
                if linked.returncode != 0:
                    raise SystemExit(f"check-mutations: {subject.executable} does not link:\n{linked.stderr}")
            killer = run_tests(executable, selection, limit_s)
            if killer:
                return "killed", killer
        return "survived", None
    finally:
        file.unlink()
