#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Which changes toolchains/mutations/mutants.py makes of a few lines. Exit code 1 where they are others."""
import sys
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parent.parent.parent / "toolchains/mutations"))
from mutants import mutants_of  # noqa: E402

SOURCE = """\
// if (comment) a < b
if (!is_known(x) || y > 0) {
    return;
}
const bool turns = v < limit;
lowest.lower_to(entry, Limit::entry);
ratio = w < low ? low : w;
return bounded(parameters, std::max(a, b)) + clamp(x, low, high);
"""
EXPECTED = [
    "if (true) {",
    "if (false) {",
    "if (false || y > 0) {",
    "if (!is_known(x) || false) {",
    "const bool turns = v >= limit;",
    ";",
    "ratio = true ? low : w;",
    "ratio = false ? low : w;",
    "return (std::max(a, b)) + clamp(x, low, high);",
    "return bounded(parameters, std::max(a, b)) + (x);",
]


def main():
    made = sorted(mutant.now for mutant in mutants_of("a.hpp", SOURCE))
    for text in sorted(set(EXPECTED) - set(made)):
        print(f"is missing: {text}")
    for text in sorted(set(made) - set(EXPECTED)):
        print(f"is not expected: {text}")
    return 0 if made == sorted(EXPECTED) else 1


if __name__ == "__main__":
    sys.exit(main())
