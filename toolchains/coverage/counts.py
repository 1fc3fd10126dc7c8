# SPDX-License-Identifier: Apache-2.0
"""How often each line and branch ran, from what `llvm-cov export` says of several executables."""
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path


@dataclass
class Total:
    lines: int = 0
    lines_run: int = 0
    branches: int = 0
    branches_run: int = 0


@dataclass(frozen=True)
class Gap:
    path: str
    line: int
    what: str  # "line", "never true", "never false"
    code: str

    def __str__(self):
        return f"{self.path}:{self.line}: {self.what}: {self.code}"


def lines_of(segments):
    """line -> count, as llvm-cov shows it: the highest of the regions that begin on it or reach over its begin. A segment
    is (line, column, count, has a count, begins a region, is a gap)."""
    by_line = defaultdict(list)
    for segment in segments:
        by_line[segment[0]].append(segment)
    counts, reaching = {}, None
    for line in range(segments[0][0], segments[-1][0] + 1) if segments else ():
        row = by_line.get(line, [])
        begun = [s for s in row if s[3] and s[4] and not s[5]]
        is_left_out = bool(row) and not row[0][3] and row[0][4]
        if not is_left_out and (begun or (reaching and reaching[3])):
            counts[line] = max([s[2] for s in begun] + ([reaching[2]] if reaching else []))
        reaching = row[-1] if row else reaching
    return counts


def count_at(segments, line, column):
    count = 0
    for segment in segments:
        if (segment[0], segment[1]) > (line, column):
            break
        count = segment[2]
    return count


class Counts:
    """Sums over executables and over the instances of a template. A condition that ran and yet was neither true nor false
    was known to the compiler: it is no branch."""

    def __init__(self, root):
        self.root = root
        self.lines = defaultdict(lambda: defaultdict(int))  # path -> line -> count
        self.branches = defaultdict(lambda: defaultdict(lambda: [0, 0, 0]))  # path -> place -> [ran, true, false]

    def add(self, exported):
        for file in exported["data"][0]["files"]:
            path = self.path_of(file["filename"])
            if path is None:
                continue
            for line, count in lines_of(file["segments"]).items():
                self.lines[path][line] += count
            for branch in file["branches"]:
                sums = self.branches[path][tuple(branch[:4])]
                sums[0] += count_at(file["segments"], *branch[:2])
                sums[1] += branch[4]
                sums[2] += branch[5]

    def path_of(self, name):
        path = Path(name).resolve()
        is_ours = path.is_relative_to(self.root) and path.relative_to(self.root).parts[0] in (
            "hal", "estimation", "control", "firmware", "drivers")
        return str(path.relative_to(self.root)) if is_ours else None

    def outcomes(self, path):
        return {place: (true, false) for place, (ran, true, false) in sorted(self.branches[path].items())
                if not (ran > 0 and true == 0 and false == 0)}

    def total(self, prefix):
        total = Total()
        for path in (p for p in self.lines if p.startswith(prefix)):
            total.lines += len(self.lines[path])
            total.lines_run += sum(count > 0 for count in self.lines[path].values())
            for true, false in self.outcomes(path).values():
                total.branches += 2
                total.branches_run += (true > 0) + (false > 0)
        return total

    def folders(self, top):
        return sorted({"/".join(path.split("/")[:2]) for path in self.lines if path.startswith(top + "/")})

    def gaps(self):
        """All that is not run: a line, or an outcome of a condition on a line that is."""
        found = []
        for path in sorted(self.lines):
            source = (self.root / path).read_text(encoding="utf-8").splitlines()
            counts = self.lines[path]
            found += [Gap(path, n, "line", source[n - 1].strip()) for n, count in counts.items() if count == 0]
            for (line, first, last_line, last), (true, false) in self.outcomes(path).items():
                if counts.get(line, 0) > 0:
                    code = source[line - 1][first - 1:last - 1 if last_line == line else None].strip()
                    found += [Gap(path, line, f"never {'false' if true else 'true'}", code)] if not (true and false) else []
        return sorted(found, key=lambda gap: (gap.path, gap.line))

    def compare(self, named, prefixes):
        """Names that fit no gap, and gaps without a name."""
        used, unnamed = set(), []
        for gap in self.gaps():
            fits = [(path, code) for path, code, _ in named if path in gap.path and code in ("*", gap.code)]
            used |= set(fits)
            if not fits and any(gap.path.startswith(prefix) for prefix in prefixes):
                unnamed.append(gap)
        return [(path, code) for path, code, _ in named if (path, code) not in used], unnamed
